// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/session.hpp"

#include <limits>

#include "colonnade/detectors/edge_view_of.hpp"
#include "colonnade/slam/floor_directions.hpp"
#include "stopwatch.hpp"

namespace colonnade {
namespace {

/// Books what the update used, and counts what it did not.
void book(const Frame& frame, const StepReport& report, const std::vector<bool>& used,
          EkfSlam& filter, LandmarkBook& landmarks) {
  std::map<std::size_t, LandmarkId> landmark_of_detection;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    const std::size_t d = report.association.detection_of_match[i];
    const LandmarkId id = report.association.matches[i].landmark;
    landmarks.observe(id, report.detections[d], frame.stamp_s, filter);
    landmark_of_detection.emplace(d, id);
  }
  for (const auto& [d, id] : landmark_of_detection) {
    const auto& partner = report.detections[d].partner;
    if (!partner || *partner <= d) continue;
    if (const auto other = landmark_of_detection.find(*partner);
        other != landmark_of_detection.end())
      landmarks.observePair(id, other->second);
  }
  for (const auto& [reason, count] : report.association.refused)
    for (std::size_t i = 0; i < count; ++i) filter.health().refuse(reason);
  for (const Detection& detection : report.detections)
    if (!detection.accepted()) filter.health().refuse(detection.refusal);
}

}  // namespace

struct Session::Stages {
  Stages(const SessionOptions& options, std::unique_ptr<EdgeLineBackend> edge_backend)
      : tracker(std::make_shared<CameraTracker>(options.motion)),
        mounting(options.motion, tracker),
        motion(options.motion, tracker),
        backend(std::move(edge_backend)),
        detectors(options.detectors),
        filter(options.filter),
        association(options.association),
        initializer(options.initialization),
        axes(options.axes) {}

  std::shared_ptr<CameraTracker> tracker;
  MountingEstimator mounting;
  MotionEstimator motion;
  std::unique_ptr<EdgeLineBackend> backend;
  DetectorBank detectors;
  EkfSlam filter;
  LandmarkBook landmarks;
  Associator association;
  Initializer initializer;
  AxisTracker axes;
};

Session::Session(const SessionOptions& options, std::unique_ptr<EdgeLineBackend> backend)
    : stages_(std::make_unique<Stages>(options, std::move(backend))) {}
Session::~Session() = default;

void Session::run(FrameSource& source, const Observer& observer) {
  auto& [tracker, mounting, motion, backend, detectors, filter, landmarks, association, initializer,
         axes] = *stages_;
  Stopwatch watch;
  double former_stamp_s = std::numeric_limits<double>::infinity();
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

    filter.predict(report.motion.T_previous_robot, report.motion.covariance);
    const double noise_scale =
        correlatedNoiseScale(frame->stamp_s - former_stamp_s, filter.options().error_correlation_s);
    former_stamp_s = frame->stamp_s;
    for (const std::string& reason : detectors.lacking()) filter.health().refuse(reason);
    axes.step(*frame,
              frame->depth_m.empty() ? floorEdgeDirections(report.detections)
                                     : detectors.wallDirections(),
              noise_scale, filter, report.events);
    report.association = association.match(report.detections, filter, landmarks);
    const auto used = filter.update(report.association.matches, noise_scale);
    book(*frame, report, used, filter, landmarks);
    initializer.step(*frame, report.detections, report.association, filter, landmarks,
                     report.events);
    for (const LandmarkId id : filter.settleInverseDepths())
      report.events.push_back(
          {frame->stamp_s, frame->index, "settled", id, "inverse depth to x, y"});
    report.times_ms.filter = watch.lap();

    if (!observer(*frame, report, *this)) return;
    watch.lap();  // what the observer does is no stage of the session
  }
}

const EkfSlam& Session::filter() const { return stages_->filter; }
const EdgeLineBackend& Session::imageStage() const { return *stages_->backend; }
std::size_t Session::axisCount() const { return stages_->axes.axes().size(); }

LandmarkMap Session::map() const {
  LandmarkMap map = stages_->filter.landmarkMap();
  stages_->landmarks.fillPairs(map);
  return map;
}

}  // namespace colonnade
