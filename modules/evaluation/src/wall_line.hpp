// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "colonnade/filter/landmark_map.hpp"

namespace colonnade {

/// An interval along a line, metres.
struct Interval {
  double begin = 0.0;
  double end = 0.0;
  double length() const { return end > begin ? end - begin : 0.0; }
};
inline Interval overlap(const Interval& a, const Interval& b) {
  return {a.begin > b.begin ? a.begin : b.begin, a.end < b.end ? a.end : b.end};
}
/// Length of `interval` that at least one of `others` covers.
double coveredLength(const Interval& interval, std::vector<Interval> others);

/// A line on the floor with the parts of it that are there: p + s u for s in the pieces.
struct WallLine {
  LandmarkId id{};
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  Eigen::Vector2d u = Eigen::Vector2d::UnitX();
  std::vector<Interval> pieces;
  std::vector<int> observations;  ///< of each piece
  int hallway = -1;

  Eigen::Vector2d normal() const { return {-u.y(), u.x()}; }
  double along(const Eigen::Vector2d& point) const { return u.dot(point - p); }
  double across(const Eigen::Vector2d& point) const { return normal().dot(point - p); }
  int mostObservations() const;
  double length() const;
};

/// A floor edge as a line with one piece.
WallLine toLine(const LandmarkRecord& record);

/// The floor edges of a map as lines; those in one line (3 cm, 1 degree, same hallway) joined, the
/// longest first and with its place and direction.
std::vector<WallLine> joinLines(const LandmarkMap& map);

/// Angle from line b to line a in (-pi/2, pi/2].
double lineAngle(const WallLine& a, const WallLine& b);

/// How an estimated line lies on a true one.
struct LineFit {
  double offset_m = 0.0;  ///< across the true line in the middle of what both have
  double angle = 0.0;
  double gap_m = 0.0;  ///< between the extents; 0 when they overlap
  Interval extent;     ///< of the estimate along the true line
  double on_truth_m = 0.0;
};
LineFit fitLine(const WallLine& estimate, const WallLine& truth);

}  // namespace colonnade
