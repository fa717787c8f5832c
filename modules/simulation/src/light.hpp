// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "colonnade/simulation/building.hpp"

namespace colonnade {

/// How brightly lamps light the surfaces: cosine law with the square of the distance, what stands
/// on the floor casts shadows, corners and the floor under tables are darker (ambient occlusion).
/// 1 = a material's own colour.
class Light {
 public:
  Light(const World& world, const Building& building);

  double brightness(const Eigen::Vector3d& p_world, const Eigen::Vector3d& normal) const;

 private:
  /// A lamp with what stands within its reach.
  struct LitPart {
    Lamp lamp;
    std::vector<FloorLine> around;
  };

  bool blocked(const Eigen::Vector3d& p_world, const LitPart& part) const;
  double openness(const Eigen::Vector3d& p_world, const Eigen::Vector3d& normal) const;
  const std::vector<FloorLine>& near(const Eigen::Vector2d& p) const;

  std::vector<LitPart> parts_;
  std::vector<Obstacle> covers_;                ///< table tops and seats
  std::vector<std::vector<FloorLine>> places_;  ///< outlines near each square metre, row by row
  Eigen::Vector2d low_;
  int columns_ = 0;
  int rows_ = 0;
  double ceiling_m_;
};

}  // namespace colonnade
