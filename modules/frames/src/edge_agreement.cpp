// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "edge_agreement.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace colonnade {
namespace {

/// Far beyond the noise of a depth camera.
bool jumps(float a, float b) {
  return a > 0.0F && b > 0.0F && std::abs(a - b) > 0.1F + 0.03F * std::min(a, b);
}

}  // namespace

EdgeAgreement edgeAgreement(const cv::Mat& depth_m, const cv::Mat& gray) {
  cv::Mat dx, dy, gradient;
  cv::Sobel(gray, dx, CV_32F, 1, 0);
  cv::Sobel(gray, dy, CV_32F, 0, 1);
  cv::magnitude(dx, dy, gradient);
  cv::dilate(gradient, gradient, cv::Mat());  // a pixel of doubt about where the jump lies
  EdgeAgreement agreement;
  double at_jumps = 0.0, elsewhere = 0.0;
  int others = 0;
  for (int v = 1; v + 1 < depth_m.rows; ++v) {
    const auto* line = depth_m.ptr<float>(v);
    const auto* below = depth_m.ptr<float>(v + 1);
    const auto* slope = gradient.ptr<float>(v);
    for (int u = 1; u + 1 < depth_m.cols; ++u) {
      if (line[u] == 0.0F) continue;
      if (jumps(line[u], line[u + 1]) || jumps(line[u], below[u])) {
        at_jumps += static_cast<double>(slope[u]);
        ++agreement.jumps;
      } else {
        elsewhere += static_cast<double>(slope[u]);
        ++others;
      }
    }
  }
  if (agreement.jumps > 0 && others > 0)
    agreement.strength = (at_jumps / agreement.jumps) / (elsewhere / others + 1.0);
  return agreement;
}

}  // namespace colonnade
