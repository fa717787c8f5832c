// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "colonnade/simulation/world.hpp"

namespace colonnade::testing {

/// A room of 6 m by 4 m around (2, 0), bare but for one pilaster on the far wall (x = 5).
inline World roomWorld(const std::string& more = "") {
  return parseWorld(
      "material plaster colour=200,200,200\n"
      "room r  -1 -2  5 -2  5 2  -1 2\n"
      "pilaster wall=r.2 at_m=1.0 width_m=0.4 depth_m=0.2\n"
      "lamp 2 0\n"
      "texture texels_per_m=60\n"
      "camera width_px=160 height_px=120 height_m=0.8 pitch_deg=10\n"
      "start 0 0\n"
      "drive 1 0 speed_m_per_s=0.5\n" +
          more,
      "room.world");
}

}  // namespace colonnade::testing
