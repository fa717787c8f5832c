// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <utility>

#include "colonnade/simulation/building.hpp"
#include "light.hpp"

namespace colonnade {

constexpr double kJointM = 0.008;      ///< width of the joints of tiles and sheets
constexpr double kPanelLineM = 0.015;  ///< width of the lines around a leaf's sunk panels

/// From the middle of a panelled face to the outer side of the line around its panels; below 0.05
/// there are none.
constexpr double panelHalfWidth(double face_width_m) { return 0.5 * face_width_m - 0.14; }
/// Lower and upper end of the two panels.
constexpr std::array<std::pair<double, double>, 2> panelHeights(double face_height_m) {
  return {{{0.18, 0.42 * face_height_m}, {0.50 * face_height_m, face_height_m - 0.15}}};
}

/// Paints a face, CV_8UC3 (BGR), row 0 at its top: the pattern of its material, plaster noise and
/// the light that falls on it. The same face always gets the same picture.
class Painter {
 public:
  Painter(const World& world, const Building& building);

  cv::Mat paint(const Face& face, std::uint32_t seed, int width_px, int height_px) const;

 private:
  Eigen::Vector3d colourAt(const Material& material, double along_m, double up_m,
                           const Eigen::Vector2d& size_m, std::uint32_t seed) const;
  cv::Mat lightMap(const Face& face, int width_px, int height_px) const;
  /// Coarse noise of the surface in [-1.6, 1.6].
  cv::Mat blotchMap(const Eigen::Vector2d& size_m, std::uint32_t seed, int width_px,
                    int height_px) const;

  const World& world_;
  Light light_;
};

}  // namespace colonnade
