// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "colonnade/filter/landmark_map.hpp"

namespace colonnade {

/// A serialised mrpt::maps::CLandmarksMap (gz). A vertical landmark is one CLandmark on the floor;
/// a floor edge is two, its ends: the first has the landmark's ID, the second ID + 1000000000.
/// `features[0]` carries the rest: user_flags = 1 + kind, keypoint.ID = 1 + pair (0 = none),
/// orientation = direction, keypoint.response = its standard deviation. Covariances are single
/// precision. Hallway and first stamp are not carried; reading gives hallway -1 and first = last
/// stamp.
void writeLandmarksMap(const std::filesystem::path& path, const LandmarkMap& landmarks);

/// Reads what writeLandmarksMap wrote, or the landmarks of a CMultiMetricMap file. Landmarks of
/// another program become pillar edges; those without an ID of their own get the next free one.
/// Throws Error when the file holds neither.
LandmarkMap readLandmarksMap(const std::filesystem::path& path);

}  // namespace colonnade
