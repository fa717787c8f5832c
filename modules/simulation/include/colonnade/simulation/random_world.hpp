// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace colonnade {

/// What a random building may hold.
struct RandomWorldOptions {
  int most_legs = 4;  ///< of the corridor, 1 to 4
  bool rings = true;  ///< one of four closes to a ring
  bool halls = true;  ///< the last leg may be a hall with pillars
  bool rooms = true;  ///< behind doors; the robot visits up to two
  bool people = true;
};

/// The text of a world file: a building drawn from the seed, with a route through it. It passes
/// all checks of readWorld. The same seed and options give the same text on every machine.
std::string randomWorldText(std::uint64_t seed, const RandomWorldOptions& options = {});

}  // namespace colonnade
