// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "frame_assembler.hpp"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <algorithm>

#include "colonnade/frames/action_motion.hpp"
#include "colonnade/frames/range_bearing_observation.hpp"
#include "stamps.hpp"

namespace colonnade {
namespace {

using mrpt::obs::CObservation;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationBearingRange;
using mrpt::obs::CObservationImage;
using mrpt::obs::CObservationOdometry;

Pose2 toPose2(const mrpt::poses::CPose2D& pose) { return {pose.x(), pose.y(), pose.phi()}; }

bool isFinite(const Pose2& pose) { return pose.vector().allFinite(); }

}  // namespace

FrameAssembler::FrameAssembler(const std::filesystem::path& log, const SourceOptions& options,
                               Damage& damage)
    : options_(options), damage_(damage), images_folder_(imagesFolderOf(log)), builder_(options) {}
FrameAssembler::~FrameAssembler() = default;

void FrameAssembler::add(const Entry& entry) {
  using namespace mrpt::obs;
  newest_entry_ = entry.number;
  if (const auto actions = std::dynamic_pointer_cast<CActionCollection>(entry.object))
    addActions(*actions);
  else if (const auto frame = std::dynamic_pointer_cast<CSensoryFrame>(entry.object))
    addSensoryFrame(*frame);
  else if (const auto observation = std::dynamic_pointer_cast<CObservation>(entry.object))
    addObservation(observation);
  else
    ++damage_.ignored[entry.object->GetRuntimeClass()->className];
}

void FrameAssembler::addActions(const mrpt::obs::CActionCollection& actions) {
  const auto motion = motionOf(actions);
  if (!motion) return;
  if (!motion->T_before_after.vector().allFinite())
    return skip("motion with a value that is not finite");
  motion_.add(motion->T_before_after, motion->covariance);
  motion_seen_ = true;
}

bool FrameAssembler::isChosenCamera(const CObservation& observation) {
  if (!options_.sensor_label.empty()) return observation.sensorLabel == options_.sensor_label;
  if (!camera_label_) camera_label_ = observation.sensorLabel;
  return *camera_label_ == observation.sensorLabel;
}

bool FrameAssembler::place(const CObservation::Ptr& observation, Candidate& candidate) {
  if (auto scan = std::dynamic_pointer_cast<CObservation3DRangeScan>(observation)) {
    if (!scan->hasIntensityImage && !scan->hasRangeImage) return false;
    if (scan->hasIntensityImage && !isChosenCamera(*scan)) {
      if (!depth_label_) depth_label_ = "";
      return false;
    }
    if (!scan->hasIntensityImage) {
      if (!depth_label_) depth_label_ = scan->sensorLabel;
      if (*depth_label_ != scan->sensorLabel) return false;
    }
    if (candidate.scan || (candidate.image && scan->hasIntensityImage)) return false;
    candidate.scan = scan;
    return true;
  }
  if (auto image = std::dynamic_pointer_cast<CObservationImage>(observation)) {
    if (!isChosenCamera(*image) || candidate.image ||
        (candidate.scan && candidate.scan->hasIntensityImage))
      return false;
    candidate.image = image;
    return true;
  }
  if (auto landmarks = std::dynamic_pointer_cast<CObservationBearingRange>(observation)) {
    if (candidate.landmarks) return false;
    candidate.landmarks = landmarks;
    return true;
  }
  return false;
}

void FrameAssembler::addSensoryFrame(const mrpt::obs::CSensoryFrame& frame) {
  Candidate candidate;
  candidate.from_sensory_frame = true;
  double image_s = 0.0, any_s = 0.0;
  bool image = false, any = false;
  for (const auto& observation : frame) {
    if (!observation) continue;
    if (!place(observation, candidate)) {
      ++damage_.ignored[observation->GetRuntimeClass()->className];
      continue;
    }
    const double stamp_s = secondsOf(observation->timestamp);
    if (observation == candidate.image || (observation == candidate.scan && !image)) {
      image_s = stamp_s;
      image = observation == candidate.image || candidate.scan->hasIntensityImage;
    }
    any_s = any ? any_s : stamp_s;
    any = true;
  }
  if (!any) return;
  candidate.stamp_s = candidate.image || candidate.scan ? image_s : any_s;
  candidate.motion = motion_;
  candidate.entry = newest_entry_;
  motion_ = MotionSum{};
  waiting_.push_back(std::move(candidate));
}

void FrameAssembler::addObservation(const CObservation::Ptr& observation) {
  const double stamp_s = secondsOf(observation->timestamp);
  if (const auto odometry = std::dynamic_pointer_cast<CObservationOdometry>(observation)) {
    if (!isPlausibleStamp(stamp_s)) return skip("odometry with an invalid stamp");
    if (!isFinite(toPose2(odometry->odometry))) return skip("odometry that is not finite");
    if (!track_.add(stamp_s, toPose2(odometry->odometry)))
      return skip("odometry whose stamp repeats or goes back");
    newest_s_ = std::max(newest_s_, stamp_s);
    return;
  }
  for (auto& candidate : waiting_)
    if (!candidate.from_sensory_frame && std::abs(candidate.stamp_s - stamp_s) <= kTogether_s &&
        place(observation, candidate)) {
      if (observation == candidate.image) candidate.stamp_s = stamp_s;  // the frame is the image's
      return;
    }
  Candidate candidate;
  candidate.stamp_s = stamp_s;
  if (!place(observation, candidate)) {
    ++damage_.ignored[observation->GetRuntimeClass()->className];
    return;
  }
  insert(std::move(candidate));
}

void FrameAssembler::insert(Candidate candidate) {
  if (!isPlausibleStamp(candidate.stamp_s)) return skip("frame with an invalid stamp");
  newest_s_ = std::max(newest_s_, candidate.stamp_s);
  auto place = waiting_.end();
  while (place != waiting_.begin() && (place - 1)->stamp_s > candidate.stamp_s) --place;
  waiting_.insert(place, std::move(candidate));
}

bool FrameAssembler::isReady(const Candidate& candidate) const {
  if (finishing_ || waiting_.size() > kMostWaiting) return true;
  // The first sensory frame waits for the next entry: an action there tells that there is odometry.
  if (candidate.from_sensory_frame) return motion_seen_ || newest_entry_ > candidate.entry;
  const bool late = newest_s_ > candidate.stamp_s + kLate_s;
  const bool whole = candidate.scan && (candidate.scan->hasIntensityImage || candidate.image);
  if (!whole && !late) return false;
  const bool odometry_known = track_.empty()
                                  ? newest_s_ > candidate.stamp_s + OdometryTrack::kLongestReach_s
                                  : track_.lastStamp() >= candidate.stamp_s;
  return odometry_known || newest_s_ > candidate.stamp_s + OdometryTrack::kLongestGap_s;
}

std::optional<Frame> FrameAssembler::take() {
  while (!waiting_.empty() && isReady(waiting_.front())) {
    Candidate candidate = std::move(waiting_.front());
    waiting_.pop_front();
    if (auto frame = build(candidate)) return frame;
  }
  return std::nullopt;
}

std::optional<Frame> FrameAssembler::build(Candidate& candidate) {
  motion_delivered_.add(candidate.motion);
  T_odom_robot_ = T_odom_robot_ * candidate.motion.T_start_end();
  const bool depth_only = candidate.scan && !candidate.scan->hasIntensityImage && !candidate.image;
  if (depth_only && camera_label_) {
    ++damage_.ignored["depth without an image within 0.02 s"];
    if (!candidate.landmarks) return std::nullopt;
    candidate.scan.reset();
  }
  const auto refuse = [this](const std::string& reason) {
    skip(reason);
    return std::nullopt;
  };
  if (!isPlausibleStamp(candidate.stamp_s)) return refuse("frame with an invalid stamp");
  if (candidate.stamp_s == last_delivered_s_) return refuse("frame whose stamp repeats");
  if (candidate.stamp_s < last_delivered_s_) return refuse("frame whose stamp goes back");

  Frame frame;
  frame.stamp_s = candidate.stamp_s;
  std::string problem;
  std::optional<ImageView> image;
  std::optional<RangeImageView> depth;
  if (candidate.image) image = imageOf(*candidate.image, images_folder_, &problem);
  if (!image && candidate.scan) image = imageOf(*candidate.scan, images_folder_, &problem);
  if (!problem.empty()) skip(problem);
  problem.clear();
  if (candidate.scan) depth = depthOf(*candidate.scan, images_folder_, &problem);
  if (!problem.empty()) skip(problem);
  problem.clear();
  if (!builder_.build(image, depth, frame, &problem)) return refuse(problem);
  if (!problem.empty()) skip(problem);

  if (candidate.landmarks) frame.range_bearing = rangeBearingOf(*candidate.landmarks);
  if (candidate.from_sensory_frame) {
    if (motion_seen_)
      frame.odometry = OdometryReading{T_odom_robot_, motion_delivered_.covariance()};
    motion_delivered_ = MotionSum{};
  } else if (const auto T_odom_robot = track_.at(frame.stamp_s)) {
    frame.odometry = OdometryReading{*T_odom_robot, std::nullopt};
    track_.forgetBefore(frame.stamp_s);
  }
  last_delivered_s_ = frame.stamp_s;
  return frame;
}

}  // namespace colonnade
