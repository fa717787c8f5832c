// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "colonnade/base/pose2.hpp"

namespace colonnade {

/// An ideal pinhole camera, in pixels; pixel centres have whole coordinates. Sources remove lens
/// distortion before they hand out a frame.
struct PinholeCamera {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;

  bool isCalibrated() const { return fx_px > 0.0 && fy_px > 0.0; }
  /// The viewing ray of a pixel in the optical frame (x right, y down, z = 1 forward).
  Eigen::Vector3d ray(double u_px, double v_px) const {
    return {(u_px - cx_px) / fx_px, (v_px - cy_px) / fy_px, 1.0};
  }
};

/// Where wheel odometry places the robot at the time of a frame, in a world of its own that drifts.
struct OdometryReading {
  Pose2 T_odom_robot;
  /// Covariance (x, y, phi) of the motion since the former frame, in the axes of the robot there,
  /// where the log states one (CActionRobotMovement2D); otherwise a motion model must.
  std::optional<Eigen::Matrix3d> increment_covariance;
};

/// A landmark some other program measured (CObservationBearingRange): metres, radians, relative to
/// the sensor (x forward). id < 0: identity not known.
struct RangeBearing {
  std::int32_t id = -1;
  double range_m = 0.0;
  double yaw = 0.0;
  double pitch = 0.0;
  /// Of (range, yaw), where the log states one for this very reading.
  std::optional<Eigen::Matrix2d> covariance = std::nullopt;
};

struct RangeBearingScan {
  Eigen::Isometry3d T_robot_sensor = Eigen::Isometry3d::Identity();
  double range_sigma_m = 0.0;  ///< 0: the log does not say
  double yaw_sigma = 0.0;
  std::vector<RangeBearing> readings;
};

/// Everything known at one instant. Images share one pinhole camera: depth is registered to it.
struct Frame {
  std::size_t index = 0;  ///< 0, 1, 2 ... in the order of the log
  double stamp_s = 0.0;   ///< seconds, as in the log (UNIX time for MRPT logs)
  cv::Mat colour;         ///< CV_8UC3 (BGR), or empty
  cv::Mat gray;           ///< CV_8UC1, or empty
  cv::Mat depth_m;        ///< CV_32FC1, metres along the optical axis, 0 = not measured; or empty
  PinholeCamera camera;
  /// The optical frame (x right, y down, z forward) on the robot (x forward, y left, z up, origin
  /// on the floor).
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  std::optional<OdometryReading> odometry;
  std::optional<RangeBearingScan> range_bearing;
};

}  // namespace colonnade
