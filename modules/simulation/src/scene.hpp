// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/opengl/COpenGLScene.h>

#include "colonnade/simulation/building.hpp"

namespace colonnade {

/// The building as an MRPT scene: all faces painted into a few big textures, lights off, because
/// the light is painted too. Throws Error when a face is too large for a texture.
mrpt::opengl::COpenGLScene::Ptr buildScene(const World& world, const Building& building);

}  // namespace colonnade
