// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/frames/floor_plane.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade::testing {

/// A plane of the world: points with normal . p = offset.
struct Wall {
  Eigen::Vector3d normal;
  double offset;
};

/// Someone flat, upright across the x axis, with a pattern that goes along.
struct Person {
  Eigen::Vector3d p_feet;
  double width_m = 0.5;
  double height_m = 1.8;

  bool isHit(const Eigen::Vector3d& p) const {
    return std::abs(p.y() - p_feet.y()) < 0.5 * width_m && p.z() < p_feet.z() + height_m;
  }
};

/// Planes under a smooth pattern (or none), rendered exactly, one ray a pixel.
struct Scene {
  std::vector<Wall> walls;
  bool textured = true;
  Eigen::Vector3d pattern_shift = Eigen::Vector3d::Zero();  ///< as of a light that moves
  std::optional<Person> person;
  double gloss = 0.0;        ///< share of the walls' light that the floor (z = 0) mirrors
  double depth_noise = 0.0;  ///< sigma at 1 m, growing with the square of the depth
  std::function<double(const Eigen::Vector3d&)> paint;  ///< instead of the pattern, but of people
  double brightness_noise = 0.0;                        ///< sigma, levels
  double lens_falloff = 0.0;  ///< brightness lost, times tan^2 of the angle off the axis

  static Scene corridor(bool textured, bool closed) {
    Scene scene;
    scene.textured = textured;
    scene.walls = {{Eigen::Vector3d::UnitZ(), 0.0},
                   {Eigen::Vector3d::UnitY(), 1.0},
                   {-Eigen::Vector3d::UnitY(), 1.2}};
    if (closed) scene.walls.push_back({Eigen::Vector3d::UnitX(), 4.0});
    return scene;
  }

  double brightness(const Eigen::Vector3d& p) const {
    if (!textured) return 128.0;
    const double a = p.x() + 0.6 * p.z();
    const double b = p.y() + 0.8 * p.z();
    return 128.0 + 28.0 * std::sin(9.0 * a + 1.0) + 28.0 * std::sin(11.0 * b) +
           22.0 * std::sin(23.0 * a - 17.0 * b) + 18.0 * std::sin(5.0 * a + 29.0 * b + 2.0);
  }

  /// Depth along the ray of the nearest plane; very far where there is none.
  double nearestWall(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) const {
    double nearest = 1e9;
    for (const Wall& wall : walls) {
      const double along = wall.normal.dot(ray);
      const double depth = (wall.offset - wall.normal.dot(origin)) / along;
      if (std::abs(along) > 1e-9 && depth > 1e-9 && depth < nearest) nearest = depth;
    }
    return nearest;
  }

  /// What is seen at a point that was hit: the pattern, on a polished floor under its mirror image.
  double shade(const Eigen::Vector3d& p, const Eigen::Vector3d& p_pattern,
               const Eigen::Vector3d& ray) const {
    const double own = brightness(p_pattern);
    if (gloss <= 0.0 || std::abs(p.z()) > 1e-6) return own;
    const Eigen::Vector3d reflected(ray.x(), ray.y(), -ray.z());
    const double depth = nearestWall(p, reflected);
    const double mirrored = depth < 1e8 ? brightness(p + depth * reflected) : 128.0;
    return (1.0 - gloss) * own + gloss * mirrored;
  }

  Frame render(std::size_t index, double stamp_s, const Eigen::Isometry3d& T_world_camera) const {
    Frame frame;
    frame.index = index;
    frame.stamp_s = stamp_s;
    frame.camera = {320, 240, 265.0, 265.0, 159.5, 119.5};
    frame.gray.create(240, 320, CV_8UC1);
    frame.depth_m.create(240, 320, CV_32FC1);
    cv::RNG random(static_cast<std::uint64_t>(index) + 7U);
    const Eigen::Vector3d origin = T_world_camera.translation();
    for (int v = 0; v < 240; ++v) {
      for (int u = 0; u < 320; ++u) {
        const Eigen::Vector3d ray = T_world_camera.linear() * frame.camera.ray(u, v);
        double nearest = nearestWall(origin, ray);
        const bool seen = nearest < 1e8;
        bool is_person = false;
        Eigen::Vector3d of_pattern = origin + nearest * ray - pattern_shift;
        if (person) {
          const double depth = (person->p_feet.x() - origin.x()) / ray.x();
          if (depth > 0.0 && depth < nearest && person->isHit(origin + depth * ray)) {
            nearest = depth;
            is_person = true;
            of_pattern = origin + depth * ray - person->p_feet;
          }
        }
        const double noise = depth_noise > 0.0 ? random.gaussian(depth_noise) : 0.0;
        frame.depth_m.at<float>(v, u) =
            nearest < 7.0 ? static_cast<float>(nearest + noise * nearest * nearest) : 0.0f;
        const double painted = paint && !is_person ? paint(of_pattern)
                                                   : shade(origin + nearest * ray, of_pattern, ray);
        const double on_axis = seen ? painted : 128.0;
        const double of_axis = (frame.camera.ray(u, v) - Eigen::Vector3d::UnitZ()).squaredNorm();
        const double shown = on_axis * (1.0 - lens_falloff * of_axis) +
                             (brightness_noise > 0.0 ? random.gaussian(brightness_noise) : 0.0);
        frame.gray.at<std::uint8_t>(v, u) =
            static_cast<std::uint8_t>(std::lround(std::clamp(shown, 0.0, 255.0)));
      }
    }
    return frame;
  }
};

/// The camera above (x, y) of the floor, looking along `heading`; positive pitch looks down,
/// positive roll lowers its right side.
inline Eigen::Isometry3d cameraInWorld(double x, double y, double height_m, double heading,
                                       double pitch, double roll = 0.0) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() << x, y, height_m;
  Eigen::Matrix3d R_level_camera;
  R_level_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  T.linear() = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
               Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()).toRotationMatrix() *
               Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()).toRotationMatrix() *
               R_level_camera;
  return T;
}

/// The mounting that a camera pose implies: robot on the floor below, x = optical axis.
inline Eigen::Isometry3d mountingOf(const Eigen::Isometry3d& T_world_camera) {
  return cameraAboveFloor(T_world_camera.linear().transpose() * Eigen::Vector3d::UnitZ(),
                          T_world_camera.translation().z());
}

}  // namespace colonnade::testing
