// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "colonnade/base/config.hpp"
#include "colonnade/detectors/detector_bank.hpp"
#include "colonnade/edges/edge_line_backend.hpp"
#include "colonnade/frames/frame_source.hpp"
#include "colonnade/motion/motion_estimator.hpp"
#include "colonnade/slam/mapper.hpp"

namespace colonnade {

/// The options of every stage between the frames and the map.
struct SessionOptions : MapperOptions {
  MotionOptions motion;
  EdgeOptions edges;
  DetectorOptions detectors;

  /// Calls `take` with the options of each stage in turn: to read, to write or to print them.
  template <class Take>
  void each(Take&& take) {
    take(motion);
    take(edges);
    detectors.each(take);
    MapperOptions::each(take);
  }
};

/// Wall-clock milliseconds of one frame by stage.
struct StageTimes {
  double read = 0.0;
  double motion = 0.0;
  double edges = 0.0;
  double detectors = 0.0;
  double filter = 0.0;
  double frame() const { return read + motion + edges + detectors + filter; }
};

/// What happened in one frame.
struct StepReport {
  MotionIncrement motion;
  EdgeLines edges;
  Detections detections;
  Association association;
  std::vector<Event> events;
  StageTimes times_ms;
};

/// The main loop: frames in, an estimate out. Each stage is one object, built once from its
/// options; the stages do not know each other.
class Session {
 public:
  /// from: a map to go on from; none: an empty one at the robot's start.
  Session(const SessionOptions& options, std::unique_ptr<EdgeLineBackend> backend,
          std::optional<Resumption> from = std::nullopt);
  ~Session();

  /// Called after each frame; false stops the run.
  using Observer = std::function<bool(const Frame&, const StepReport&, const Session&)>;
  /// Processes the whole source.
  void run(FrameSource& source, const Observer& observer);

  const EkfSlam& filter() const;
  const Mapper& mapper() const;
  const EdgeLineBackend& imageStage() const;
  /// Landmarks with what the book knows of them.
  LandmarkMap map() const;
  std::size_t axisCount() const;
  const PlaceSearch* search() const { return mapper().search(); }

 private:
  struct Stages;
  std::unique_ptr<Stages> stages_;
};

}  // namespace colonnade
