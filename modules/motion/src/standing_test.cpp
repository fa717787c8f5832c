// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "standing_test.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

constexpr int kMinPoints = 2;
/// A nearer depth explains the picture better when its cost is below this share of the floor's.
constexpr double kClearlyBetter = 0.7;
/// A mean squared residual of so many times the noise is no fit.
constexpr double kNoFit = 6.0;
constexpr double kDecisive = 3.0;  ///< difference of squared sigmas
constexpr float kMost = 8.0f;      ///< sigmas

}  // namespace

StandingTest::StandingTest(const PinholeCamera& camera) : grid_(camera), cells_(grid_.size()) {}

void StandingTest::look(const std::vector<PhotometricPoint>& points, const PyramidLevel& other,
                        const AlignmentState& state) {
  std::vector<std::vector<float>> residuals;
  std::vector<PhotometricPoint> placed = points;
  for (const float share : kShares) {
    for (std::size_t i = 0; i < points.size(); ++i)
      placed[i].p_reference = share * points[i].p_reference;
    residuals.push_back(brightnessResiduals(placed, other, state));
  }
  const float noise = brightnessNoise(residuals[0]);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (residuals[0][i] < 0.0f) continue;
    Cell& cell = cells_[grid_.cellOf(points[i].p_reference)];
    ++cell.count;
    for (std::size_t k = 0; k < kShares.size(); ++k) {
      const bool seen = residuals[k][i] >= 0.0f;
      const float r = seen ? std::min(residuals[k][i] / noise, kMost) : kMost;
      cell.cost[k] += static_cast<double>(r * r);
    }
  }
}

StandingTest::Verdict StandingTest::verdict(const Eigen::Vector3f& p_camera) const {
  const Cell& cell = cells_[grid_.cellOf(p_camera)];
  if (cell.count < kMinPoints) return Verdict::kUnknown;
  const double floor = cell.cost[0];
  const double nearer = *std::min_element(cell.cost.begin() + 1, cell.cost.end());
  return floor > kNoFit * cell.count || nearer + kDecisive < kClearlyBetter * floor
             ? Verdict::kStanding
             : Verdict::kFloor;
}

}  // namespace colonnade
