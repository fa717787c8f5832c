// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "pillar_seeds.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/core/hal/intrin.hpp>

#include "line_refinement.hpp"

namespace colonnade {
namespace {

constexpr int kHalf = 5;  ///< rows averaged to either side
constexpr int kRows = 2 * kHalf + 1;
constexpr std::size_t kMostSeeds = 80;
constexpr std::uint8_t kRising = 1, kFalling = 5;  ///< edge codes of sectors 0 and 4

using Lanes16 = cv::v_uint16x8;
constexpr int kLanes = Lanes16::nlanes;

/// Every pixel the mean of those above and below it. CV_8UC1 in and out.
cv::Mat averagedDown(const cv::Mat& gray) {
  cv::Mat mean(gray.size(), CV_8UC1);
  for (const auto& border : {cv::Range(0, kHalf), cv::Range(gray.rows - kHalf, gray.rows)})
    gray.rowRange(border).copyTo(mean.rowRange(border));
  std::vector<std::uint16_t> sum(static_cast<std::size_t>(gray.cols), kRows / 2);
  const Lanes16 reciprocal = cv::v_setall_u16(0xffff / kRows + 1);  // exact for sums of so few
  for (int row = 0; row < gray.rows; ++row) {
    const auto* in = gray.ptr<std::uint8_t>(row);
    const auto* out = row >= kRows ? gray.ptr<std::uint8_t>(row - kRows) : nullptr;
    auto* to = row < kRows - 1 ? nullptr : mean.ptr<std::uint8_t>(row - kHalf);
    int u = 0;
    for (; u + kLanes <= gray.cols; u += kLanes) {
      Lanes16 sums = cv::v_load(&sum[static_cast<std::size_t>(u)]) + cv::v_load_expand(in + u);
      if (out) sums = sums - cv::v_load_expand(out + u);
      cv::v_store(&sum[static_cast<std::size_t>(u)], sums);
      if (to) cv::v_pack_store(to + u, cv::v_mul_hi(sums, reciprocal));
    }
    for (; u < gray.cols; ++u) {
      auto& s = sum[static_cast<std::size_t>(u)];
      s = static_cast<std::uint16_t>(s + in[u] - (out ? out[u] : 0));
      if (to) to[u] = static_cast<std::uint8_t>(s / kRows);
    }
  }
  return mean;
}

/// across[u] = gray levels to the right of u less those to its left, for 2 <= u < columns - 2.
void differences(const std::uint8_t* p, int columns, std::vector<std::int16_t>& across) {
  int u = 2;
  const auto at = [p](int i) { return cv::v_reinterpret_as_s16(cv::v_load_expand(p + i)); };
  for (; u + kLanes + 2 <= columns; u += kLanes)
    cv::v_store(&across[static_cast<std::size_t>(u)],
                at(u + 1) + at(u + 2) - at(u - 1) - at(u - 2));
  for (; u < columns - 2; ++u)
    across[static_cast<std::size_t>(u)] =
        static_cast<std::int16_t>(p[u + 1] + p[u + 2] - p[u - 1] - p[u - 2]);
}

/// Calls take(u) where the magnitude is `least` or more and the greatest beside.
template <class Take>
void eachRidge(const std::vector<std::int16_t>& across, int least, Take&& take) {
  const int columns = static_cast<int>(across.size());
  const auto magnitude = [&](int u) { return std::abs(across[static_cast<std::size_t>(u)]); };
  const auto consider = [&](int u) {
    if (magnitude(u) >= least && magnitude(u) > magnitude(u - 1) &&
        magnitude(u) >= magnitude(u + 1))
      take(u);
  };
  const auto below = cv::v_setall_u16(static_cast<std::uint16_t>(least - 1));
  int u = 3;
  for (; u + kLanes <= columns - 3; u += kLanes) {
    const auto here = cv::v_abs(cv::v_load(&across[static_cast<std::size_t>(u)]));
    if (!cv::v_check_any(here > below)) continue;
    for (int i = u; i < u + kLanes; ++i) consider(i);
  }
  for (; u < columns - 3; ++u) consider(u);
}

/// Where upright lines cross the middle row, in bins of a pixel.
class Votes {
 public:
  Votes(const cv::Mat& gray, const LevelledCamera& camera) : columns_(gray.cols), rows_(gray.rows) {
    const double middle = 0.5 * rows_;
    // Slopes at the border columns of the middle row; between them a projected vertical's slope is
    // linear in the column, for all meet in one point.
    const Eigen::Vector2d left = camera.downDirection({0.0, middle});
    const Eigen::Vector2d right = camera.downDirection({columns_ - 1.0, middle});
    slope_ = left.x() / left.y();
    slope_per_px_ = (right.x() / right.y() - slope_) / (columns_ - 1.0);
    for (auto& counts : counts_) counts.assign(static_cast<std::size_t>(3 * columns_), 0);
  }

