// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "colonnade/filter/ekf_slam.hpp"
#include "colonnade/slam/event.hpp"
#include "colonnade/slam/range_bearing_options.hpp"
#include "colonnade/slam/resumption.hpp"
#include "range_bearing_history.hpp"
#include "range_bearing_world.hpp"

namespace colonnade {

/// A reading as the filter takes it.
struct LandmarkReading {
  Measurement measurement;
  int identity = -1;  ///< below 0: not known
};

/// A frame as seen by the range-bearing estimator.
struct ReadingFrame {
  double stamp_s = 0.0;
  std::size_t index = 0;
  double noise_scale = 1.0;
  std::vector<LandmarkReading> readings;
};

/// What a robot is in doubt by that every landmark disagrees with (event `lost`).
Eigen::Matrix3d lostCovariance();

/// One way to explain all readings so far: an estimate, and which landmark bears which identity.
class RangeBearingHypothesis {
 public:
  RangeBearingHypothesis(const RangeBearingOptions& options, const FilterOptions& filter_options);
  RangeBearingHypothesis(const RangeBearingOptions& options, const FilterOptions& filter_options,
                         const Resumption& from);

  EkfSlam filter;
  /// The filter's world starts with the log. When a correction moves its map as a whole, as the
  /// closing of a loop does, this moves the world along: the map stays and the start moves.
  Pose2 T_world_start;
  double log_weight = 0.0;
  ReadingHistories::Leaf leaf = ReadingHistories::kRoot;
  std::vector<LandmarkId> used;  ///< landmarks seen in the present frame

  /// Whether new landmarks are founded; not in a map that is left as it is.
  bool grows() const { return grows_; }
  std::optional<LandmarkId> landmarkOf(int identity) const;
  std::optional<int> identityOf(LandmarkId landmark) const;
  /// A reading of nothing in a map that does not grow.
  void refuseNew() { filter.health().refuse("no landmark of the map"); }
  /// The landmarks a reading may be of: the bearer of its identity, or, for an identity nobody
  /// bears yet, those without one; for a reading without identity all. Not those already used.
  std::vector<LandmarkId> allowed(int identity) const;

  /// In a large map: lets the landmarks the readings may be of be worked with, and those around
  /// the robot; the others rest.
  void focus(const ReadingFrame& frame);

  /// A new landmark at the reading.
  std::optional<LandmarkId> found(const LandmarkReading& reading, const ReadingFrame& frame,
                                  std::vector<Event>& events);
  /// EkfSlam::update; keeps T_world_start.
  std::vector<bool> update(std::span<const Match> matches, double noise_scale);

  /// Books a reading the filter used.
  void observe(LandmarkId landmark, const LandmarkReading& reading, const ReadingFrame& frame);
  /// Books a reading the gate kept from the landmark of its identity. A landmark refused more often
  /// in a row than it was ever seen stands at a wrong place: it is forgotten, if the map grows.
  /// When readings of several landmarks are refused and none is used in between, the pose becomes
  /// uncertain. Whether it did.
  bool strike(LandmarkId landmark, const ReadingFrame& frame, std::vector<Event>& events);

  /// A bearing to an identity the map does not know: a landmark somewhere on its ray, or, with
  /// wait_for_parallax, one that waits for a second bearing from elsewhere. What became a landmark,
  /// if any.
  std::optional<LandmarkId> triangulate(const LandmarkReading& reading, const ReadingFrame& frame,
                                        std::vector<Event>& events);

  /// What ends a frame: points settle, landmarks seen too seldom go.
  void endFrame(const ReadingFrame& frame, std::vector<Event>& events);

  /// The map with its identities, in the world of T_world_start.
  SavedMap savedMap() const;

 private:
  struct FirstBearing {
    LandmarkId clone{};
    Measurement measurement;
  };
  void forget(LandmarkId landmark);
  void release(LandmarkId clone);

  const RangeBearingOptions* options_;
  bool grows_ = true;
  Pose2 T_filter_start_;  ///< of the drive that began the map, in the filter's world
  std::map<int, LandmarkId> landmark_of_identity_;
  std::map<LandmarkId, int> identity_of_landmark_;
  std::map<LandmarkId, int> strikes_;
  std::vector<LandmarkId> on_probation_;  ///< born of a reading, seen seldom since
  std::vector<LandmarkId> refused_in_a_row_;
  std::map<int, FirstBearing> first_bearings_;
  std::optional<LandmarkId> clone_of_frame_;
};

}  // namespace colonnade
