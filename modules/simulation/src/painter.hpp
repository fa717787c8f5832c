// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "colonnade/simulation/building.hpp"
#include "light.hpp"

namespace colonnade {

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
