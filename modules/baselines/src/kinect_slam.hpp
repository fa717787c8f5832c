// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>

#include "camera_path.hpp"
#include "colonnade/baselines/baseline.hpp"
#include "coloured_map.hpp"
#include "feature_tracker.hpp"

namespace colonnade {

/// The method of MRPT's kinect-3d-slam, which itself takes nothing but a live Kinect: corners
/// followed by Lucas-Kanade, put into space by their depth, registered robustly against the last
/// key frame; a key frame every 0.10 m or 10 degrees, each added to a coloured point map. It uses
/// neither odometry nor the knowledge that the floor is flat.
class KinectSlam : public Baseline {
 public:
  KinectSlam(const KinectSlamOptions& options, const MotionOptions& motion);
  BaselineStep step(const Frame& frame) override;
  std::map<std::string, double> figures() const override;
  void writeMap(const std::filesystem::path& folder) const override;

 private:
  using Points = std::map<std::uint64_t, Eigen::Vector3d>;  ///< by corner; x forward, metres

  Points pointsOf(const Frame& frame);
  double startKeyFrame(const Frame& frame, const Points& points);
  bool isNewKeyFrame(const Eigen::Isometry3d& T_key_now) const;

  KinectSlamOptions options_;
  MotionOptions motion_;
  FeatureTracker tracker_;
  ColouredMap map_;
  std::optional<CameraPath> path_;
  Points key_points_;
  Eigen::Isometry3d T_first_key_ = Eigen::Isometry3d::Identity();  ///< x forward
  Eigen::Isometry3d T_key_now_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_world_first_ = Eigen::Isometry3d::Identity();  ///< optical, for the map
  int lost_in_a_row_ = 0;
  std::size_t key_frames_ = 0;
  std::size_t reanchored_ = 0;
  std::size_t matched_ = 0;
  std::size_t matched_frames_ = 0;
};

}  // namespace colonnade
