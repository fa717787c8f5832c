// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "kinect_slam.hpp"

#include <mrpt/poses/CPose3D.h>

#include <chrono>
#include <cmath>

#include "point_registration.hpp"

namespace colonnade {

KinectSlam::KinectSlam(const KinectSlamOptions& options, const MotionOptions& motion)
    : options_(options),
      motion_(motion),
      tracker_(options),
      map_(options.map_spacing_m, options.max_depth_m) {}

KinectSlam::Points KinectSlam::pointsOf(const Frame& frame) {
  static const Eigen::Matrix3d R_forward_optical = forwardFromOptical().linear();
  Points points;
  for (const TrackedFeature& feature : tracker_.track(frame.gray)) {
    const auto u = static_cast<int>(feature.p_px.x());
    const auto v = static_cast<int>(feature.p_px.y());
    const double depth = static_cast<double>(frame.depth_m.at<float>(v, u));
    if (!(depth > 0.05) || depth >= options_.max_depth_m) continue;
    points[feature.id] =
        R_forward_optical * (depth * frame.camera.ray(feature.p_px.x(), feature.p_px.y()));
  }
  return points;
}

bool KinectSlam::isNewKeyFrame(const Eigen::Isometry3d& T_key_now) const {
  const mrpt::poses::CPose3D pose(mrpt::math::CMatrixDouble44(T_key_now.matrix()));
  return pose.norm() > options_.keyframe_distance_m ||
         std::abs(pose.yaw()) > options_.keyframe_angle ||
         std::abs(pose.pitch()) > options_.keyframe_angle ||
         std::abs(pose.roll()) > options_.keyframe_angle;
}

double KinectSlam::startKeyFrame(const Frame& frame, const Points& points) {
  T_first_key_ = T_first_key_ * T_key_now_;
  T_key_now_.setIdentity();
  key_points_ = points;
  ++key_frames_;
  if (!options_.map) return 0.0;
  const auto start = std::chrono::steady_clock::now();
  const Eigen::Isometry3d T_forward_optical = forwardFromOptical();
  map_.add(frame, T_world_first_ * T_forward_optical.inverse() * T_first_key_ * T_forward_optical);
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

BaselineStep KinectSlam::step(const Frame& frame) {
  BaselineStep step;
  if (!path_) {
    T_world_first_ = firstMounting(frame, motion_);
    path_.emplace(T_world_first_);
  }
  if (frame.gray.empty() || frame.depth_m.empty()) {
    step.lost = frame.gray.empty() ? "no image" : "no depth";
  } else {
    const Points points = pointsOf(frame);
    if (key_points_.empty()) {  // the first frame with corners that have depth
      if (points.empty()) step.lost = "no corners with depth";
      if (!points.empty()) step.map_ms = startKeyFrame(frame, points);
    } else {
      std::vector<PointPair> pairs;
      for (const auto& [id, p_now] : points)
        if (const auto key = key_points_.find(id); key != key_points_.end())
          pairs.push_back({key->second, p_now});
      matched_ += pairs.size();
      ++matched_frames_;
      if (const auto T_key_now = registerPoints(pairs)) {
        T_key_now_ = *T_key_now;
        lost_in_a_row_ = 0;
        if (isNewKeyFrame(T_key_now_)) step.map_ms = startKeyFrame(frame, points);
      } else {
        step.lost = pairs.size() < 3 ? "fewer than 3 corners in common with the key frame"
                                     : "no rigid motion found";
        if (options_.reanchor_after > 0 && ++lost_in_a_row_ >= options_.reanchor_after &&
            points.size() >= 3) {
          step.map_ms = startKeyFrame(frame, points);
          lost_in_a_row_ = 0;
          ++reanchored_;
        }
      }
    }
  }
  const Eigen::Isometry3d T_forward_optical = forwardFromOptical();
  step.T_world_robot =
      path_->robot(T_forward_optical.inverse() * T_first_key_ * T_key_now_ * T_forward_optical);
  return step;
}

std::map<std::string, double> KinectSlam::figures() const {
  return {{"key_frames", static_cast<double>(key_frames_)},
          {"pairs_per_frame", matched_frames_ > 0 ? static_cast<double>(matched_) /
                                                        static_cast<double>(matched_frames_)
                                                  : 0.0},
          {"reanchored", static_cast<double>(reanchored_)},
          {"map_points", static_cast<double>(map_.size())}};
}

void KinectSlam::writeMap(const std::filesystem::path& folder) const {
  if (options_.map && map_.size() > 0) map_.write(folder / "map.ply");
}

}  // namespace colonnade
