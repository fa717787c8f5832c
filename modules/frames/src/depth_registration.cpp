// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "depth_registration.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

// Slightly more than a pixel, so that rounding leaves no holes in a surface seen square on.
constexpr float kFootprint = 1.3F;

bool same(const PinholeCamera& a, const PinholeCamera& b) {
  return a.width_px == b.width_px && a.height_px == b.height_px && a.fx_px == b.fx_px &&
         a.fy_px == b.fy_px && a.cx_px == b.cx_px && a.cy_px == b.cy_px;
}

}  // namespace

void DepthRegistration::prepare(const PinholeCamera& from, const Eigen::Matrix3d& R_to_from) {
  if (!rays_.empty() && same(from, from_) && R_to_from == R_to_from_) return;
  from_ = from;
  R_to_from_ = R_to_from;
  rays_.clear();
  rays_.reserve(static_cast<std::size_t>(from.width_px) * static_cast<std::size_t>(from.height_px));
  for (int v = 0; v < from.height_px; ++v)
    for (int u = 0; u < from.width_px; ++u)
      rays_.emplace_back((R_to_from * from.ray(u, v)).cast<float>());
}

cv::Mat DepthRegistration::registered(const cv::Mat& depth_m, const PinholeCamera& from,
                                      const PinholeCamera& to, const Eigen::Isometry3d& T_to_from) {
  prepare(from, T_to_from.linear());
  const Eigen::Vector3f shift = T_to_from.translation().cast<float>();
  const auto fx = static_cast<float>(to.fx_px), fy = static_cast<float>(to.fy_px);
  const auto cx = static_cast<float>(to.cx_px), cy = static_cast<float>(to.cy_px);
  const float half_x = 0.5F * kFootprint * fx / static_cast<float>(from.fx_px);
  const float half_y = 0.5F * kFootprint * fy / static_cast<float>(from.fy_px);
  cv::Mat result(to.height_px, to.width_px, CV_32FC1, cv::Scalar(0));
  const Eigen::Vector3f* ray = rays_.data();
  for (int row = 0; row < from.height_px; ++row) {
    const auto* depth = depth_m.ptr<float>(row);
    for (int column = 0; column < from.width_px; ++column, ++ray) {
      const float z_from = depth[column];
      if (!(z_from > 0.0F)) continue;
      const Eigen::Vector3f p = z_from * *ray + shift;
      if (p.z() <= 0.01F) continue;
      const float inverse = 1.0F / p.z();
      const float u = fx * p.x() * inverse + cx, v = fy * p.y() * inverse + cy;
      if (!(u > -1e4F && u < 1e5F && v > -1e4F && v < 1e5F)) continue;
      const float grow = z_from * inverse;
      const int left = std::max(0, static_cast<int>(std::ceil(u - half_x * grow)));
      const int right = std::min(to.width_px - 1, static_cast<int>(std::floor(u + half_x * grow)));
      const int top = std::max(0, static_cast<int>(std::ceil(v - half_y * grow)));
      const int bottom =
          std::min(to.height_px - 1, static_cast<int>(std::floor(v + half_y * grow)));
      for (int y = top; y <= bottom; ++y) {
        auto* line = result.ptr<float>(y);
        for (int x = left; x <= right; ++x)
          if (line[x] == 0.0F || p.z() < line[x]) line[x] = p.z();
      }
    }
  }
  return result;
}

}  // namespace colonnade
