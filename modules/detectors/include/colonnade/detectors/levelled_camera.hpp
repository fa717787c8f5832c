// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// The geometry between pixels and the robot's axes (x forward, y left, z up, origin on the floor),
/// with the camera's tilt taken out.
class LevelledCamera {
 public:
  /// Throws Error when the frame's camera is not calibrated.
  explicit LevelledCamera(const Frame& frame);
  /// The same camera with small errors in its mounting: turned by `tilt` (radians about the robot's
  /// x and y axes) around its own centre and raised by `height_m`. For numeric derivatives.
  LevelledCamera disturbed(const Eigen::Vector2d& tilt, double height_m) const;

  const Eigen::Vector3d& centre() const { return p_robot_camera_; }
  double height() const { return p_robot_camera_.z(); }
  /// The viewing ray in the robot's axes; its length is such that depth * ray is the point's offset
  /// from the camera's centre.
  Eigen::Vector3d ray(double u_px, double v_px) const {
    return ray_at_0_ + u_px * ray_per_u_ + v_px * ray_per_v_;
  }
  Eigen::Vector3d ray(const Eigen::Vector2d& p_px) const { return ray(p_px.x(), p_px.y()); }
  /// Where the ray of a pixel meets the floor z = 0; nothing on or above the horizon.
  std::optional<Eigen::Vector2d> floorPoint(const Eigen::Vector2d& p_px) const;
  /// The pixel of a point; nothing behind the camera.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_robot) const;
  /// Unit direction in the image, at that pixel, of a line that is vertical in space, pointing
  /// down.
  Eigen::Vector2d downDirection(const Eigen::Vector2d& p_px) const;

 private:
  void setRays();

  PinholeCamera camera_;
  Eigen::Matrix3d R_robot_camera_;
  Eigen::Vector3d p_robot_camera_;
  Eigen::Vector3d ray_at_0_, ray_per_u_, ray_per_v_;  ///< of pixel (0, 0) and from pixel to pixel
};

}  // namespace colonnade
