// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdlib>
#include <map>
#include <vector>

#include "colonnade/edges/fixed_stage.hpp"

namespace colonnade::testing {

/// The arithmetic of hdl/README.md written down pixel by pixel, for comparison with the fast way.
class FixedDefinition {
 public:
  FixedDefinition(const cv::Mat& gray, const FixedShape& shape, const FixedParameters& p)
      : gray_(gray), width_(gray.cols), height_(gray.rows), shape_(shape), p_(p) {
    blur();
    gradients();
    suppress();
    for (int pass = 0; pass < shape.hysteresis_passes; ++pass) strengthen();
    hough();
  }

  int edge(int u, int v) const { return label(u, v) == 2 ? 1 + sector_[at(u, v)] : 0; }
  const std::vector<FixedLine>& lines() const { return lines_; }

 private:
  std::size_t at(int u, int v) const { return static_cast<std::size_t>(v * width_ + u); }
  bool inside(int u, int v) const { return u >= 0 && v >= 0 && u < width_ && v < height_; }
  int label(int u, int v) const { return inside(u, v) ? label_[at(u, v)] : 0; }
  int magnitude(int u, int v) const { return inside(u, v) ? magnitude_[at(u, v)] : 0; }
  int blurred(int u, int v) const {
    return blurred_[at(std::clamp(u, 0, width_ - 1), std::clamp(v, 0, height_ - 1))];
  }
  template <typename Visit>
  void eachPixel(Visit visit) {
    for (int v = 0; v < height_; ++v)
      for (int u = 0; u < width_; ++u) visit(u, v);
  }

  void blur() {
    constexpr int kWeights[5] = {1, 4, 6, 4, 1};
    eachPixel([&](int u, int v) {
      int sum = 128;
      for (int dv = -2; dv <= 2; ++dv)
        for (int du = -2; du <= 2; ++du)
          sum += kWeights[du + 2] * kWeights[dv + 2] *
                 gray_.at<unsigned char>(std::clamp(v + dv, 0, height_ - 1),
                                         std::clamp(u + du, 0, width_ - 1));
      blurred_.push_back(sum >> 8);
    });
  }
  void gradients() {
    constexpr int kOperators[4][3][3] = {{{-1, 0, 1}, {-1, 0, 1}, {-1, 0, 1}},
                                         {{-1, -1, 0}, {-1, 0, 1}, {0, 1, 1}},
                                         {{-1, -1, -1}, {0, 0, 0}, {1, 1, 1}},
                                         {{0, -1, -1}, {1, 0, -1}, {1, 1, 0}}};
    eachPixel([&](int u, int v) {
      int best = -1;
      int sector = 0;
      for (const int direction : {0, 2, 1, 3}) {
        int sum = 0;
        for (int dv = -1; dv <= 1; ++dv)
          for (int du = -1; du <= 1; ++du)
            sum += kOperators[direction][dv + 1][du + 1] * blurred(u + du, v + dv);
        if (std::abs(sum) <= best) continue;
        best = std::abs(sum);
        sector = direction + (sum < 0 ? 4 : 0);
      }
      magnitude_.push_back(best);
      sector_.push_back(sector);
    });
  }
  void suppress() {
    constexpr int kBehind[4][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}};
    eachPixel([&](int u, int v) {
      const int* step = kBehind[sector_[at(u, v)] & 3];
      const int m = magnitude(u, v);
      const bool maximum = m > p_.low && m > magnitude(u - step[0], v - step[1]) &&
                           m >= magnitude(u + step[0], v + step[1]);
      label_.push_back(!maximum ? 0 : m > p_.high ? 2 : 1);
    });
  }
  void strengthen() {
    eachPixel([&](int u, int v) {
      if (label(u, v) != 1) return;
      for (int dv = -1; dv <= 1; ++dv)
        for (int du = -1; du <= 1; ++du)
          if (label(u + du, v + dv) == 2) label_[at(u, v)] = 2;
    });
  }
  void hough() {
    std::map<int, std::map<int, int>> votes;
    const auto classOf = [&](int angle) {
      return angle >= p_.vertical_from_deg && angle <= p_.vertical_to_deg ? 0 : 1;
    };
    const auto& angles = shape_.angles_deg;
    for (std::size_t a = 0; a < angles.size(); ++a) {
      if (!p_.enabled.empty() && !p_.enabled[a]) continue;
      const auto& entry = kAngleTable[static_cast<std::size_t>(angles[a] + 90)];
      eachPixel([&](int u, int v) {
        if (edge(u, v) == 0 || !(entry.admitted >> (sector_[at(u, v)] & 3) & 1)) return;
        if (classOf(angles[a]) == 1 && v < p_.first_row) return;
        ++votes[angles[a]]
               [((u - width_ / 2) * entry.cosine + (v - height_ / 2) * entry.sine + 2048) >> 12];
      });
    }
    const auto votesAt = [&](int angle, int rho) {
      const auto row = votes.find(angle);
      if (row == votes.end()) return 0;
      const auto bin = row->second.find(rho);
      return bin == row->second.end() ? 0 : bin->second;
    };
    for (std::size_t a = 0; a < angles.size(); ++a) {
      const int line_class = classOf(angles[a]);
      const int least = line_class == 0 ? p_.vertical_votes : p_.inclined_votes;
      for (const auto& [rho, count] : votes[angles[a]]) {
        bool peak = count >= least;
        for (std::size_t b = a > 0 ? a - 1 : a; b <= a + 1 && b < angles.size(); ++b) {
          if (std::abs(angles[b] - angles[a]) > 2) continue;
          for (int other = rho - 2; other <= rho + 2; ++other) {
            const bool former = b < a || (b == a && other < rho);
            const int rival = votesAt(angles[b], other);
            if (former ? rival >= count : rival > count) peak = false;
          }
        }
        if (peak) lines_.push_back({angles[a], rho, count, line_class});
      }
    }
  }

  const cv::Mat& gray_;
  int width_;
  int height_;
  const FixedShape& shape_;
  const FixedParameters& p_;
  std::vector<int> blurred_;
  std::vector<int> magnitude_;
  std::vector<int> sector_;
  std::vector<int> label_;  // 0 none, 1 candidate, 2 strong
  std::vector<FixedLine> lines_;
};

}  // namespace colonnade::testing
