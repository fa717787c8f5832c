// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/pose2.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade::testing {

/// A room of planes with a pattern of gray blocks, full of corners to follow and, with a slanted
/// wall and a step, of shape that fixes every direction. One ray a pixel, no noise.
class PatternedRoom {
 public:
  PatternedRoom()
      : planes_{{{0, 0, 1}, 0.0},   {{0, 0, -1}, -2.6}, {{-1, 0, 0}, -4.5},
                {{0, -1, 0}, -1.6}, {{0, 1, 0}, -1.8},  {{-0.8, 0.6, 0}, -3.4}} {}

  /// The camera on a robot: height, place and tilt fixed.
  static Eigen::Isometry3d mounting() {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    T.linear() =
        Eigen::AngleAxisd(radians(8.0), Eigen::Vector3d::UnitY()).toRotationMatrix() * T.linear();
    T.translation() << 0.2, 0.05, 1.0;
    return T;
  }

  Frame render(std::size_t index, const Pose2& T_world_robot) const {
    Frame frame;
    frame.index = index;
    frame.stamp_s = 100.0 + 0.1 * static_cast<double>(index);
    frame.camera = {320, 240, 270.0, 272.0, 161.0, 117.5};
    frame.T_robot_camera = mounting();
    frame.odometry = OdometryReading{T_world_robot, std::nullopt};  // a robot carries the camera
    frame.gray.create(240, 320, CV_8UC1);
    frame.depth_m.create(240, 320, CV_32FC1);
    const Eigen::Isometry3d T_world_camera = T_world_robot.toIsometry3() * mounting();
    for (int v = 0; v < 240; ++v) {
      for (int u = 0; u < 320; ++u) {
        const Eigen::Vector3d ray = T_world_camera.linear() * frame.camera.ray(u, v);
        double nearest = 1e9;
        std::uint32_t which = 0;
        for (std::uint32_t i = 0; i < planes_.size(); ++i) {
          const double along = planes_[i].normal.dot(ray);
          const double depth =
              (planes_[i].offset - planes_[i].normal.dot(T_world_camera.translation())) / along;
          if (std::abs(along) > 1e-9 && depth > 0.0 && depth < nearest) {
            nearest = depth;
            which = i;
          }
        }
        frame.depth_m.at<float>(v, u) = static_cast<float>(nearest);
        frame.gray.at<std::uint8_t>(v, u) =
            block(T_world_camera.translation() + nearest * ray, which);
      }
    }
    cv::GaussianBlur(frame.gray, frame.gray, {3, 3}, 0.7);
    return frame;
  }

 private:
  struct Plane {
    Eigen::Vector3d normal;
    double offset;
  };

  static std::uint8_t block(const Eigen::Vector3d& p, std::uint32_t plane) {
    std::uint32_t hash = 2166136261u ^ plane;
    for (const double x : {p.x(), p.y(), p.z()}) {
      hash ^= static_cast<std::uint32_t>(static_cast<int>(std::floor(x / 0.17 + 0.31)) + 1000);
      hash *= 16777619u;
      hash ^= hash >> 13;
    }
    return static_cast<std::uint8_t>(40 + hash % 176);
  }

  std::vector<Plane> planes_;
};

/// Ahead and round a bend: 4 cm and 1 degree a frame.
inline std::vector<Pose2> bend(std::size_t frames) {
  std::vector<Pose2> poses = {{0.3, -0.2, 0.1}};
  while (poses.size() < frames) poses.push_back(poses.back() * Pose2{0.04, 0.0, radians(1.0)});
  return poses;
}

}  // namespace colonnade::testing
