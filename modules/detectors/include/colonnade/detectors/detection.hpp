// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "colonnade/base/measurement.hpp"

namespace colonnade {

/// What an edge looks like, so that it is recognised in the next frame. Colours are looked up for
/// accepted detections only.
struct Appearance {
  int gradient_sign = 0;                            ///< +1: brighter on its right (or far) side
  Eigen::Vector3f left = Eigen::Vector3f::Zero();   ///< mean B, G, R beside it; gray if no colour
  Eigen::Vector3f right = Eigen::Vector3f::Zero();  ///< (for floor edges: near and far side)
};

/// What a frame shows of how tall an upright edge is.
enum class UprightHeight {
  kUnknown,  ///< its upper end is out of the picture or hidden
  kLow,      ///< it ends lower than a part of the building would
  kTall      ///< it does not
};

/// One landmark seen in one frame.
struct Detection {
  Measurement measurement;
  Appearance appearance;
  Eigen::Vector2d a_px = Eigen::Vector2d::Zero();  ///< ends of the line in the image
  Eigen::Vector2d b_px = Eigen::Vector2d::Zero();
  /// Floor edges: where the seen part begins and ends, metres in the robot's axes.
  Eigen::Vector2d p_robot_a = Eigen::Vector2d::Zero();
  Eigen::Vector2d p_robot_b = Eigen::Vector2d::Zero();
  /// Pillar edges: the other edge of the same pillar, as an index into the frame's detections.
  std::optional<std::size_t> partner;
  double width_m = 0.0;  ///< pillars whose two edges have range, otherwise 0
  /// Pillar edges: from the camera, horizontal, also where it is too doubtful for a measurement; 0
  /// where it is not known, or the edge was refused before it mattered.
  double range_m = 0.0;
  UprightHeight height = UprightHeight::kUnknown;  ///< of pillar edges with a range
  /// Accepted pillar edges: a line of paint, a joint or a gap with the same surface on both sides.
  /// It stays where it is, and so serves as a landmark, but is no edge of a pillar, frame or wall.
  /// Accepted floor edges, where no depth tells: the same on the floor, no foot of a wall.
  bool on_surface = false;
  std::string refusal;  ///< why the detector does not stand behind it; empty = accepted

  LandmarkKind kind() const { return measurement.kind; }
  bool accepted() const { return refusal.empty(); }
};

using Detections = std::vector<Detection>;

/// Refuses an accepted one of the list; its partner, if any, stands alone then.
inline void refuse(Detections& detections, Detection& one, std::string reason) {
  one.refusal = std::move(reason);
  if (!one.partner) return;
  Detection& other = detections[*one.partner];
  other.partner.reset();
  other.width_m = 0.0;
  one.partner.reset();
  one.width_m = 0.0;
}

}  // namespace colonnade
