// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace colonnade {

/// What a building is made of, as far as a planar robot needs it.
enum class LandmarkKind : std::uint8_t {
  kPillarEdge,  ///< a vertical line: one edge of a pillar, door frame, beam or wall end
  kFloorEdge,   ///< the line in which a wall meets the floor
  kDepthSlope   ///< a vertical corner where the slope of the depth profile jumps
};
inline constexpr int kLandmarkKinds = 3;

/// The name used in files: pillar, floor_edge, depth_slope.
constexpr const char* name(LandmarkKind kind) {
  switch (kind) {
    case LandmarkKind::kPillarEdge:
      return "pillar";
    case LandmarkKind::kFloorEdge:
      return "floor_edge";
    case LandmarkKind::kDepthSlope:
      return "depth_slope";
  }
  return "unknown";
}

/// Identity of a landmark in one map: never reused, so that files and events can refer to it.
enum class LandmarkId : std::int32_t {};
constexpr std::int32_t number(LandmarkId id) { return static_cast<std::int32_t>(id); }

}  // namespace colonnade
