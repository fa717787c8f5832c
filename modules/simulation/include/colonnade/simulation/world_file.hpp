// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "colonnade/simulation/world.hpp"

namespace colonnade {

struct LoadedWorld {
  World world;
  std::string text;  ///< of the world file, with the amendments below: what it takes to repeat it
};

/// A checked world by its name: a world file, or "random:SEED" for a building drawn from the seed.
/// Throws Error (kUsage) as readWorld does.
LoadedWorld loadWorld(const std::string& name, const std::vector<std::string>& amendments = {});

}  // namespace colonnade
