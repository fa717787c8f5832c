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

/// How well the start is known in a map that is loaded (--map).
struct ResumeOptions {
  static constexpr const char* kSection = "Resume";
  double start_sigma_m = 0.05;
  double start_sigma_heading = radians(1.0);

  void visit(OptionVisitor& v) {
    v.number("start_sigma_m", start_sigma_m, {1e-4, 20}, "of the start in a loaded map");
    v.angle("start_sigma_heading_deg", start_sigma_heading, {0.01, 30}, "of the heading there");
  }
};

/// Every section of the configuration file. Verbs that need a part of it read it all, so that the
/// config.ini of a run serves them too.
struct RunOptions {
  SourceOptions source;
  SessionOptions session;
  RangeBearingOptions range_bearing;  ///< logs of landmark readings without images
  ScanOptions scans;
  MapOptions maps;
  ResumeOptions resume;
  PlaceOptions places;  ///< for a start anywhere in a loaded map

  template <class Take>
  void each(Take&& take) {
    take(source);
    session.each(take);
    take(range_bearing);
    take(scans);
    take(maps);
    take(resume);
    take(places);
  }
};

/// An INI file (none: an empty path), then single `Section.key=value`, which win. Throws Error
/// (kUsage) naming file, line and key.
RunOptions readRunOptions(const std::filesystem::path& config,
                          const std::vector<std::string>& assignments);

/// The INI text that reads back as these options.
std::string effectiveConfig(RunOptions options);

}  // namespace colonnade
