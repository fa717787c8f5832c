// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "colonnade/edges/fixed_stage.hpp"
#include "row_kernels.hpp"

namespace colonnade::fixed {

struct CannyResult {
  cv::Mat edges;                                   ///< as EdgeLines::edges
  std::array<std::vector<Pixel>, 4> of_direction;  ///< by gradient direction, in raster order
};

CannyResult canny(const cv::Mat& gray, const FixedParameters& parameters, int hysteresis_passes);

}  // namespace colonnade::fixed
