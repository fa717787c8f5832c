// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "colonnade/slam/place_finder.hpp"
#include "mark_cells.hpp"

namespace colonnade {

/// Whether two marks may be of one landmark: kind, and identity where both have one, or else the
/// dark side.
bool mayBeOne(const PlaceMark& a, const PlaceMark& b);

/// How well a small map fits a large one where it is laid. Both must outlive this.
class PlaceAligner {
 public:
  PlaceAligner(std::span<const PlaceMark> map, std::span<const PlaceMark> here,
               const PlaceOptions& options);

  struct Alignment {
    Pose2 T_map_here;
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    int fits = 0;
    int of = 0;
    int named = 0;  ///< of the places that fit, with the same identity
    double rms_m = 0.0;
    double evidence = 0.0;
  };

  /// Places that have a like of theirs within twice the tolerance.
  int count(const Pose2& T_map_here) const;
  /// By least squares, the reach becoming narrower.
  Alignment fitted(Pose2 T_map_here) const;

 private:
  struct Pairing {
    std::size_t here, map;
    double distance_m;
  };

  /// Each with one of the other map at most, the nearest first.
  std::vector<Pairing> paired(const Pose2& T_map_here, double reach_m) const;
  /// How unlikely chance does as well, as a natural logarithm: so many places have a like of theirs
  /// within the tolerance, and these, but for the three numbers that were fitted, lie so near.
  double evidenceOf(const Alignment& alignment) const;

  std::span<const PlaceMark> map_, here_;
  const PlaceOptions& options_;
  MarkCells near_, around_;
  std::vector<std::size_t> place_of_;  ///< of the small map: its first mark there
};

}  // namespace colonnade
