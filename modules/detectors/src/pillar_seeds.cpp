// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "pillar_seeds.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "line_refinement.hpp"

namespace colonnade {
namespace {

constexpr int kHalf = 5;  ///< rows averaged to either side
constexpr int kRows = 2 * kHalf + 1;
constexpr std::size_t kMostSeeds = 80;
constexpr std::uint8_t kRising = 1, kFalling = 5;  ///< edge codes of sectors 0 and 4

/// Every pixel the mean of those above and below it. CV_8UC1 in and out.
cv::Mat averagedDown(const cv::Mat& gray) {
  cv::Mat mean = gray.clone();
  std::vector<int> sum(static_cast<std::size_t>(gray.cols), kRows / 2);
  for (int row = 0; row < gray.rows; ++row) {
    const auto* in = gray.ptr<std::uint8_t>(row);
    const auto* out = row >= kRows ? gray.ptr<std::uint8_t>(row - kRows) : nullptr;
    for (int u = 0; u < gray.cols; ++u)
      sum[static_cast<std::size_t>(u)] += in[u] - (out ? out[u] : 0);
    if (row < kRows - 1) continue;
    auto* to = mean.ptr<std::uint8_t>(row - kHalf);
    for (int u = 0; u < gray.cols; ++u)
      to[u] = static_cast<std::uint8_t>(sum[static_cast<std::size_t>(u)] / kRows);
  }
  return mean;
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
  const int least = static_cast<int>(std::lround(2.0 * options.faint_contrast));
  std::vector<int> across(static_cast<std::size_t>(gray.cols), 0);
  for (int row = kHalf; row < gray.rows - kHalf; ++row) {
    const auto* p = mean.ptr<std::uint8_t>(row);
    for (int u = 2; u < gray.cols - 2; ++u)
      across[static_cast<std::size_t>(u)] = p[u + 1] + p[u + 2] - p[u - 1] - p[u - 2];
    auto* code = edges.ptr<std::uint8_t>(row);
    votes.startRow(row);
    for (int u = 3; u < gray.cols - 3; ++u) {
      const int here = std::abs(across[static_cast<std::size_t>(u)]);
      if (here < least) continue;
      const int before = std::abs(across[static_cast<std::size_t>(u) - 1]);
      const int after = std::abs(across[static_cast<std::size_t>(u) + 1]);
      if (here <= before || here < after) continue;
      const bool rising = across[static_cast<std::size_t>(u)] > 0;
      code[u] = rising ? kRising : kFalling;
      votes.add(u, rising);
    }
  }
  const double shortest = std::max(lines.min_length_px, options.min_length_px);
  LineRefiner refiner(mean, edges, true, lines);
  RefinedLines found;
  for (const auto& peak : votes.peaks(static_cast<int>(0.7 * shortest)))
    refiner.refine({0.5 * gray.rows, peak.u_middle, votes.slopeAt(peak.u_middle)}, found);
  return found;
}

}  // namespace colonnade
