// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

#include "colonnade/simulation/building.hpp"

namespace colonnade {

/// What a perfect camera sees.
struct RenderedView {
  cv::Mat colour;   ///< CV_8UC3, BGR
  cv::Mat depth_m;  ///< CV_32FC1, metres along the optical axis at the pixel's centre, 0 = nothing
};

/// Draws a building off-screen through MRPT and EGL; needs no display. Throws Error where no EGL
/// device is found. To be used in the thread that made it.
class Renderer {
 public:
  Renderer(const World& world, const Building& building);
  ~Renderer();

  /// What the robot's camera sees. `time_s` after the start of the route: people walk.
  RenderedView render(const Eigen::Isometry3d& T_world_camera, double time_s = 0.0);

  /// What the plain second camera sees (world.mono, which must be enabled): CV_8UC3, BGR.
  cv::Mat renderMono(const Eigen::Isometry3d& T_world_camera, double time_s = 0.0);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Why nothing can be rendered on this machine, or an empty text.
std::string whyNoRendering();

}  // namespace colonnade
