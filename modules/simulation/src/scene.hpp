// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/opengl/COpenGLScene.h>

#include "colonnade/simulation/building.hpp"

namespace colonnade {

/// The building as an MRPT scene: all faces painted into a few big textures, lights off, because
/// the light is painted too. Throws Error when a face is too large for a texture.
mrpt::opengl::COpenGLScene::Ptr buildScene(const World& world, const Building& building);

/// Makes a scene from buildScene ready for a picture: puts the walkers where they are `time_s`
/// after the start, and sees to it that glass is drawn after what is behind it.
void arrangeScene(mrpt::opengl::COpenGLScene& scene, const std::vector<Walker>& walkers,
                  const Eigen::Isometry3d& T_world_camera, double time_s);

}  // namespace colonnade
