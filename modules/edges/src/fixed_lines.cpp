// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/edges/fixed_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "line_selection.hpp"

namespace colonnade {
namespace {

constexpr int kCoarseStep_deg = 2;

/// Sobel sums 4 differences where the directional operators sum 3, the binomial Gaussian (sigma 1
/// px) leaves less of a step than OpenCV's default of 0.8 px, and hysteresis reaches less far
/// upwards, so that a chain needs a lower threshold to start and a higher one to end: with these
/// shares detectors score as with the reference (modules/edges/README.md).
constexpr double kLowShare = 0.55;
constexpr double kHighShare = 0.37;

int threshold(double sobel_l1, double share) {
  return static_cast<int>(std::clamp(std::lround(share * sobel_l1), 0L, 1023L));
}

/// Only pixels whose gradient fits the angle vote, so that lines count fewer chance votes than in
/// the reference.
int votes(int percent, int height_px) { return std::max(1, height_px * percent * 2 / 300); }

}  // namespace

FixedShape runShape() {
  FixedShape shape;
  shape.angles_deg.assign(kRunSet.begin(), kRunSet.end());
  return shape;
}

FixedParameters runParameters(const FixedShape& shape, const EdgeOptions& options,
                              const EdgeView& view, int width_px, int height_px) {
  FixedParameters parameters;
  const auto [low, high] = std::minmax(options.canny_low, options.canny_high);
  parameters.high = threshold(high, kHighShare);
  parameters.low = std::min(threshold(low, kLowShare), parameters.high);
  parameters.vertical_votes = votes(options.vertical_votes_percent, height_px);
  parameters.inclined_votes = votes(options.inclined_votes_percent, height_px);
  const LineRanges ranges = predictLineRanges(view, width_px, height_px, options);
  parameters.vertical_from_deg = ranges.vertical_from_deg;
  parameters.vertical_to_deg = ranges.vertical_to_deg;
  parameters.first_row = ranges.first_floor_row;
  for (const int angle : shape.angles_deg) {
    const bool vertical = angle >= ranges.vertical_from_deg && angle <= ranges.vertical_to_deg;
    parameters.enabled.push_back(vertical || angle % kCoarseStep_deg == 0);
  }
  return parameters;
}

std::vector<HoughLine> toHoughLines(const std::vector<FixedLine>& lines, int width_px,
                                    int height_px, const EdgeOptions& options) {
  std::vector<HoughLine> result;
  result.reserve(lines.size());
  for (const auto& line : lines) {
    const auto& angle = kAngleTable[static_cast<std::size_t>(line.theta_deg - kFirstAngle_deg)];
    const int to_centre = (width_px / 2) * angle.cosine + (height_px / 2) * angle.sine;
    const int rho = line.rho + ((to_centre + (1 << (kAngleFraction - 1))) >> kAngleFraction);
    const bool turned = line.theta_deg < 0;
    result.push_back({line.theta_deg + (turned ? 180 : 0), turned ? -rho : rho, line.votes,
                      line.line_class == 0 ? LineClass::kVertical : LineClass::kInclined});
  }
  return selectLines(std::move(result), options.max_lines);
}

}  // namespace colonnade
