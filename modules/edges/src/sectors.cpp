// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sectors.hpp"

#include <cstdlib>

namespace colonnade {

int gradientSector(int gradient_u, int gradient_v) {
  const int u = std::abs(gradient_u);
  const int v = std::abs(gradient_v);
  if (v * 256 <= u * 106) return gradient_u >= 0 ? 0 : 4;
  if (u * 256 <= v * 106) return gradient_v >= 0 ? 2 : 6;
  if (gradient_v >= 0) return gradient_u >= 0 ? 1 : 3;
  return gradient_u >= 0 ? 7 : 5;
}

void encodeSectors(const cv::Mat& gradient_u, const cv::Mat& gradient_v, cv::Mat& edges) {
  for (int row = 0; row < edges.rows; ++row) {
    auto* edge = edges.ptr<unsigned char>(row);
    const auto* du = gradient_u.ptr<short>(row);
    const auto* dv = gradient_v.ptr<short>(row);
    for (int column = 0; column < edges.cols; ++column) {
      if (edge[column] == 0) continue;
      edge[column] = static_cast<unsigned char>(1 + gradientSector(du[column], dv[column]));
    }
  }
}

}  // namespace colonnade
