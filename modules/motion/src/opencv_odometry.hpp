// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "rgbd_pyramid.hpp"

namespace colonnade {

/// OpenCV's own frame-to-frame odometry (opencv_contrib rgbd) at the finest resolution of the
/// pyramids, T_previous_current. `method`: opencv (RgbdOdometry, Steinbruecker et al. 2011),
/// opencv_icp (ICPOdometry) or opencv_rgbd_icp (RgbdICPOdometry). Nothing when it reports failure.
std::optional<Eigen::Isometry3d> openCvOdometry(const std::string& method,
                                                const RgbdPyramid& previous,
                                                const RgbdPyramid& current,
                                                const Eigen::Isometry3d& T_previous_current_guess);

}  // namespace colonnade
