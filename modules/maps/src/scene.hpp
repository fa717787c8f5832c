// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/opengl/COpenGLScene.h>

#include "colonnade/base/trajectory.hpp"
#include "colonnade/filter/landmark_map.hpp"
#include "colonnade/maps/map_picture.hpp"

namespace colonnade {

/// The map in space, of stock MRPT objects only: metre grid, occupancy (may be empty), pillars and
/// depth-slope corners as columns with 95 % ellipses, floor edges as lines, path, and a legend.
mrpt::opengl::COpenGLScene makeScene(const LandmarkMap& landmarks, const Trajectory& trajectory,
                                     const GridPicture& grid);

}  // namespace colonnade
