// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "colonnade/simulation/building.hpp"

namespace colonnade {

/// How brightly lamps light the surfaces: cosine law with the square of the distance, walls cast
/// shadows in plan, corners are darker (ambient occlusion). 1 = a material's own colour.
class Light {
 public:
  Light(const World& world, const Building& building);

  double brightness(const Eigen::Vector3d& p_world, const Eigen::Vector3d& normal) const;

 private:
  bool blocked(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;
  double openness(const Eigen::Vector3d& p_world, const Eigen::Vector3d& normal) const;

  std::vector<Lamp> lamps_;
  std::vector<FloorLine> outlines_;
  double ceiling_m_;
};

}  // namespace colonnade
