// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "colonnade/frames/rawlog_writer.hpp"
#include "colonnade/simulation/colour_noise.hpp"
#include "colonnade/simulation/depth_noise.hpp"
#include "colonnade/simulation/odometry_noise.hpp"
#include "colonnade/simulation/renderer.hpp"
#include "colonnade/simulation/truth.hpp"
#include "special_surfaces.hpp"

namespace colonnade {

/// One instant of the drive as it is.
struct TrueFrame {
  std::size_t index = 0;
  double time_s = 0.0;      ///< since the start
  double interval_s = 0.0;  ///< since the frame before
  double driven_m = 0.0;    ///< since the start
  Pose2 T_world_robot;
  Pose2 T_previous_robot;
  RenderedView view = {};
  cv::Mat mono = {};  ///< CV_8UC3, or empty
};

/// Measures true frames with the robot's sensors and writes log and columns, frame by frame.
class Recorder {
 public:
  Recorder(const World& world, const Building& building, const std::filesystem::path& log,
           std::uint64_t seed, int gz_level);

  void add(const TrueFrame& frame);
  void finish();

  const Truth& truth() const { return truth_; }
  static double stampOf(const TrueFrame& frame);

 private:
  const World& world_;
  OdometryNoise odometry_;
  DepthNoise depth_;
  ColourNoise colour_;
  ColourNoise mono_;
  double mono_before_s_ = 0.0;
  Truth truth_;
  SpecialSurfaces special_;
  RawlogWriter log_;
  ColumnsFile columns_;
};

}  // namespace colonnade
