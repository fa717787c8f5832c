// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "colonnade/base/options.hpp"
#include "colonnade/base/pose2.hpp"
#include "colonnade/detectors/detection.hpp"
#include "colonnade/detectors/places_around.hpp"
#include "colonnade/detectors/segmentation.hpp"

namespace colonnade {

struct PillarMemoryOptions {
  static constexpr const char* kSection = "PillarMemory";
  bool enabled = true;
  double gate_m = 0.16;     ///< between two sights of one edge
  double max_way_m = 15.0;  ///< of the robot since it was last seen: odometry drifts

  void visit(OptionVisitor& v) {
    v.flag("enabled", enabled, "remember how tall upright edges are");
    v.number("gate_m", gate_m, {0.01, 1}, "between two sights of one upright edge");
    v.number("max_way_m", max_way_m, {0.1, 1000}, "way of the robot after which it is forgotten");
  }
};

/// Remembers how tall the upright edges around the robot are. From afar the upper end of a cabinet,
/// a table or a chair is in the picture and tells that they are no parts of the building; from near
/// it is not. The places of edges are carried along by the robot's motion.
class PillarMemory {
 public:
  explicit PillarMemory(const PillarMemoryOptions& options = {});

  /// Refuses accepted pillar edges whose height this frame does not show where more often low ones
  /// than tall ones were seen, then takes in what it does show, except on what moves.
  /// T_previous_robot: how the robot moved since the frame given before; nothing where that is not
  /// known, which forgets everything.
  void judge(Detections& detections, const Segmentation& segmentation,
             const std::optional<Pose2>& T_previous_robot);

 private:
  struct Heights {
    int low = 0, tall = 0;  ///< sights
  };
  bool goesOnAbove(const Detections& detections, const Detection& low,
                   const Eigen::Vector2d& p_robot) const;

  PillarMemoryOptions options_;
  PlacesAround<Heights> places_;
};

}  // namespace colonnade
