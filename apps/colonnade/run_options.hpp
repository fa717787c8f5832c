// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "colonnade/frames/rawlog_source.hpp"
#include "colonnade/maps/map_recorder.hpp"
#include "colonnade/slam/range_bearing_options.hpp"
#include "colonnade/slam/session.hpp"

namespace colonnade {

/// Every section of the configuration file. Verbs that need a part of it read it all, so that the
/// config.ini of a run serves them too.
struct RunOptions {
  SourceOptions source;
  SessionOptions session;
  RangeBearingOptions range_bearing;  ///< logs of landmark readings without images
  ScanOptions scans;
  MapOptions maps;

  template <class Take>
  void each(Take&& take) {
    take(source);
    session.each(take);
    take(range_bearing);
    take(scans);
    take(maps);
  }
};

/// An INI file (none: an empty path), then single `Section.key=value`, which win. Throws Error
/// (kUsage) naming file, line and key.
RunOptions readRunOptions(const std::filesystem::path& config,
                          const std::vector<std::string>& assignments);

/// The INI text that reads back as these options.
std::string effectiveConfig(RunOptions options);

}  // namespace colonnade