  double slopeAt(double u_middle) const { return slope_ + slope_per_px_ * u_middle; }

  void startRow(int v) {
    // u = m + (slope_ + slope_per_px_ m) dv, solved for m.
    const double dv = v - 0.5 * rows_;
    factor_ = 1.0 / (1.0 + slope_per_px_ * dv);
    shift_ = -slope_ * dv * factor_ + columns_;  // bins begin a picture's width to the left
  }
  void add(int u, bool rising) {
    const double bin = u * factor_ + shift_;
    if (bin < 1.0 || bin > 3.0 * columns_ - 2.0) return;
    ++counts_[rising ? 0 : 1][static_cast<std::size_t>(bin + 0.5)];
  }

  struct Peak {
    int votes = 0;
    double u_middle = 0.0;
  };
  /// Bins that hold most with their neighbours, most votes first.
  std::vector<Peak> peaks(int least) const {
    std::vector<Peak> found;
    for (const auto& counts : counts_) {
      const auto around = [&](std::size_t i) { return counts[i - 1] + counts[i] + counts[i + 1]; };
      for (std::size_t i = 3; i + 3 < counts.size(); ++i) {
        const int votes = around(i);
        if (votes < least || votes <= around(i - 1) || votes < around(i + 1)) continue;
        found.push_back({votes, static_cast<double>(i) - columns_});
      }
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const Peak& a, const Peak& b) { return a.votes > b.votes; });
    if (found.size() > kMostSeeds) found.resize(kMostSeeds);
    return found;
  }

 private:
  int columns_, rows_;
  double slope_ = 0.0, slope_per_px_ = 0.0;
  double factor_ = 1.0, shift_ = 0.0;
  std::vector<int> counts_[2];
};

}  // namespace

RefinedLines faintUprights(const cv::Mat& gray, const LevelledCamera& camera,
                           const PillarOptions& options, const LineRefinementOptions& lines) {
  if (options.faint_contrast <= 0.0 || gray.cols < 32 || gray.rows < 2 * kRows) return {};
  const cv::Mat mean = averagedDown(gray);
  cv::Mat edges = cv::Mat::zeros(gray.size(), CV_8UC1);
  Votes votes(gray, camera);
  const int least = std::max(1, static_cast<int>(std::lround(2.0 * options.faint_contrast)));
  std::vector<std::int16_t> across(static_cast<std::size_t>(gray.cols), 0);
  for (int row = kHalf; row < gray.rows - kHalf; ++row) {
    differences(mean.ptr<std::uint8_t>(row), gray.cols, across);
    auto* code = edges.ptr<std::uint8_t>(row);
    votes.startRow(row);
    eachRidge(across, least, [&](int u) {
      const bool rising = across[static_cast<std::size_t>(u)] > 0;
      code[u] = rising ? kRising : kFalling;
      votes.add(u, rising);
    });
  }
  const double shortest = std::max(lines.min_length_px, options.min_length_px);
  LineRefiner refiner(mean, edges, true, lines);
  RefinedLines found;
  for (const auto& peak : votes.peaks(static_cast<int>(0.7 * shortest)))
    refiner.refine({0.5 * gray.rows, peak.u_middle, votes.slopeAt(peak.u_middle)}, found);
  return found;
}

}  // namespace colonnade
