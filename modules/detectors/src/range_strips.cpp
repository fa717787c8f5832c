// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "range_strips.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "colonnade/base/vector_kernel.hpp"
#include "colonnade/detectors/depth_noise.hpp"
#include "nearest_pixel.hpp"
#include "ray_row.hpp"

namespace colonnade {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

/// Where depth fails, infinite. aside: columns from `centre`.
COLONNADE_VECTOR_KERNEL
void invertRanges(const float* depth_m, double centre, const double* aside, const RayRow& rays,
                  std::size_t count, double* inverse) {
  const RayRow r = rays;
  const float* __restrict depths = depth_m;
  const double* __restrict columns = aside;
  double* __restrict out = inverse;
  for (std::size_t i = 0; i < count; ++i) {
    const auto depth = static_cast<double>(depths[i]);
    const double u = centre + columns[i];
    const double x = depth * (r.ahead.first + u * r.ahead.step);
    const double y = depth * (r.right.first + u * r.right.step);
    const double q = 1.0 / std::sqrt(x * x + y * y);
    out[i] = (depth > DepthView::kNearest_m) & (depth < DepthView::kFarthest_m) ? q : kNone;
  }
}

/// Four columns of numbers at once: Batcher's network, "Sorting networks and their applications",
/// AFIPS 1968 (odd-even merging).
COLONNADE_VECTOR_KERNEL
void sortColumns(double* numbers) {
  using Lanes = double __attribute__((vector_size(32)));
  constexpr int kRows = RangeStrips::kRows;
  for (int half = 1; half < kRows; half *= 2)
    for (int apart = half; apart >= 1; apart /= 2)
      for (int first = apart % half; first + apart < kRows; first += 2 * apart)
        for (int i = first; i < std::min(first + apart, kRows - apart); ++i) {
          if ((i ^ (i + apart)) >= 2 * half) continue;  // not of one pair of halves
          Lanes a, b;
          std::memcpy(&a, numbers + 4 * i, sizeof a);
          std::memcpy(&b, numbers + 4 * (i + apart), sizeof b);
          const Lanes low = a < b ? a : b, high = a < b ? b : a;
          std::memcpy(numbers + 4 * i, &low, sizeof low);
          std::memcpy(numbers + 4 * (i + apart), &high, sizeof high);
        }
}

}  // namespace

RangeStrips::RangeStrips(const DepthView& depth, const RefinedLine& line) {
  static constexpr std::array<int, kLanes> kAside = [] {
    std::array<int, kLanes> aside{};
    for (int side = 0; side < 2; ++side)
      for (std::size_t place = 0; place < kPlaces; ++place)
        aside[laneOf(side, place)] = side == 0 ? -kDistances_px[place] : kDistances_px[place];
    return aside;
  }();
  static constexpr Row kAsideInPixels = [] {
    Row aside{};
    for (std::size_t lane = 0; lane < kLanes; ++lane) aside[lane] = kAside[lane];
    return aside;
  }();
  std::array<float, kLanes> depths{};
  for (int row = 0; row < kRows; ++row) {
    const double v = line.begin + (line.end - line.begin) * (row + 0.5) / kRows;
    const auto centre = nearestPixel(Eigen::Vector2d(line.across(v), v));
    if (!centre || centre->v < 0 || centre->v >= depth.rows()) continue;
    const float* const depth_row = depth.row(centre->v);
    const bool inside =
        centre->u >= kDistances_px.back() && centre->u + kDistances_px.back() < depth.columns();
    for (int side = 0; side < 2; ++side)
      for (std::size_t place = 0; place < kPlaces; ++place) {
        const std::size_t lane = laneOf(side, place);
        const int u = centre->u + kAside[lane];
        depths[lane] = inside || (u >= 0 && u < depth.columns()) ? depth_row[u] : 0.0F;
      }
    const RayRow rays(depth.camera(), centre->v);
    Row& inverse = inverse_[static_cast<std::size_t>(usableRows())];
    invertRanges(depths.data(), centre->u, kAsideInPixels.data(), rays, kLanes, inverse.data());
    std::size_t nearest = kLanes;
    double most = 0.0;
    for (int side = 0; side < 2; ++side)
      for (std::size_t place = 0; kDistances_px[place] <= kNearStart_px; ++place) {
        const std::size_t lane = laneOf(side, place);
        const bool nearer = (inverse[lane] > most) & (inverse[lane] < kNone);
        most = nearer ? inverse[lane] : most;
        nearest = nearer ? lane : nearest;
      }
    if (nearest == kLanes) continue;
    ++seen_rows_;
    const auto depth_m = static_cast<double>(depths[nearest]);
    const double height_m =
        depth.camera().height() + depth_m * rays.up.at(centre->u + kAsideInPixels[nearest]);
    if (height_m < 0.05 + kinectDepthSigma(depth_m)) ++floor_rows_;
  }
}

RangeStrips::Middle RangeStrips::middle(int side, std::size_t place) {
  const std::size_t lane = laneOf(side, place);
  const std::size_t group = lane / kGroup;
  auto& sorted = sorted_[group];
  if (!is_sorted_[group]) {
    is_sorted_[group] = true;
    for (std::size_t row = 0; row < kRows; ++row)
      for (std::size_t i = 0; i < kGroup; ++i)
        sorted[row][i] =
            static_cast<int>(row) < usableRows() ? inverse_[row][group * kGroup + i] : kNone;
    sortColumns(sorted[0].data());
  }
  Middle middle;
  while (middle.rows < usableRows() &&
         sorted[static_cast<std::size_t>(middle.rows)][lane % kGroup] < kNone)
    ++middle.rows;
  if (middle.rows > 0)
    middle.inverse = sorted[static_cast<std::size_t>(middle.rows) / 2][lane % kGroup];
  return middle;
}

}  // namespace colonnade
