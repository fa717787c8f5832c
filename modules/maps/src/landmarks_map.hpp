// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/maps/CLandmarksMap.h>

#include "colonnade/filter/landmark_map.hpp"

namespace colonnade {

/// The encoding that landmarks_map_file.hpp describes, there and back.
mrpt::maps::CLandmarksMap::Ptr toLandmarksMap(const LandmarkMap& landmarks);
LandmarkMap fromLandmarksMap(const mrpt::maps::CLandmarksMap& map);

}  // namespace colonnade
