// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration_fits.hpp"
#include "colonnade/base/options.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// The calibration of a camera and one known pillar, as `calibrate -o` writes it, and the way of
/// the thesis to trace a path with it. A model whose first number is 0 is not calibrated.
struct PathMapOptions {
  static constexpr const char* kSection = "PathMap";
  std::string model = "pinhole";
  double pinhole_px_m = 0.0;  ///< focal length times width of the pillar
  double focal_px = 0.0;
  double centre_px = 0.0;
  double at_zero_px = 0.0;
  double decades_per_m = 0.0;
  double slope_m_per_px = 0.0;
  double offset_m = 0.0;
  int period_frames = 100;
  double tolerance_m = 0.0254;  ///< 1 inch

  void visit(OptionVisitor& v) {
    v.choice("model", model, {"pinhole", "exponential"}, "exponential: with the linear shift");
    v.number("pinhole_px_m", pinhole_px_m, {0, 1e5}, "distance = this / delta rho");
    v.number("focal_px", focal_px, {0, 1e5}, "shift = distance (centre - left rho) / focal");
    v.number("centre_px", centre_px, {-1e5, 1e5}, "column of the left edge at shift 0");
    v.number("at_zero_px", at_zero_px, {0, 1e5}, "distance = -log10(delta rho / this) / decades");
    v.number("decades_per_m", decades_per_m, {0, 100}, "of the exponential");
    v.number("slope_m_per_px", slope_m_per_px, {-10, 10}, "shift = slope left rho + offset");
    v.number("offset_m", offset_m, {-1e4, 1e4}, "of the linear shift");
    v.integer("period_frames", period_frames, {2, 100000}, "frames to a step of the path");
    v.number("tolerance_m", tolerance_m, {1e-4, 10},
             "distances so near to the first of a period are averaged");
  }
};

/// The path of a camera before a known pillar, a step every 100 frames (thesis 2015, section 2.8,
/// figures 39 to 41): the distance at the beginning of a period is the mean of those near its first
/// one, the change is that of its last frame; the shift is last less first, not averaged.
class PathMap {
 public:
  /// Throws Error (kUsage) when the model chosen has no calibration.
  explicit PathMap(const PathMapOptions& options);

  void add(const Frame& frame, const std::optional<PillarPlace>& pillar);
  /// Closes the last period, however short.
  void finish();

  struct Point {
    double stamp_s;
    std::size_t frame;
    double shift_m;     ///< of the camera to the right of the pillar's left edge
    double distance_m;  ///< from the pillar
  };
  const std::vector<Point>& path() const { return path_; }
  /// path_map.csv and path_map.png.
  void write(const std::filesystem::path& folder) const;

 private:
  void closePeriod();

  PathMapOptions options_;
  std::vector<Point> period_;  ///< frames that saw the pillar
  int frames_in_period_ = 0;
  std::vector<Point> path_;
};

}  // namespace colonnade
