// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/session.hpp"

#include <utility>

#include "colonnade/detectors/edge_view_of.hpp"
#include "stopwatch.hpp"

namespace colonnade {

struct Session::Stages {
  Stages(const SessionOptions& options, std::unique_ptr<EdgeLineBackend> edge_backend,
         std::optional<Resumption> from)
      : tracker(std::make_shared<CameraTracker>(options.motion)),
        mounting(options.motion, tracker),
        motion(options.motion, tracker),
        backend(std::move(edge_backend)),
        detectors(options.detectors),
        mapper(from ? Mapper(options, std::move(*from)) : Mapper(options)) {}

  std::shared_ptr<CameraTracker> tracker;
  MountingEstimator mounting;
  MotionEstimator motion;
  std::unique_ptr<EdgeLineBackend> backend;
  DetectorBank detectors;
  Mapper mapper;
};

Session::Session(const SessionOptions& options, std::unique_ptr<EdgeLineBackend> backend,
                 std::optional<Resumption> from)
    : stages_(std::make_unique<Stages>(options, std::move(backend), std::move(from))) {}
Session::~Session() = default;

void Session::run(FrameSource& source, const Observer& observer) {
  auto& [tracker, mounting, motion, backend, detectors, mapper] = *stages_;
  Stopwatch watch;
  while (auto frame = source.next()) {
    StepReport report;
    report.times_ms.read = watch.lap();

    mounting.refine(*frame);  // tilt and height of a hand-carried camera
    report.motion = motion.increment(*frame, mounting.uncertainty());
    report.times_ms.motion = watch.lap();

    report.edges = backend->extract(frame->gray, edgeViewOf(*frame));
    report.times_ms.edges = watch.lap();

    report.detections = detectors.detect(
        *frame, report.edges,
        report.motion.isMeasured() ? std::optional(report.motion.T_previous_robot) : std::nullopt);
    report.times_ms.detectors = watch.lap();

    MapperReport mapped = mapper.step({frame->index, frame->stamp_s, report.motion,
                                       report.detections, detectors.wallDirections(),
                                       sightOf(detectors.depthProfile()), detectors.lacking()});
    report.association = std::move(mapped.association);
    report.events = std::move(mapped.events);
    report.times_ms.filter = watch.lap();

    if (!observer(*frame, report, *this)) return;
    watch.lap();  // what the observer does is no stage of the session
  }
}

const EkfSlam& Session::filter() const { return stages_->mapper.filter(); }
const Mapper& Session::mapper() const { return stages_->mapper; }
const EdgeLineBackend& Session::imageStage() const { return *stages_->backend; }
std::size_t Session::axisCount() const { return stages_->mapper.axisCount(); }
LandmarkMap Session::map() const { return stages_->mapper.map(); }

}  // namespace colonnade
