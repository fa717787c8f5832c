// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "pillar_seeds.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "colonnade/base/vector_kernel.hpp"
#include "line_refinement.hpp"

namespace colonnade {
namespace {

constexpr int kHalf = 5;  ///< rows averaged to either side
constexpr int kRows = 2 * kHalf + 1;
constexpr std::size_t kMostSeeds = 80;
constexpr std::uint8_t kRising = 1, kFalling = 5;  ///< edge codes of sectors 0 and 4

/// Goes one row down with the sums of the rows around: one comes in, one goes out.
COLONNADE_VECTOR_KERNEL
void moveDown(const std::uint8_t* in, const std::uint8_t* out, int columns, std::uint16_t* sums,
              std::uint8_t* mean) {
  constexpr std::uint32_t kReciprocal = 0xffff / kRows + 1;  // exact for sums of so few
  const std::uint8_t* __restrict below = in;
  const std::uint8_t* __restrict above = out;
  std::uint16_t* __restrict sum = sums;
  std::uint8_t* __restrict to = mean;
  for (int u = 0; u < columns; ++u) {
    const auto s = static_cast<std::uint16_t>(sum[u] + below[u] - above[u]);
    sum[u] = s;
    to[u] = static_cast<std::uint8_t>(s * kReciprocal >> 16);
  }
}

/// Every pixel the mean of those above and below it. CV_8UC1 in and out.
cv::Mat averagedDown(const cv::Mat& gray) {
  cv::Mat mean(gray.size(), CV_8UC1);
  for (const auto& border : {cv::Range(0, kHalf), cv::Range(gray.rows - kHalf, gray.rows)})
    gray.rowRange(border).copyTo(mean.rowRange(border));
  std::vector<std::uint16_t> sum(static_cast<std::size_t>(gray.cols), kRows / 2);
  const std::vector<std::uint8_t> nothing(sum.size(), 0);
  std::vector<std::uint8_t> unused(sum.size());
  for (int row = 0; row < gray.rows; ++row)
    moveDown(gray.ptr<std::uint8_t>(row),
             row >= kRows ? gray.ptr<std::uint8_t>(row - kRows) : nothing.data(), gray.cols,
             sum.data(), row < kRows - 1 ? unused.data() : mean.ptr<std::uint8_t>(row - kHalf));
  return mean;
}

/// Edge codes where the difference across is `least` or more and the greatest beside. `across` has
/// room for a row.
COLONNADE_VECTOR_KERNEL
void findRidges(const std::uint8_t* row, int columns, int least, std::int16_t* across,
                std::uint8_t* codes) {
  constexpr int kBorder = 3;
  const std::uint8_t* __restrict p = row;
  std::int16_t* __restrict a = across;
  std::uint8_t* __restrict code = codes;
  for (int u = kBorder - 1; u < columns - kBorder + 1; ++u)
    a[u] = static_cast<std::int16_t>(p[u + 1] + p[u + 2] - p[u - 1] - p[u - 2]);
  const auto enough = static_cast<std::int16_t>(least);
  const auto magnitude = [](std::int16_t x) { return static_cast<std::int16_t>(x < 0 ? -x : x); };
  for (int u = 0; u < kBorder; ++u) code[u] = code[columns - 1 - u] = 0;
  for (int u = kBorder; u < columns - kBorder; ++u) {
    const std::int16_t here = magnitude(a[u]);
    const bool ridge =
        (here >= enough) & (here > magnitude(a[u - 1])) & (here >= magnitude(a[u + 1]));
    const std::uint8_t way = a[u] > 0 ? kRising : kFalling;
    code[u] = ridge ? way : std::uint8_t{0};
  }
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
    // No number where the camera looks straight down or lies on its side.
    if (!(bin >= 1.0 && bin <= 3.0 * columns_ - 2.0)) return;
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
  cv::Mat edges(gray.size(), CV_8UC1);
  for (const auto& border : {cv::Range(0, kHalf), cv::Range(gray.rows - kHalf, gray.rows)})
    edges.rowRange(border).setTo(0);
  Votes votes(gray, camera);
  const int least = std::max(1, static_cast<int>(std::lround(2.0 * options.faint_contrast)));
  std::vector<std::int16_t> across(static_cast<std::size_t>(gray.cols));
  EdgeBits bits{{gray.rows, gray.cols}, {gray.rows, gray.cols}};
  for (int row = kHalf; row < gray.rows - kHalf; ++row) {
    auto* const code = edges.ptr<std::uint8_t>(row);
    findRidges(mean.ptr<std::uint8_t>(row), gray.cols, least, across.data(), code);
    votes.startRow(row);
    setSteepBits(code, gray.cols, row, bits);
    bits.rising.each(row, [&](int u) { votes.add(u, true); });
    bits.falling.each(row, [&](int u) { votes.add(u, false); });
  }
  const double shortest = std::max(lines.min_length_px, options.min_length_px);
  LineRefiner refiner(mean, edges, std::move(bits), true, lines);
  RefinedLines found;
  for (const auto& peak : votes.peaks(static_cast<int>(0.7 * shortest)))
    refiner.refine({0.5 * gray.rows, peak.u_middle, votes.slopeAt(peak.u_middle)}, found);
  return found;
}

}  // namespace colonnade
