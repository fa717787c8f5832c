// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "colonnade/base/trajectory.hpp"
#include "colonnade/frames/tum_import.hpp"

namespace colonnade {

/// The direction up, seen from a camera at a time.
struct StampedUp {
  double stamp_s = 0.0;
  Eigen::Vector3d up_camera;
};

/// What kGuess means for this file: what its comments say, else what `ups` tell, else what it
/// begins with.
GroundTruthWorld guessWorld(const std::filesystem::path& file, const Trajectory& cameras,
                            const std::vector<StampedUp>& ups);

/// Camera poses -> the robot in a z-up world: the camera's centre dropped onto the floor, x along
/// the projected optical axis. For kFirstCamera the vertical is the mean of `ups`, each carried to
/// the first camera by the poses themselves.
Trajectory robotGroundTruth(const Trajectory& cameras, GroundTruthWorld world,
                            const std::vector<StampedUp>& ups);

}  // namespace colonnade
