// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "across_profile.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {

AcrossProfile::AcrossProfile(const cv::Mat& gray, const RefinedLine& line) {
  constexpr double kMostRows = 96.0;
  const double step = std::max(1.0, (line.end - line.begin) / kMostRows);
  int rows = 0;
  for (double v = line.begin; v <= line.end; v += step) {
    const auto u = static_cast<int>(std::lround(line.across(v))), row = static_cast<int>(v);
    if (row < 0 || row >= gray.rows) continue;
    if (u < 0 || u >= gray.cols) continue;
    const auto* p = gray.ptr<unsigned char>(row);
    for (int k = -kReach_px; k <= kReach_px; ++k)
      sums_[static_cast<std::size_t>(k + kReach_px)] += p[std::clamp(u + k, 0, gray.cols - 1)];
    ++rows;
  }
  for (auto& sum : sums_) sum *= line.gradient_sign / std::max(1.0, static_cast<double>(rows));
}

double AcrossProfile::width() const {
  constexpr int kNear_px = 3;                                  // the peak lies so near the line
  const auto rise = [&](int k) { return at(k + 1) - at(k); };  // between k and k + 1
  int peak = -kNear_px;
  for (int k = -kNear_px; k < kNear_px; ++k)
    if (rise(k) > rise(peak)) peak = k;
  const double half = 0.5 * rise(peak);
  double width = 0.0;
  for (const int way : {-1, 1}) {
    int k = peak;
    while (std::abs(k + way) < kReach_px - 1 && rise(k + way) > half) k += way;
    const double fall = rise(k) - rise(k + way);
    width += std::abs(k - peak) + (fall > 0.0 ? std::min(1.0, (rise(k) - half) / fall) : 1.0);
  }
  return width;
}

bool AcrossProfile::isThinLine(int width_px) const {
  constexpr int kEdge_px = 3;         // within which it has risen
  constexpr double kReturned = 0.35;  // of its step is what may be left of it
  double low = at(0), high = at(0);
  for (int k = 1; k <= kEdge_px; ++k) {
    low = std::min(low, at(-k));
    high = std::max(high, at(k));
  }
  const double rest = kReturned * (high - low);
  const int last = std::min(width_px, kReach_px - 1);
  for (int k = 2; k <= last; ++k) {
    if (0.5 * (at(k) + at(k + 1)) < low + rest) return true;
    if (0.5 * (at(-k) + at(-k - 1)) > high - rest) return true;
  }
  return false;
}

}  // namespace colonnade
