// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "line_selection.hpp"

#include <algorithm>
#include <cstdlib>
#include <tuple>

namespace colonnade {
namespace {

constexpr int kHalfTurn = 180;      // degrees
constexpr int kDuplicateTheta = 2;  // degrees
constexpr int kDuplicateRho = 3;    // pixels

bool isBetter(const HoughLine& a, const HoughLine& b) {
  return std::tie(a.line_class, b.votes, a.theta_index, a.rho_bin) <
         std::tie(b.line_class, a.votes, b.theta_index, b.rho_bin);
}

/// Close in both parameters; (theta, rho) and (theta - 180 degrees, -rho) are one line.
bool isDuplicate(const HoughLine& a, const HoughLine& b) {
  const int turn = std::abs(a.theta_index - b.theta_index);
  if (turn <= kDuplicateTheta) return std::abs(a.rho_bin - b.rho_bin) <= kDuplicateRho;
  return kHalfTurn - turn <= kDuplicateTheta && std::abs(a.rho_bin + b.rho_bin) <= kDuplicateRho;
}

}  // namespace

std::vector<HoughLine> selectLines(std::vector<HoughLine> lines, int max_of_each_class) {
  std::sort(lines.begin(), lines.end(), isBetter);
  std::vector<HoughLine> kept;
  int kept_of_class[2] = {0, 0};
  for (const auto& line : lines) {
    int& count = kept_of_class[static_cast<int>(line.line_class)];
    if (count >= max_of_each_class) continue;
    if (std::any_of(kept.begin(), kept.end(),
                    [&](const HoughLine& better) { return isDuplicate(better, line); })) {
      continue;
    }
    kept.push_back(line);
    ++count;
  }
  return kept;
}

}  // namespace colonnade
