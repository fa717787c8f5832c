// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "calibration_fits.hpp"

namespace colonnade {

/// A table measured by hand, metres and pixels: any of the columns distance_m, lateral_m,
/// delta_rho_px, left_rho_px in any order under a header; empty cells are not measured. Throws
/// Error naming file, line and column.
std::vector<PillarPlace> readPlaces(const std::filesystem::path& csv);

/// By frame of a log: a table with the column frame and distance_m, lateral_m or both.
std::map<std::size_t, PillarPlace> readPlacesByFrame(const std::filesystem::path& csv);

}  // namespace colonnade
