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

/// What the numbers of a UTIAS MRCLAM folder mean. Its "odometry" are the commands given to the
/// robots, its ranges come from how tall a barcode stands in a rectified image (the data set's
/// page, asrl.utias.utoronto.ca/datasets/mrclam). Sizes: fitted to robots 1 to 3 of data set 7
/// against motion capture; behind each the fits of other sets of the five. Robots 4 and 5, left
/// out, have their way within 3 % with them, but robot 4 reads 0.09 m too far. As recorded, way is
/// 9 to 14 % too long, and ranges are 8 % too short where a landmark stands 0.4 rad beside the
/// optical axis.
///
/// Turns, seen against motion capture: records of turns to the left and to the right differ by
/// twice turn_offset while the turns do not; a wide arc, whatever its record says, is driven as one
/// and the same (the robot's drive command knows no larger radius); and the wheels begin to turn
/// only when the command has run up some angle, more on the spot, where both start from rest.
struct MrclamCalibration {
  double drive_delay_s = 0.21;      ///< from a command to the motion
  double speed_gain = 1.05;         ///< of the commanded speed, straight on (1.04 to 1.05)
  double slowed_by_turn = 0.097;    ///< m/s lost for 1 rad/s while driving (0.092 to 0.103)
  double turn_gain = 0.987;         ///< of the commanded turn while driving (0.984 to 0.988)
  double turn_gain_on_spot = 1.03;  ///< (0.96 to 1.04)
  double turn_offset = 0.0057;      ///< rad/s, in the records of every turn (0.005 to 0.007)
  double least_turn_rate = 0.0246;  ///< rad/s: no wider arc can be driven (0.018 to 0.025)
  double least_turn_below = 0.04;   ///< rad/s: commands that end in the widest arc
  /// rad commanded before a turn begins
  double breakaway_on_the_way = 0.013;  ///< (0.009 to 0.015)
  double breakaway_on_spot = 0.045;     ///< (0.04 to 0.1)
  double camera_delay_s = 0.04;         ///< from the image to its stamp (0.037 to 0.046)
  bool range_is_depth = true;           ///< along the optical axis: range times cos(bearing)
  double depth_offset_m = 0.037;        ///< read = offset + gain * depth (offset 0.006 to 0.09)
  double depth_gain = 1.016;            ///< (1.012 to 1.05)

  /// The numbers as they stand in the files.
  static MrclamCalibration asRecorded();
};

/// How sure the motion of the wheels is: a random walk, variances grow with way and turn. As wide
/// as data set 7 shows against motion capture with the calibration above (over 2 to 16 s, robots 1
/// to 3: 0.023 to 0.046 m along, 4 to 6.5 degrees after 1 rad, on the spot 8, 0 to 3 degrees after
/// 1 m): the robots take commands five times a second only, so where a turn starts and ends is
/// known to 0.2 s.
struct WheelSpeedNoise {
  double along_m = 0.05;          ///< m after 1 m
  double across_m = 0.02;         ///< m after 1 m
  double heading = radians(3.0);  ///< rad after 1 m
  double turn = radians(6.0);     ///< rad after 1 rad
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
  MrclamCalibration calibration;
  /// Written into every observation; as data set 7 shows against motion capture: 68 % of the
  /// readings of a robot are within 0.02 to 0.06 m and 0.3 to 0.6 degrees (robot 1: 1.5) of their
  /// median error.
  double range_sigma_m = 0.05;
  double bearing_sigma = radians(0.6);
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
