// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "rgbd_alignment.hpp"

namespace colonnade {

/// Where else an alignment may start (reference from current camera): at the prior, turned to
/// either side about `up_camera` (the current camera's axes; the former camera's will do) as far as
/// the prior is unsure of it, in steps over which an alignment finds its way. None where the prior
/// is sure of a few degrees.
std::vector<Eigen::Isometry3d> turnedStarts(const MotionPrior& prior,
                                            const Eigen::Vector3d& up_camera);

}  // namespace colonnade
