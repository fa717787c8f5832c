// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "colonnade/filter/state.hpp"
#include "colonnade/slam/hallway.hpp"
#include "colonnade/slam/landmark_book.hpp"

namespace colonnade {

/// All that a later run needs to go on from a map or to find its way in it: landmarks and axes with
/// their joint covariance, what is known of their looks, the hallways; of landmark readings the
/// identities.
struct SavedMap {
  enum class Source { kCamera, kReadings };
  Source source = Source::kCamera;
  State state;                           ///< landmarks and axes; the robot's entries are zero
  Pose2 T_world_start = {};              ///< of the drive that began the map, as known at the end
  std::map<LandmarkId, int> identities;  ///< in the log, of the landmarks that have one
  LandmarkBook book;
  std::vector<LandmarkId> axes;
  std::vector<Hallway> hallways;
};

/// `map.colonnade`: plain text, one thing a line, numbers that read back as the same doubles, a
/// version in the first line and a checksum in the last.
class MapFile {
 public:
  static std::string text(const SavedMap& map);
  /// Throws Error naming the file and what is wrong: no such file, no map of ours, a version this
  /// program does not know, or damage.
  static SavedMap read(const std::filesystem::path& path);
};

}  // namespace colonnade
