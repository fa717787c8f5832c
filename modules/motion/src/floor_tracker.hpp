// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "colonnade/base/pose2.hpp"
#include "colonnade/frames/frame.hpp"
#include "colonnade/motion/motion.hpp"
#include "colonnade/motion/motion_options.hpp"
#include "mirrored_cells.hpp"
#include "motion_sum.hpp"
#include "rgbd_alignment.hpp"

namespace colonnade {

/// Visual odometry without depth: the camera's height and tilt say how far every pixel of the floor
/// is, so the floor's texture is aligned to that of a key frame, with the three unknowns of a robot
/// that moves in the plane (a homography of a known plane; Lovegrove, Davison and Ibanez-Guzman,
/// "Accurate visual odometry from a rear parking camera", IV 2011). What stands on the
/// floor moves otherwise and is left out (StandingTest).
class FloorTracker {
 public:
  explicit FloorTracker(const MotionOptions& options) : options_(options) {}

  /// Frames in the order of time, without gaps. `guess`: the robot's motion since the former one,
  /// by the wheels or else at the former velocity. Nothing: no floor in view, too little texture,
  /// no alignment, or one that wheels have not borne out.
  ///
  /// A polished floor shows what it mirrors, and that moves less than the floor: the way since the
  /// key frame falls short of the wheels' by little in each frame and by much in all. Once it does,
  /// and at the start, the floor is not believed until it agrees with the wheels over some way.
  /// Without wheels it always is.
  std::optional<MotionIncrement> track(const Frame& frame, const MotionIncrement& guess);
  /// Whether a floor that was believed contradicts the wheels in the frame tracked last: then the
  /// wheels may have slipped as well.
  bool contradictsWheels() const { return contradicts_; }
  /// A frame that was not tracked came in between.
  void reset();

 private:
  struct Placed {
    Pose2 T_key_robot;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< axes of the robot now
    double share = 0.0;                                    ///< of the key frame's points in view
  };
  std::optional<Placed> align(const RgbdPyramid& current, const Pose2& guess_T_key_robot,
                              const Eigen::Isometry3d& T_robot_camera) const;
  /// A picture of the same place from elsewhere, which tells floor from what stands on it.
  struct Witness {
    PyramidLevel level;
    Eigen::Isometry3d T_robot_camera;
    Pose2 T_key_robot;
  };
  enum class Verdict { kAgrees, kOpen, kContradicts };
  /// The way since the key frame against the wheels'; open where it is too short, or not measured.
  Verdict judgeByWheels(const Placed& placed) const;
  /// Leaves out what the floor mirrors, as long as the key frame lasts. Whether there was anything.
  bool leaveOutMirrored(const RgbdPyramid& current, const Pose2& T_key_robot,
                        const Eigen::Isometry3d& T_robot_camera);
  void makeKey(RgbdPyramid pyramid, const Eigen::Isometry3d& T_robot_camera);
  void placePoints();

  MotionOptions options_;
  std::optional<Reference> key_;
  Eigen::Isometry3d T_robot_camera_key_ = Eigen::Isometry3d::Identity();
  std::vector<Witness> witnesses_;      ///< former key frames, oldest first
  Placed previous_;                     ///< in the key frame's axes
  std::optional<MotionSum> by_wheels_;  ///< since the key frame, if all of it is measured
  bool has_wheels_ = false;
  bool believed_ = false;  ///< if there are wheels
  bool contradicts_ = false;
  PolishedFloor polish_;
};

/// The depth along the optical axis (CV_32FC1, metres) at which each pixel's ray meets the floor; 0
/// where that is beyond `reach_m` or nowhere.
cv::Mat floorDepth(const PinholeCamera& camera, const Eigen::Isometry3d& T_robot_camera,
                   double reach_m);

}  // namespace colonnade
