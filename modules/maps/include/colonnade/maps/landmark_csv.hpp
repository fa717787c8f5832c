// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "colonnade/filter/landmark_map.hpp"

namespace colonnade {

/// landmarks.csv, one row per landmark, metres, radians and seconds:
///   id,kind,x,y,direction,extent_ax,extent_ay,extent_bx,extent_by,cov_xx,cov_xy,cov_yy,hallway,
///   pair_id,observations,first_stamp,last_stamp
/// `direction` is empty for vertical landmarks, `pair_id` where there is no pair. Written
/// atomically. Reading takes the columns in any order, finds them by the header, ignores further
/// ones, and throws Error with file and line. The standard deviation of a direction has no column.
void writeLandmarksCsv(const std::filesystem::path& path, const LandmarkMap& landmarks);
LandmarkMap readLandmarksCsv(const std::filesystem::path& path);

}  // namespace colonnade
