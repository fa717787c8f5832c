// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "colonnade/detectors/segmentation.hpp"
#include "moving_cells.hpp"

namespace colonnade {

/// Which surfaces of a view are parts of the room that somebody hid a moment ago, and not the
/// somebody: what a view saw at its place before, what goes on straight from there, what lies in
/// the plane of a wall seen before, and what is wider than a person.
class Background {
 public:
  /// `now` and `views` must outlive this.
  Background(const DepthGlimpse& now, std::vector<const DepthGlimpse*> views,
             const SegmentationOptions& options);

  /// Whether a cell of `now` cannot show what `former` saw `nearer_m` before it.
  bool isUncovered(std::size_t cell, const DepthGlimpse& former, double nearer_m);
  /// Whether a cell of `now` shows a part of the room, whoever passes.
  bool isStanding(std::size_t cell) { return isWall(cell) || isInWall(cell) || isKnown(cell); }

 private:
  enum class Known : std::uint8_t { kNotAsked, kNo, kYes };

  bool isKnown(std::size_t cell);
  bool isWall(std::size_t cell);
  bool isInWall(std::size_t cell) const;
  void findWalls(int row);
  /// Where a view saw the surface of a cell (in the camera's axes) at its place; nothing where it
  /// saw another one or none.
  std::optional<std::size_t> seenBy(std::size_t view, const Eigen::Vector3d& p_now) const;
  bool heldStill(std::size_t view, std::size_t cell_there) const;
  Eigen::Vector3d placeOf(std::size_t cell) const;

  const DepthGlimpse& now_;
  std::vector<const DepthGlimpse*> views_;
  std::vector<Eigen::Isometry3d> T_view_now_;
  std::vector<WallLine> walls_;  ///< of all views
  const SegmentationOptions& options_;
  double apart_s_;                         ///< two views that testify
  std::vector<Known> known_;               ///< cells
  std::vector<std::uint8_t> wall_;         ///< cells
  std::vector<std::uint8_t> row_is_done_;  ///< walls of these are found
};

/// Walls that a view shows at the height of the camera: wider than what moves, and unmoved. None
/// where it does not look level.
std::vector<WallLine> wallLines(const DepthGlimpse& view, const SegmentationOptions& options);

}  // namespace colonnade
