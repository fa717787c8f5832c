// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "background.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

constexpr double kWidestMover_m = 1.0;  ///< straight: no person, nor the leaf of a door
constexpr double kKnownWall_m = 0.3;    ///< of a straight piece; then it is a wall as a whole
constexpr double kLeastAge = 0.5;       ///< of a view that testifies, by the former one's

/// Least squares: inverse depth over columns, linear on a plane.
class StraightPiece {
 public:
  void start(int column, float z_m) {
    *this = {};
    add(column, z_m);
  }
  void add(int column, float z_m) {
    if (count_ == 0.0) origin_ = column;
    const double x = column - origin_, q = 1.0 / static_cast<double>(z_m);
    count_ += 1.0;
    x_ += x;
    q_ += q;
    xx_ += x * x;
    xq_ += x * q;
  }
  /// Depth at a column, metres; not positive beyond the horizon.
  double at(int column) const {
    const double spread = count_ * xx_ - x_ * x_;
    const double slope = spread > 0.0 ? (count_ * xq_ - x_ * q_) / spread : 0.0;
    return 1.0 / ((q_ - slope * x_) / count_ + slope * (column - origin_));
  }
  int count() const { return static_cast<int>(count_); }

 private:
  int origin_ = 0;
  double count_ = 0.0, x_ = 0.0, q_ = 0.0, xx_ = 0.0, xq_ = 0.0;
};

}  // namespace

Background::Background(const DepthGlimpse& now, std::vector<const DepthGlimpse*> views,
                       const SegmentationOptions& options)
    : now_(now),
      views_(std::move(views)),
      options_(options),
      known_(now.cells.near_m.size(), Known::kNotAsked),
      wall_(now.cells.near_m.size(), 0),
      row_is_done_(static_cast<std::size_t>(now.cells.rows), 0) {
  for (const DepthGlimpse* view : views_)
    T_view_now_.push_back(view->T_world_camera.inverse() * now.T_world_camera);
}

Eigen::Vector3d Background::placeOf(std::size_t cell) const {
  const DepthCells& cells = now_.cells;
  const int column = static_cast<int>(cell) % cells.columns;
  const int row = static_cast<int>(cell) / cells.columns;
  return static_cast<double>(cells.near_m[cell]) * cells.ray(column, row);
}

std::optional<std::size_t> Background::seenBy(std::size_t view, std::size_t cell) const {
  const Eigen::Vector3d p_view = T_view_now_[view] * placeOf(cell);
  const auto there = views_[view]->cells.cellOf(p_view);
  if (!there) return std::nullopt;
  const auto seen_m = static_cast<double>(views_[view]->cells.near_m[*there]);
  const double tolerance_m = options_.tolerance_m + options_.tolerance_per_m2 * seen_m * seen_m;
  if (seen_m == 0.0 || std::abs(seen_m - p_view.z()) > tolerance_m) return std::nullopt;
  return there;
}

bool Background::heldStill(std::size_t view, std::size_t cell_there) const {
  const auto& moving = views_[view]->moving;
  return !moving.empty() && !moving[cell_there];
}

bool Background::isUncovered(std::size_t cell, const DepthGlimpse& former, double nearer_m) {
  if (isWall(cell)) return true;
  const auto z = static_cast<double>(now_.cells.near_m[cell]);
  const double tolerance_m = options_.tolerance_m + options_.tolerance_per_m2 * z * z;
  const double former_age_s = now_.stamp_s - former.stamp_s;
  double first_s = 0.0;  // a view, moving or not, that saw it
  for (std::size_t i = 0; i < views_.size(); ++i) {
    // Had it come from where `former` saw it at one speed, so old a view would have seen it off its
    // place.
    const double age_s = now_.stamp_s - views_[i]->stamp_s;
    if (age_s < kLeastAge * former_age_s || nearer_m * age_s < tolerance_m * former_age_s) continue;
    const auto there = seenBy(i, cell);
    if (!there) continue;
    if (heldStill(i, *there)) return true;
    if (first_s == 0.0) first_s = views_[i]->stamp_s;
    if (views_[i]->stamp_s - first_s >= 0.9 * options_.short_history_s) return true;
  }
  return false;
}

/// Somebody who just came out from behind something is not marked yet: two views must agree.
bool Background::isKnown(std::size_t cell) {
  if (known_[cell] == Known::kNotAsked) {
    known_[cell] = Known::kNo;
    const double apart_s = 0.9 * options_.short_history_s;
    double first_s = 0.0;
    for (std::size_t i = 0; i < views_.size() && known_[cell] == Known::kNo; ++i) {
      const double stamp_s = views_[i]->stamp_s;
      if (now_.stamp_s - stamp_s < apart_s) break;
      if (first_s > 0.0 && stamp_s - first_s < apart_s) continue;
      const auto there = seenBy(i, cell);
      if (!there || !heldStill(i, *there)) continue;
      if (first_s > 0.0) known_[cell] = Known::kYes;
      first_s = stamp_s;
    }
  }
  return known_[cell] == Known::kYes;
}

bool Background::isWall(std::size_t cell) {
  const auto row = cell / static_cast<std::size_t>(now_.cells.columns);
  if (!row_is_done_[row]) findWalls(static_cast<int>(row));
  return wall_[cell];
}

/// Cuts a row where its depth jumps or bends, and keeps the pieces that are wide or known.
void Background::findWalls(int row) {
  row_is_done_[static_cast<std::size_t>(row)] = 1;
  const DepthCells& cells = now_.cells;
  const std::size_t start = cells.index(0, row);
  const float* const near_m = &cells.near_m[start];
  StraightPiece piece;
  const auto goesOn = [&](int column) {
    const auto z = static_cast<double>(near_m[column]);
    const double tolerance_m = 0.5 * (options_.tolerance_m + options_.tolerance_per_m2 * z * z);
    const double expected_m = piece.at(column);
    return expected_m > 0.0 &&
           std::abs(expected_m - z) < (piece.count() < 3 ? 3.0 : 1.0) * tolerance_m;
  };
  const auto isWallFrom = [&](int first, int end) {
    const auto at = [&](int column) { return placeOf(start + static_cast<std::size_t>(column)); };
    const double length_m = (at(end - 1) - at(first)).norm();
    if (length_m >= kWidestMover_m) return true;
    if (length_m < kKnownWall_m) return false;
    int known = 0;
    for (int column = first; column < end; ++column)
      known += isKnown(start + static_cast<std::size_t>(column)) ? 1 : 0;
    return known * length_m >= kKnownWall_m * (end - first);
  };
  for (int first = 0; first < cells.columns;) {
    int end = first + 1;
    if (near_m[first] != DepthCells::kNone) {
      piece.start(first, near_m[first]);
      while (end < cells.columns && near_m[end] != DepthCells::kNone && goesOn(end)) {
        piece.add(end, near_m[end]);
        ++end;
      }
      if (end - first >= 3 && isWallFrom(first, end))
        std::fill(wall_.begin() + static_cast<std::ptrdiff_t>(start) + first,
                  wall_.begin() + static_cast<std::ptrdiff_t>(start) + end, std::uint8_t{1});
    }
    first = end;
  }
}

}  // namespace colonnade
