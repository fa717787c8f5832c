// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "colonnade/simulation/world.hpp"

namespace colonnade {

struct SimulationOptions {
  std::uint64_t seed = 1;
  int gz_level = 4;      ///< of the log: 0 plain, 1 fast ... 9 small
  bool pipeline = true;  ///< draw the next frame while one is measured and written; same bytes
  std::function<void(std::size_t done, std::size_t total)> progress = {};  ///< after every frame
};

struct SimulationSummary {
  std::size_t frames = 0;
  double duration_s = 0.0;
  double path_length_m = 0.0;
  std::size_t landmarks = 0;
  std::size_t landmarks_seen = 0;  ///< in at least one frame
  std::uintmax_t log_bytes = 0;
};

/// Drives the robot through its world and writes the log (action/sensory-frame pairs: one RGB-D
/// observation each, and the images of the second camera) and beside it the truth:
/// STEM_ground_truth.tum, STEM_landmarks.csv, STEM_columns.csv, STEM_floor.png and .yaml. The same
/// world, seed and options give the same bytes on the same machine. Throws Error.
SimulationSummary simulate(const World& world, const std::filesystem::path& log,
                           const SimulationOptions& options);

}  // namespace colonnade
