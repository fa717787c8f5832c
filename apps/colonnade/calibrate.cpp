// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>

#include "calibrate_input.hpp"
#include "calibration_report.hpp"
#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/config.hpp"
#include "colonnade/base/log_path.hpp"
#include "detect_stages.hpp"
#include "interrupt.hpp"
#include "known_pillar.hpp"
#include "path_map.hpp"
#include "progress.hpp"
#include "run_options.hpp"
#include "verbs.hpp"

namespace colonnade {
namespace {

namespace fs = std::filesystem;

struct CalibrateArguments {
  fs::path input, distances, output, config;
  std::string backend = kDefaultBackend;
  std::vector<std::string> assignments;
  double width_m = 0.0;
  bool worked_case = false;
  bool json = false;
};

struct Measured {
  std::vector<PillarPlace> places;
  bool lossy = false;
};

/// One place for each frame that shows the pillar and has a distance, from the table or from depth.
Measured measureInLog(const CalibrateArguments& arguments) {
  if (arguments.width_m <= 0.0)
    throw Error("calibrate: a log needs the width of the pillar in it: --width M",
                ExitCode::kUsage);
  cv::setNumThreads(1);
  const RunOptions options = readRunOptions(arguments.config, arguments.assignments);
  const bool by_table = !arguments.distances.empty();
  std::map<std::size_t, PillarPlace> table;
  if (by_table) table = readPlacesByFrame(arguments.distances);
  RawlogSource source(arguments.input, options.source);
  DetectStages stages(options.session, arguments.backend);
  KnownPillar pillar(arguments.width_m);
  Measured measured;
  Progress progress;
  const InterruptGuard interrupt;
  std::size_t frames = 0;
  std::size_t seen = 0;
  while (auto frame = interrupt.requested() ? std::nullopt : source.next()) {
    if (frame->gray.empty()) continue;
    auto place = pillar.find(*frame, stages.see(*frame).detections);
    progress.show(source.progress(), ++frames, "looking for the pillar");
    if (!place) continue;
    ++seen;
    if (by_table) {
      const auto row = table.find(frame->index);
      if (row == table.end()) continue;
      place->distance = row->second.distance;
      place->lateral = row->second.lateral;
    }
    if (place->distance || place->lateral) measured.places.push_back(*place);
  }
  progress.finish();
  if (measured.places.empty())
    throw Error(arguments.input.string() + ": " +
                (seen == 0 ? "no pillar in any of its " + std::to_string(frames) + " frames"
                           : "a pillar in " + std::to_string(seen) +
                                 " frames, but no distance to it; give --distances FILE"));
  std::fprintf(stderr, "%s: the pillar in %zu of %zu frames, %zu with distance or shift\n",
               arguments.input.c_str(), seen, frames, measured.places.size());
  measured.lossy = source.damage().any();
  return measured;
}

void writeForPathMap(const fs::path& path, const PillarCalibration& c) {
  constexpr double kInch_m = 0.0254;
  const double unit_m = c.unit == "m" ? 1.0 : kInch_m;
  PathMapOptions map;
  if (c.pinhole) map.pinhole_px_m = c.pinhole->product * unit_m;
  if (c.oblique) {
    map.focal_px = c.oblique->focal_px;
    map.centre_px = c.oblique->centre_px;
  }
  if (c.exponential) {
    map.at_zero_px = c.exponential->at_zero_px;
    map.decades_per_m = c.exponential->decades / unit_m;
  }
  if (c.linear) {
    map.slope_m_per_px = c.linear->slope * unit_m;
    map.offset_m = c.linear->offset * unit_m;
  }
  map.model = c.oblique ? "pinhole" : "exponential";
  ConfigWriter writer;
  writer.add(map);
  writeFileAtomically(path, writer.text());
}

ExitCode calibrate(const CalibrateArguments& arguments) {
  if (arguments.worked_case == !arguments.input.empty())
    throw Error("calibrate: give a table, a log or --worked-case (see colonnade calibrate --help)",
                ExitCode::kUsage);
  bool lossy = false;
  PillarCalibration c;
  if (arguments.worked_case) {
    c = workedCase();
  } else if (arguments.input.extension() == ".csv") {
    c = fitAll(readPlaces(arguments.input), "m", arguments.width_m);
  } else {
    Measured measured = measureInLog(arguments);
    lossy = measured.lossy;
    c = fitAll(std::move(measured.places), "m", arguments.width_m);
  }
  if (!arguments.output.empty()) writeForPathMap(arguments.output, c);
  std::fputs(arguments.json ? (toJson(c).dump(2) + "\n").c_str() : toText(c).c_str(), stdout);
  return lossy ? ExitCode::kLossy : ExitCode::kDone;
}

}  // namespace

Action addCalibrate(CLI::App& verb) {
  const auto arguments = std::make_shared<CalibrateArguments>();
  verb.add_option("TABLE_OR_LOG", arguments->input,
                  "CSV of distance_m, delta_rho_px, lateral_m, left_rho_px; or a rawlog");
  verb.add_option("--width", arguments->width_m, "of the pillar, m")->check(CLI::PositiveNumber);
  verb.add_option("--distances", arguments->distances,
                  "CSV of frame, distance_m, lateral_m for a log; default: from its depth");
  verb.add_flag("--worked-case", arguments->worked_case, "the tables of the 2015 thesis, inches");
  verb.add_flag("--json", arguments->json, "the fits as JSON");
  verb.add_option("-o,--output", arguments->output, "INI file for detect --path-map");
  verb.add_option("-c,--config", arguments->config, "INI file, such as config.ini of a run");
  verb.add_option("--backend", arguments->backend, "image stage: fixed, opencv, rtl")
      ->capture_default_str();
  verb.add_option("--set", arguments->assignments, "Section.key=value, wins over the file")
      ->allow_extra_args(false);
  verb.footer(
      "Delta rho is the distance of the pillar's two edges in the image, leftmost rho the column\n"
      "of its left edge, lateral the camera's shift to the right of that edge.\n"
      "Examples:\n"
      "  colonnade calibrate --worked-case\n"
      "  colonnade calibrate places.csv --width 0.4 -o camera.ini\n"
      "  colonnade calibrate hall.rawlog --width 0.5 -o camera.ini\n"
      "  colonnade detect hall.rawlog --path-map camera.ini -o seen");
  return [arguments] { return calibrate(*arguments); };
}

}  // namespace colonnade
