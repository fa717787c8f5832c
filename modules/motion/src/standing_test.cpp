// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "standing_test.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

constexpr int kCell_px = 16;
constexpr int kMinPoints = 2;
/// A nearer depth explains the picture better when its cost is below this share of the floor's.
constexpr double kClearlyBetter = 0.7;
/// A mean squared residual of so many times the noise is no fit.
constexpr double kNoFit = 6.0;
constexpr double kDecisive = 3.0;    ///< difference of squared sigmas
constexpr float kLeastNoise = 1.0f;  ///< brightness levels
constexpr float kMost = 8.0f;        ///< sigmas

}  // namespace

StandingTest::StandingTest(const PinholeCamera& camera)
    : camera_(camera),
      columns_(camera.width_px / kCell_px + 1),
      rows_(camera.height_px / kCell_px + 1),
      cells_(static_cast<std::size_t>(columns_ * rows_)) {}

std::size_t StandingTest::cellOf(const Eigen::Vector3f& p_camera) const {
  const Eigen::Vector3d p = p_camera.cast<double>() / static_cast<double>(p_camera.z());
  const int u = static_cast<int>(camera_.fx_px * p.x() + camera_.cx_px) / kCell_px;
  const int v = static_cast<int>(camera_.fy_px * p.y() + camera_.cy_px) / kCell_px;
  return static_cast<std::size_t>(std::clamp(v, 0, rows_ - 1) * columns_ +
                                  std::clamp(u, 0, columns_ - 1));
}

void StandingTest::look(const std::vector<PhotometricPoint>& points, const PyramidLevel& other,
                        const AlignmentState& state) {
  std::vector<std::vector<float>> residuals;
  std::vector<PhotometricPoint> placed = points;
  for (const float share : kShares) {
    for (std::size_t i = 0; i < points.size(); ++i)
      placed[i].p_reference = share * points[i].p_reference;
    residuals.push_back(brightnessResiduals(placed, other, state));
  }
  std::vector<float> on_floor;
  for (const float r : residuals[0])
    if (r >= 0.0f) on_floor.push_back(r);
  if (on_floor.empty()) return;
  // The lower quartile: what stands there is not among it. Of |noise| it is 0.3186 sigma.
  const auto quartile = on_floor.begin() + static_cast<std::ptrdiff_t>(on_floor.size() / 4);
  std::nth_element(on_floor.begin(), quartile, on_floor.end());
  const float noise = std::max(*quartile / 0.3186f, kLeastNoise);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (residuals[0][i] < 0.0f) continue;
    Cell& cell = cells_[cellOf(points[i].p_reference)];
    ++cell.count;
    for (std::size_t k = 0; k < kShares.size(); ++k) {
      const bool seen = residuals[k][i] >= 0.0f;
      const float r = seen ? std::min(residuals[k][i] / noise, kMost) : kMost;
      cell.cost[k] += static_cast<double>(r * r);
    }
  }
}

StandingTest::Verdict StandingTest::verdict(const Eigen::Vector3f& p_camera) const {
  const Cell& cell = cells_[cellOf(p_camera)];
  if (cell.count < kMinPoints) return Verdict::kUnknown;
  const double floor = cell.cost[0];
  const double nearer = *std::min_element(cell.cost.begin() + 1, cell.cost.end());
  return floor > kNoFit * cell.count || nearer + kDecisive < kClearlyBetter * floor
             ? Verdict::kStanding
             : Verdict::kFloor;
}

}  // namespace colonnade
