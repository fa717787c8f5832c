// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <optional>

#include "colonnade/base/options.hpp"
#include "colonnade/base/pose2.hpp"
#include "colonnade/detectors/depth_profile.hpp"
#include "colonnade/detectors/detection.hpp"
#include "colonnade/detectors/places_around.hpp"
#include "colonnade/detectors/segmentation.hpp"
#include "colonnade/detectors/slice_memory.hpp"

namespace colonnade {

struct DoorLeafOptions {
  static constexpr const char* kSection = "DoorLeaves";
  bool enabled = true;
  double min_width_m = 0.6;
  double max_width_m = 1.1;
  double max_jamb_m = 0.4;  ///< of the wall in which the door is, with its frame
  double max_way_m = 8.0;   ///< of the robot since it was last seen: odometry drifts
  double gate_m = 0.16;     ///< between two sights of one leaf

  void visit(OptionVisitor& v) {
    v.flag("enabled", enabled, "refuse the edges of leaves of open doors");
    v.number("min_width_m", min_width_m, {0.3, 3}, "narrowest leaf");
    v.number("max_width_m", max_width_m, {0.3, 3}, "widest leaf");
    v.number("max_jamb_m", max_jamb_m, {0, 2}, "thickest wall with a door, frame included");
    v.number("max_way_m", max_way_m, {0.1, 1000},
             "way of the robot after which what was seen is forgotten");
    v.number("gate_m", gate_m, {0.01, 1}, "between two sights of one leaf");
  }
};

/// Refuses the free edge of the leaf of an open door, which may be elsewhere tomorrow. In the plan
/// that the depth slices of the way behind make, a leaf is a straight surface from the edge to an
/// opening in a wall: beyond its hinge and the thickness of that wall there is free space, and on
/// the other side of the opening, as wide as the leaf, the wall goes on across it. No such wall is
/// seen at the edge itself, else that is the jamb of the opening, seen along the leaf from the
/// room.
class DoorLeaves {
 public:
  explicit DoorLeaves(const DoorLeafOptions& options = {});

  /// Refuses accepted pillar edges with a range on leaves seen in this frame or before.
  /// T_previous_robot: how the robot moved since the frame given before; nothing where that is not
  /// known, which forgets everything.
  void judge(Detections& detections, const DepthProfile& profile, const Segmentation& segmentation,
             const std::optional<Pose2>& T_previous_robot);

 private:
  struct Leaf {};  ///< nothing but that it was seen
  /// A surface that ends in an edge.
  struct Plate {
    Eigen::Vector2d p_robot;  ///< the end
    Eigen::Vector2d along;    ///< from there along the surface
    Eigen::Vector2d front;    ///< at right angles, on the camera's side
    Eigen::Vector2d at(double along_m, double front_m) const {
      return p_robot + along_m * along + front_m * front;
    }
  };
  /// A wall at right angles to it, or nearly so.
  struct WallAcross {
    double along_m = 0.0;  ///< where its line meets the plate's
    double turn = 0.0;
    int seen = 0;  ///< of kWallSamples
    Eigen::Vector2d at(const Plate& plate, double out_m) const {
      return plate.at(along_m - out_m * std::sin(turn), out_m * std::cos(turn));
    }
  };
  static constexpr int kWallSamples = 7;

  bool isLeaf(const Plate& plate) const;
  bool isPlate(const Plate& plate) const;
  bool isClear(const Plate& plate, double along_m) const;
  WallAcross wallAcross(const Plate& plate, double from_m, double to_m) const;
  bool isPassage(const Plate& plate, const WallAcross& wall) const;
  static std::optional<Plate> plateBeside(const DepthProfile& profile,
                                          const Eigen::Vector2d& p_robot, int side);

  DoorLeafOptions options_;
  SliceMemory slices_;
  PlacesAround<Leaf> places_;  ///< of free edges
};

}  // namespace colonnade
