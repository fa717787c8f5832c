// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfTriangles.h>

#include <vector>

#include "colonnade/simulation/world.hpp"

namespace colonnade {

/// A person for a scene: trunk with head, two legs and two arms that swing. `index`: of the walker
/// in its world, by which moveWalker finds the parts again.
std::vector<mrpt::opengl::CSetOfTriangles::Ptr> drawnWalker(const Walker& walker,
                                                            std::size_t index);

void moveWalker(mrpt::opengl::COpenGLScene& scene, const Walker& walker, std::size_t index,
                double time_s);

}  // namespace colonnade
