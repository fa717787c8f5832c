// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "upright_segments.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

constexpr int kToLead = 6;  ///< pixels before a segment's own slope leads it

/// A line that grows pixel by pixel, with the sums of its least squares; rows count from its first.
struct Growing {
  int top, bottom, last_u, sign;
  double n = 0.0, s = 0.0, u = 0.0, ss = 0.0, su = 0.0, uu = 0.0;

  void add(int column, int row) {
    const double at = row - top;
    const double across = column;
    n += 1.0;
    s += at;
    u += across;
    ss += at * at;
    su += at * across;
    uu += across * across;
    bottom = row;
    last_u = column;
  }
  double slope() const {
    const double spread = ss - s * s / n;
    return n >= kToLead && spread > 0.0 ? (su - s * u / n) / spread : 0.0;
  }
  double across(int row) const {
    if (n < kToLead) return last_u;
    return u / n + slope() * (row - top - s / n);
  }
  double residual() const {
    const double squares = uu - u * u / n - slope() * (su - s * u / n);
    return std::sqrt(std::max(squares, 0.0) / n);
  }
};

/// Gradients within 45 degrees of the image's horizontal; 0 for all others.
int signOf(unsigned char edge) {
  switch (edge) {
    case 1:  // 1 + sector
    case 2:
    case 8:
      return 1;
    case 4:
    case 5:
    case 6:
      return -1;
    default:
      return 0;
  }
}

}  // namespace

std::vector<UprightSegment> uprightSegments(const cv::Mat& edges,
                                            const ShortSegmentOptions& options) {
  std::vector<UprightSegment> segments;
  std::vector<Growing> growing;
  const auto close = [&](const Growing& g) {
    if (g.bottom - g.top < options.min_length_px || g.n < 0.7 * (g.bottom - g.top + 1)) return;
    if (g.residual() > options.max_residual_px) return;
    segments.push_back({g.top + g.s / g.n, g.u / g.n, g.slope(), g.top, g.bottom, g.sign});
  };
  for (int row = 0; row < edges.rows; ++row) {
    const auto* line = edges.ptr<unsigned char>(row);
    std::erase_if(growing, [&](const Growing& g) {
      if (row - g.bottom <= options.max_gap_px + 1) return false;
      close(g);
      return true;
    });
    const std::size_t known = growing.size();
    for (int column = 0; column < edges.cols; ++column) {
      const int sign = signOf(line[column]);
      if (sign == 0) continue;
      Growing* best = nullptr;
      double least = options.attach_px;
      for (std::size_t i = 0; i < known; ++i) {
        Growing& g = growing[i];
        if (g.sign != sign || g.bottom == row) continue;
        const double apart = std::abs(g.across(row) - column);
        if (apart > least) continue;
        least = apart;
        best = &g;
      }
      if (!best) best = &growing.emplace_back(Growing{row, row, column, sign});
      best->add(column, row);
    }
  }
  for (const Growing& g : growing) close(g);
  std::sort(segments.begin(), segments.end(), [](const auto& a, const auto& b) {
    return std::pair(a.top, a.offset) < std::pair(b.top, b.offset);
  });
  return segments;
}

}  // namespace colonnade
