// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/pose2.hpp"

namespace colonnade {

/// How sure integrated wheel speeds are: a random walk, variances grow with way and turn. Wider
/// than what the wheels of data set 7 show against motion capture over a few seconds (0.09 m along,
/// 8 degrees after 1 rad), because part of it lasts: all five robots turn 0.05 to 0.25 degrees a
/// second less and drive 7 % less than their wheels say.
struct WheelSpeedNoise {
  double along_m = 0.10;          ///< m after 1 m
  double across_m = 0.03;         ///< m after 1 m
  double heading = radians(5.0);  ///< rad after 1 m
  double turn = radians(10.0);    ///< rad after 1 rad
  double floor_m = 0.001;         ///< of every increment, even at rest
  double floor_angle = radians(0.1);
};

/// The motion of a robot that drives with constant speed and turn rate: an arc of a circle.
Pose2 arcOf(double speed_m_s, double turn_rate, double duration_s);

/// Motion and its covariance (x, y, phi in the axes of the robot at the start) over one or more
/// arcs, the noise as above without its floor.
class ArcSum {
 public:
  explicit ArcSum(const WheelSpeedNoise& noise) : noise_(noise) {}
  void add(double speed_m_s, double turn_rate, double duration_s);
  const Pose2& motion() const { return T_start_end_; }
  /// With the floor.
  Eigen::Matrix3d covariance() const;

 private:
  WheelSpeedNoise noise_;
  Pose2 T_start_end_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

struct MrclamImportOptions {
  std::filesystem::path folder;
  int robot = 1;  ///< 1 to 5
  std::filesystem::path log;
  /// Written into every observation. Against motion capture ranges err by about 0.05 m a metre and
  /// bearings by 0.5 to 1.5 degrees (data set 7, all robots); errors of neighbouring readings
  /// resemble each other, so that a single reading counts for less.
  double range_sigma_m = 0.25;
  double bearing_sigma = radians(1.5);
  WheelSpeedNoise odometry;
  std::function<void(std::size_t done, std::size_t all)> progress;
};

/// A cylinder as motion capture placed it.
struct MrclamLandmark {
  int subject = 0;
  Eigen::Vector2d p_world = Eigen::Vector2d::Zero();
  Eigen::Vector2d sigma = Eigen::Vector2d::Zero();
  std::size_t readings = 0;  ///< of it in the log
};

struct MrclamImportResult {
  std::size_t frames = 0;
  std::size_t readings = 0;                     ///< of landmarks, written
  std::map<int, std::size_t> robot_readings;    ///< subject -> dropped
  std::map<int, std::size_t> unknown_barcodes;  ///< barcode -> dropped
  std::size_t bad_ranges = 0;                   ///< readings at zero or negative range, dropped
  double path_m = 0.0;                          ///< by odometry
  std::vector<MrclamLandmark> landmarks;        ///< the truth
  std::filesystem::path ground_truth;           ///< STEM_ground_truth.tum
  std::size_t ground_truth_poses = 0;
};

/// One robot of the UTIAS multi-robot data sets (Leung, Halpern, Barfoot, Liu, IJRR 2011) as a
/// rawlog: action and sensory-frame pairs, one for every measurement stamp, also where it holds
/// other robots only. Actions: wheel speeds, each held until the next, integrated as exact arcs.
/// Observations: CObservationBearingRange whose landmarkID is the subject (6 to 20); the moving
/// robots (1 to 5) and barcodes nobody has are dropped and counted. Writes the truth of the robot
/// beside the log. Throws Error, naming file and line, for what cannot be read.
MrclamImportResult importMrclam(const MrclamImportOptions& options);

}  // namespace colonnade
