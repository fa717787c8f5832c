// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "cell_grid.hpp"
#include "residuals.hpp"

namespace colonnade {

/// Tells floor from what stands on it, by a second picture from elsewhere: everything that stands
/// on the floor is nearer than the floor behind it. In cells of the image, the brightness of points
/// is compared as if they lay on the floor and at falling shares of that depth; where a nearer one
/// explains the second picture clearly better, something stands there.
class StandingTest {
 public:
  enum class Verdict { kUnknown, kFloor, kStanding };

  explicit StandingTest(const PinholeCamera& camera);

  /// Points of the picture, placed on the floor, against another one seen from
  /// `state.T_current_reference`.
  void look(const std::vector<PhotometricPoint>& points, const PyramidLevel& other,
            const AlignmentState& state);
  /// For a place of the floor in the picture's optical frame; unknown where nothing was compared.
  /// Where the depth makes no difference, as along an edge that points to where the robot drives,
  /// it does no harm either, and counts as floor.
  Verdict verdict(const Eigen::Vector3f& p_camera) const;

 private:
  static constexpr std::array<float, 8> kShares = {1.0f,  0.94f, 0.87f, 0.79f,
                                                   0.70f, 0.60f, 0.48f, 0.35f};
  struct Cell {
    std::array<double, kShares.size()> cost{};  ///< squared residuals in units of their noise
    int count = 0;
  };
  CellGrid grid_;
  std::vector<Cell> cells_;
};

}  // namespace colonnade
