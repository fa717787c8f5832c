// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "colonnade/detectors/refined_line.hpp"
#include "depth_view.hpp"

namespace colonnade {

/// What depth sees beside a steep line: inverse horizontal ranges on both sides of it, at some
/// distances from it and in some rows along it, without those in which it lies on the floor.
class RangeStrips {
 public:
  static constexpr int kRows = 32;
  /// px from the line: every pixel of the nearest surface, every third one of the shadow beyond.
  static constexpr std::array<int, 14> kDistances_px{3,  4,  5,  6,  7,  8,  9,
                                                     10, 11, 14, 17, 20, 23, 26};
  static constexpr int kNearStart_px = 7;  ///< depth and colour edges may be displaced by so much
  static constexpr std::size_t kPlaces = kDistances_px.size();

  RangeStrips(const DepthView& depth, const RefinedLine& line);

  int seenRows() const { return seen_rows_; }
  int floorRows() const { return floor_rows_; }
  int usableRows() const { return seen_rows_ - floor_rows_; }

  /// side: 0 left, 1 right; place: an index of kDistances_px.
  struct Middle {
    int rows = 0;          ///< that have depth there
    double inverse = 0.0;  ///< their median, 1/m
  };
  Middle middle(int side, std::size_t place);
  /// Of the i-th usable row; infinite where depth is missing.
  double inverse(int i, int side, std::size_t place) const {
    return inverse_[static_cast<std::size_t>(i)][laneOf(side, place)];
  }

 private:
  static constexpr std::size_t kGroup = 4;  ///< places sorted together
  static constexpr std::size_t kSide = (kPlaces + kGroup - 1) / kGroup * kGroup;
  static constexpr std::size_t kLanes = 2 * kSide;
  static constexpr std::size_t laneOf(int side, std::size_t place) {
    return (side == 0 ? 0 : kSide) + place;
  }
  using Row = std::array<double, kLanes>;

  int seen_rows_ = 0;
  int floor_rows_ = 0;
  std::array<Row, kRows> inverse_;
  std::array<std::array<double, kGroup>, kRows> sorted_[kLanes / kGroup];
  bool is_sorted_[kLanes / kGroup] = {};
};

}  // namespace colonnade
