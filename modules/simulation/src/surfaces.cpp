// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surfaces.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

constexpr float kJump = 0.04F;  ///< relative second difference of inverse depth that ends a surface

float smaller(float a, float b) { return std::abs(a) < std::abs(b) ? a : b; }

}  // namespace

Surfaces::Surfaces(const cv::Mat& perfect_depth_m)
    : depth_m(perfect_depth_m),
      inverse(depth_m.size(), CV_32FC1),
      slope(depth_m.size(), CV_32FC2),
      jump(depth_m.size(), CV_8UC1) {
  for (int row = 0; row < depth_m.rows; ++row) {
    const auto* z = depth_m.ptr<float>(row);
    auto* w = inverse.ptr<float>(row);
    for (int column = 0; column < depth_m.cols; ++column) {
      w[column] = z[column] > 0.0F ? 1.0F / z[column] : 0.0F;
    }
  }
  for (int row = 0; row < depth_m.rows; ++row) {
    const auto* w = inverse.ptr<float>(row);
    const auto* above = inverse.ptr<float>(row > 0 ? row - 1 : std::min(1, depth_m.rows - 1));
    const auto* below =
        inverse.ptr<float>(row + 1 < depth_m.rows ? row + 1 : std::max(0, depth_m.rows - 2));
    const bool inside = row > 0 && row + 1 < depth_m.rows;
    // At the image's border the only difference there is counts for both sides.
    const float sign_up = row > 0 ? 1.0F : -1.0F;
    const float sign_down = row + 1 < depth_m.rows ? 1.0F : -1.0F;
    auto* d = slope.ptr<cv::Vec2f>(row);
    auto* ends = jump.ptr<unsigned char>(row);
    for (int column = 0; column < depth_m.cols; ++column) {
      const bool has_left = column > 0, has_right = column + 1 < depth_m.cols;
      const float to_left = has_left ? w[column] - w[column - 1] : w[column + 1] - w[column];
      const float to_right = has_right ? w[column + 1] - w[column] : to_left;
      const float to_above = sign_up * (w[column] - above[column]);
      const float to_below = sign_down * (below[column] - w[column]);
      d[column] = {smaller(to_left, to_right), smaller(to_above, to_below)};
      float bend = has_left && has_right ? std::abs(to_right - to_left) : 0.0F;
      if (inside) bend = std::max(bend, std::abs(to_below - to_above));
      ends[column] = bend > kJump * w[column] ? 255 : 0;
    }
  }
}

}  // namespace colonnade
