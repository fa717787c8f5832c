// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "cell_grid.hpp"
#include "rgbd_alignment.hpp"

namespace colonnade {

/// Tells floor from what it mirrors: the mirror image lies below the floor and moves less in the
/// picture. In cells of a reference picture the brightness of points of the floor is compared with
/// the current picture as if they lay at their depth, about it, and farther away; where farther
/// explains the picture clearly better, the cell mirrors.
class MirroredCells {
 public:
  /// `floor`: points of the reference's finest level. A way in `T_current_reference` that is wrong
  /// by a fifth does not matter.
  MirroredCells(const PinholeCamera& camera, const std::vector<PhotometricPoint>& floor,
                const PyramidLevel& current, const Eigen::Isometry3d& T_current_reference);

  /// Cells of floor that the camera moved enough to judge.
  int judged() const;
  /// Those that mirror beyond doubt: on a dull floor one in a hundred, by chance.
  int certain() const;
  /// Whether the cell of a point of the reference probably mirrors.
  bool mirrors(const Eigen::Vector3f& p_reference) const;
  bool mirrorSomewhere() const;

 private:
  /// In units of the depth measured: a fifth about it, and behind it.
  static constexpr std::array<float, 5> kAbout = {1.0f, 0.8f, 0.9f, 1.12f, 1.25f};
  static constexpr std::array<float, 5> kFarther = {1.6f, 2.0f, 2.7f, 4.0f, 10.0f};
  struct Cell {
    int points = 0;
    /// Squared residuals in units of their noise, at each depth.
    std::array<double, kAbout.size()> cost_about{};
    std::array<double, kFarther.size()> cost_farther{};

    bool judged() const;
    bool mirrors() const;
    /// Whether farther is better by a factor and a difference.
    bool prefersFarther(double factor, double difference) const;
  };
  CellGrid grid_;
  std::vector<Cell> cells_;
};

/// Where the reference's surfaces face up: its points of the finest level there. A camera tilted or
/// rolled by more than 37 degrees sees none.
std::vector<PhotometricPoint> pointsFacingUp(const Reference& reference);

/// Whether the floor is polished, as the last 1500 cells or so tell, some twenty frames: a dull one
/// shows mirroring cells by chance, too, and leaving those out costs more than it helps.
class PolishedFloor {
 public:
  void look(const MirroredCells& cells);
  bool isLikely() const;

 private:
  double share_ = 0.0;  ///< of judged cells that mirror beyond doubt
};

}  // namespace colonnade
