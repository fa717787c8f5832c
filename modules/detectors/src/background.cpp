// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "background.hpp"

#include <algorithm>
#include <cmath>

#include "straight_pieces.hpp"

namespace colonnade {
namespace {

constexpr double kWidestMover_m = 1.0;  ///< straight: no person, nor the leaf of a door
constexpr double kKnownWall_m = 0.3;    ///< of a straight piece; then it is a wall as a whole
constexpr double kInWall_m = 0.05;      ///< from the plane of a wall seen before
constexpr double kBeyondWall_m = 2.0;   ///< from the part of it that was seen
constexpr double kLevel = 0.1;          ///< slope of what looks level
constexpr double kLeastAge = 0.5;       ///< of a view that testifies, by the former one's

}  // namespace

Background::Background(const DepthGlimpse& now, std::vector<const DepthGlimpse*> views,
                       const SegmentationOptions& options)
    : now_(now),
      views_(std::move(views)),
      options_(options),
      apart_s_(0.9 * options.short_history_s),
      known_(now.cells.near_m.size(), Known::kNotAsked),
      wall_(now.cells.near_m.size(), 0),
      row_is_done_(static_cast<std::size_t>(now.cells.rows), 0) {
  for (const DepthGlimpse* view : views_) {
    T_view_now_.push_back(view->T_world_camera.inverse() * now.T_world_camera);
    if (now.stamp_s - view->stamp_s >= apart_s_)
      walls_.insert(walls_.end(), view->walls.begin(), view->walls.end());
  }
}

Eigen::Vector3d Background::placeOf(std::size_t cell) const {
  const DepthCells& cells = now_.cells;
  const int column = static_cast<int>(cell) % cells.columns;
  const int row = static_cast<int>(cell) / cells.columns;
  return static_cast<double>(cells.near_m[cell]) * cells.ray(column, row);
}

std::optional<std::size_t> Background::seenBy(std::size_t view,
                                              const Eigen::Vector3d& p_now) const {
  const Eigen::Vector3d p_view = T_view_now_[view] * p_now;
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
  if (isWall(cell) || isInWall(cell)) return true;
  const auto z = static_cast<double>(now_.cells.near_m[cell]);
  const double tolerance_m = options_.tolerance_m + options_.tolerance_per_m2 * z * z;
  const double former_age_s = now_.stamp_s - former.stamp_s;
  const Eigen::Vector3d p_now = placeOf(cell);
  std::optional<double> first_s;  // a view, moving or not, that saw it
  for (std::size_t i = 0; i < views_.size(); ++i) {
    // Had it come from where `former` saw it at one speed, so old a view would have seen it off its
    // place.
    const double age_s = now_.stamp_s - views_[i]->stamp_s;
    if (age_s < kLeastAge * former_age_s || nearer_m * age_s < tolerance_m * former_age_s) continue;
    const auto there = seenBy(i, p_now);
    if (!there) continue;
    if (heldStill(i, *there)) return true;
    if (!first_s) first_s = views_[i]->stamp_s;
    if (views_[i]->stamp_s - *first_s >= apart_s_) return true;
  }
  return false;
}

/// Somebody who just came out from behind something is not marked yet: two views must agree.
bool Background::isKnown(std::size_t cell) {
  if (known_[cell] == Known::kNotAsked) {
    known_[cell] = Known::kNo;
    const Eigen::Vector3d p_now = placeOf(cell);
    std::optional<double> first_s;
    for (std::size_t i = 0; i < views_.size() && known_[cell] == Known::kNo; ++i) {
      const double stamp_s = views_[i]->stamp_s;
      if (now_.stamp_s - stamp_s < apart_s_) break;
      if (first_s && stamp_s - *first_s < apart_s_) continue;
      const auto there = seenBy(i, p_now);
      if (!there || !heldStill(i, *there)) continue;
      if (first_s) known_[cell] = Known::kYes;
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

/// Keeps what of a row is wide or known.
void Background::findWalls(int row) {
  row_is_done_[static_cast<std::size_t>(row)] = 1;
  const std::size_t start = now_.cells.index(0, row);
  for (const StraightPiece& piece : straightPieces(now_.cells, row, options_)) {
    bool wall = piece.length_m >= kWidestMover_m;
    if (!wall && piece.length_m >= kKnownWall_m) {
      int known = 0;
      for (int column = piece.first; column < piece.end; ++column)
        known += isKnown(start + static_cast<std::size_t>(column)) ? 1 : 0;
      wall = known * piece.length_m >= kKnownWall_m * (piece.end - piece.first);
    }
    if (!wall) continue;
    std::fill(wall_.begin() + static_cast<std::ptrdiff_t>(start) + piece.first,
              wall_.begin() + static_cast<std::ptrdiff_t>(start) + piece.end, std::uint8_t{1});
  }
}

bool Background::isInWall(std::size_t cell) const {
  if (walls_.empty()) return false;
  const Eigen::Vector2d p = (now_.T_world_camera * placeOf(cell)).head<2>();
  return std::any_of(walls_.begin(), walls_.end(), [&p](const WallLine& wall) {
    const Eigen::Vector2d offset = p - wall.p_world;
    const double place_m = wall.along.dot(offset);
    const double off_m = wall.along.x() * offset.y() - wall.along.y() * offset.x();
    return std::abs(off_m) < kInWall_m && place_m > -kBeyondWall_m &&
           place_m < wall.length_m + kBeyondWall_m;
  });
}

std::vector<WallLine> wallLines(const DepthGlimpse& view, const SegmentationOptions& options) {
  std::vector<WallLine> lines;
  const DepthCells& cells = view.cells;
  // The row that looks level ahead.
  const Eigen::Vector3d up = view.T_world_camera.linear().transpose() * Eigen::Vector3d::UnitZ();
  const auto off = [&](int row) { return std::abs(up.dot(cells.ray(cells.columns / 2, row))); };
  int level = 0;
  for (int row = 1; row < cells.rows; ++row)
    if (off(row) < off(level)) level = row;
  if (off(level) > kLevel) return {};
  for (const StraightPiece& piece : straightPieces(cells, level, options)) {
    if (piece.length_m < kWidestMover_m) continue;
    bool moving = view.moving.empty();
    for (int column = piece.first; column < piece.end && !moving; ++column)
      moving = view.moving[cells.index(column, level)];
    if (moving) continue;
    const auto place = [&](int column) -> Eigen::Vector2d {
      return (view.T_world_camera * (piece.line.at(column) * cells.ray(column, level))).head<2>();
    };
    const Eigen::Vector2d way = place(piece.end - 1) - place(piece.first);
    lines.push_back({place(piece.first), way.normalized(), way.norm()});
  }
  return lines;
}

}  // namespace colonnade
