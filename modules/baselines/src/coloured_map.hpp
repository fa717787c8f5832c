// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <memory>

#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// mrpt::maps::CColouredPointsMap of key frames, as kinect-3d-slam keeps one. Grows by about 1.5 MB
/// a key frame of 640x480.
class ColouredMap {
 public:
  /// spacing_m: a point nearer than this to the one kept before it in its row is left out (MRPT's
  /// minDistBetweenLaserPoints, 0.02 by default).
  ColouredMap(double spacing_m, double max_depth_m);
  ~ColouredMap();
  /// T_world_camera: optical.
  void add(const Frame& frame, const Eigen::Isometry3d& T_world_camera);
  std::size_t size() const;
  /// Binary PLY with colours (MRPT's own writer leaves them out), written atomically.
  void write(const std::filesystem::path& path) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colonnade
