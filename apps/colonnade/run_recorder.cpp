// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "run_recorder.hpp"

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {

void RunRecorder::add(const Frame& frame, const StepReport& report,
                      const std::optional<Pose2>& T_world_robot, const Eigen::Matrix3d& covariance,
                      const Pose2& T_world_origin) {
  if (T_world_robot) {
    const StampedPose pose{frame.stamp_s, T_world_robot->toIsometry3()};
    if (!trajectory_.empty())
      path_length_m_ +=
          (pose.T_world_body.translation() - trajectory_.back().T_world_body.translation()).norm();
    trajectory_.push_back(pose);
    covariances_.push_back({frame.stamp_s, covariance, T_world_origin});
  }
  if (!T_world_robot) path_length_m_ += report.motion.T_previous_robot.translation().norm();
  if (times_.empty()) first_stamp_s_ = frame.stamp_s;
  last_stamp_s_ = frame.stamp_s;
  times_.push_back(report.times_ms);
  events_.insert(events_.end(), report.events.begin(), report.events.end());
  const Detections& detections = report.detections;
  for (const Detection& detection : detections)
    if (!detection.accepted())
      events_.push_back({frame.stamp_s, frame.index, std::string("refusal"), std::nullopt,
                         std::string(name(detection.kind())) + ": " + detection.refusal});
  if (report.motion.source == MotionSource::kConstantVelocity)
    events_.push_back({frame.stamp_s, frame.index, "coasting", std::nullopt, "no motion measured"});
  if (report.motion.source != MotionSource::kNone) ++motion_sources_[name(report.motion.source)];
}

void RunRecorder::write(const std::filesystem::path& folder, const Trajectory& final) const {
  writeTum(folder / "trajectory.tum", trajectory_);
  writeTum(folder / "trajectory_final.tum", final);
  writeCovarianceCsv(folder / "trajectory_covariance.csv", covariances_);
  std::string text = "stamp,frame,event,landmark,reason\n";
  for (const Event& event : events_)
    text += formatFixed(event.stamp_s, 6) + "," + std::to_string(event.frame) + "," + event.what +
            "," + (event.landmark ? std::to_string(number(*event.landmark)) : "") + "," +
            event.reason + "\n";
  writeFileAtomically(folder / "events.csv", text);
}

double RunRecorder::duration() const { return last_stamp_s_ - first_stamp_s_; }

}  // namespace colonnade
