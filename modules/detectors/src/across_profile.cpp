// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "across_profile.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "colonnade/base/vector_kernel.hpp"
#include "nearest_pixel.hpp"

namespace colonnade {

namespace {

constexpr std::size_t kMostRows = 96;
constexpr int kWidth = 2 * AcrossProfile::kReach_px + 1;

COLONNADE_VECTOR_KERNEL
void addUp(const std::uint8_t* const* rows, std::size_t count, std::uint16_t* sums) {
  std::uint16_t sum[kWidth] = {};
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* __restrict p = rows[i];
    for (int k = 0; k < kWidth; ++k) sum[k] = static_cast<std::uint16_t>(sum[k] + p[k]);
  }
  std::copy_n(sum, kWidth, sums);
}

}  // namespace

AcrossProfile::AcrossProfile(const cv::Mat& gray, const RefinedLine& line) {
  if (!line.steep) {
    addUpFlat(gray, line);
    return;
  }
  const double step = std::max(1.0, (line.end - line.begin) / kMostRows);
  std::array<const std::uint8_t*, kMostRows + 2> inside{};  // from the left end of the profile on
  std::size_t count = 0;
  int rows = 0;
  for (double v = line.begin; v <= line.end; v += step) {
    const int u = roundToInt(line.across(v)), row = static_cast<int>(v);
    if (row < 0 || row >= gray.rows) continue;
    if (u < 0 || u >= gray.cols) continue;
    const auto* p = gray.ptr<std::uint8_t>(row);
    ++rows;
    if (u >= kReach_px && u + kReach_px < gray.cols) {
      inside[count++] = p + u - kReach_px;
      continue;
    }
    for (int k = -kReach_px; k <= kReach_px; ++k)
      sums_[static_cast<std::size_t>(k + kReach_px)] += p[std::clamp(u + k, 0, gray.cols - 1)];
  }
  std::array<std::uint16_t, kWidth> sums;
  addUp(inside.data(), count, sums.data());
  const double share = line.gradient_sign / std::max(1.0, static_cast<double>(rows));
  for (std::size_t k = 0; k < sums_.size(); ++k) sums_[k] = (sums_[k] + sums[k]) * share;
}

void AcrossProfile::addUpFlat(const cv::Mat& gray, const RefinedLine& line) {
  const double step = std::max(1.0, (line.end - line.begin) / kMostRows);
  int columns = 0;
  for (double u = line.begin; u <= line.end; u += step) {
    const int v = roundToInt(line.across(u)), column = static_cast<int>(u);
    if (column < 0 || column >= gray.cols || v < 0 || v >= gray.rows) continue;
    ++columns;
    for (int k = -kReach_px; k <= kReach_px; ++k)
      sums_[static_cast<std::size_t>(k + kReach_px)] +=
          gray.at<std::uint8_t>(std::clamp(v + k, 0, gray.rows - 1), column);
  }
  const double share = line.gradient_sign / std::max(1.0, static_cast<double>(columns));
  for (double& sum : sums_) sum *= share;
}

int AcrossProfile::peak() const {
  constexpr int kNear_px = 3;  // the peak lies so near the line
  int peak = -kNear_px;
  for (int k = -kNear_px; k < kNear_px; ++k)
    if (rise(k) > rise(peak)) peak = k;
  return peak;
}

double AcrossProfile::steepest() const { return rise(peak()); }

double AcrossProfile::width() const {
  const int peak = this->peak();
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
