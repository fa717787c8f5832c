// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "colonnade/edges/fixed_stage.hpp"

namespace colonnade::fixed {

/// Edge pixels of one gradient direction in raster order, from the image's centre.
struct PixelList {
  std::vector<std::int16_t> x;
  std::vector<std::int16_t> y;
};

struct CannyResult {
  cv::Mat edges;  ///< as EdgeLines::edges
  std::array<PixelList, 4> of_direction;
};

CannyResult canny(const cv::Mat& gray, const FixedParameters& parameters, int hysteresis_passes);

}  // namespace colonnade::fixed
