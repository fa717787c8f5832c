// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "colonnade/base/pose2.hpp"
#include "colonnade/maps/levelled_scan.hpp"
#include "colonnade/maps/map_picture.hpp"

namespace colonnade {

/// A scan worth keeping and where it was taken.
struct KeyFrame {
  double stamp_s = 0.0;
  Pose2 T_world_robot;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  LevelledScan scan;
  mrpt::obs::CObservation2DRangeScan::Ptr observation;  ///< the same scan
};

/// The occupancy grid of the key frames, just large enough, its corner on a multiple of the cell.
/// Beams free what lies before their obstacle, or the floor they see; nothing
/// else. At least one key frame.
mrpt::maps::COccupancyGridMap2D::Ptr buildGrid(const std::vector<KeyFrame>& key_frames,
                                               double resolution_m);

/// Thresholds of map_server: occupied from 0.65, free up to 0.196, between them unknown.
GridPicture toPicture(const mrpt::maps::COccupancyGridMap2D& grid);

/// Writes `stem`.png and `stem`.yaml as ROS map servers read them.
void writeNavigationMap(const std::filesystem::path& folder, const std::string& stem,
                        const GridPicture& grid);

}  // namespace colonnade
