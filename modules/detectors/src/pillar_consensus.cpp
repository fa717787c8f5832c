// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "pillar_consensus.hpp"

#include <algorithm>
#include <cmath>

#include "statistics.hpp"

namespace colonnade {
namespace {

constexpr std::size_t kFewest = 5;  ///< uprights that tell what a frame's have in common

double middleOf(const RefinedLine& line) { return line.across(0.5 * (line.begin + line.end)); }

}  // namespace

double leanOf(const LevelledCamera& camera, const RefinedLine& line) {
  const Eigen::Vector2d along = (line.at(line.end) - line.at(line.begin)).normalized();
  const Eigen::Vector2d down = camera.downDirection(line.at(0.5 * (line.begin + line.end)));
  return std::asin(std::clamp(along.x() * down.y() - along.y() * down.x(), -1.0, 1.0));
}

CommonLean::CommonLean(const LevelledCamera& camera, const RefinedLines& uprights) {
  constexpr double kApart_px = 60.0;
  if (uprights.size() < kFewest) return;
  std::vector<std::pair<double, double>> leans;  // by column
  for (const auto& line : uprights) leans.emplace_back(middleOf(line), leanOf(camera, line));
  std::vector<double> slopes, offsets;
  for (std::size_t i = 0; i < leans.size(); ++i)
    for (std::size_t j = i + 1; j < leans.size(); ++j)
      if (std::abs(leans[i].first - leans[j].first) > kApart_px)
        slopes.push_back((leans[i].second - leans[j].second) / (leans[i].first - leans[j].first));
  per_px_ = medianOf(slopes);
  for (const auto& [column, angle] : leans) offsets.push_back(angle - per_px_ * column);
  at_0_ = medianOf(offsets);
  known_ = true;
}

double CommonLean::of(const RefinedLine& line) const { return at_0_ + per_px_ * middleOf(line); }

CommonWidth::CommonWidth(const std::vector<AcrossProfile>& uprights) {
  constexpr double kUnknown_px = 5.0;  // a sharp edge has 2 or 3
  constexpr double kShare = 0.4;       // of the width by which all may differ
  constexpr double kSpreads = 3.0;
  constexpr int kThin_px = 4;  // lines so thin rise and fall within the blur
  limit_px_ = kUnknown_px;
  std::vector<double> widths;
  for (const auto& profile : uprights)
    if (!profile.isThinLine(kThin_px)) widths.push_back(profile.width());
  if (widths.size() < kFewest) return;
  const double common = medianOf(widths);
  limit_px_ = common + std::max(kShare * common, kSpreads * robustSpread(widths));
}

}  // namespace colonnade
