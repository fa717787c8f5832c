// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "colonnade/filter/smoother.hpp"
#include "colonnade/slam/drive_record.hpp"
#include "known_map.hpp"

namespace colonnade {

/// A drive as it is known by now, past the landmarks of a map.
struct DriveRecord::Prepared {
  Drive drive;
  std::vector<int> identities;        ///< of the sightings, as the log tells them
  std::vector<std::size_t> readings;  ///< of the sightings
  std::vector<std::size_t> places;    ///< of the points, in the map
  std::optional<KnownMap> known;      ///< what a loaded map says of it beforehand
};

/// Finite, and most of what was read is what it was taken for.
inline bool isGood(const Drive& drive, const Smoothing& how) {
  return std::isfinite(how.cost) && 2 * how.unused < drive.sightings.size();
}

}  // namespace colonnade
