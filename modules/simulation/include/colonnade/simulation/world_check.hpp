// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/simulation/world.hpp"

namespace colonnade {

/// Throws Error (kUsage), naming file and line, when
///   - doors and pilasters of a wall overlap,
///   - the walls, open doors counted as shut, do not close around every place the robot visits,
///   - the robot comes nearer to a wall, pillar, open door or piece of furniture than its radius,
///   - a person walks into the robot.
void checkWorld(const World& world);

}  // namespace colonnade
