// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/baselines/baseline.hpp"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>
#include <optional>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/config.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/base/trajectory.hpp"
#include "colonnade/evaluation/score_json.hpp"
#include "colonnade/evaluation/trajectory_score.hpp"
#include "colonnade/frames/rawlog_source.hpp"
#include "colonnade/maps/landmark_csv.hpp"
#include "interrupt.hpp"
#include "measured.hpp"
#include "progress.hpp"
#include "results_folder.hpp"
#include "run_options.hpp"
#include "verbs.hpp"

namespace colonnade {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Arguments {
  std::string method;
  fs::path log;
  fs::path config;
  fs::path output;
  fs::path ground_truth;
  std::vector<std::string> assignments;
  bool no_map_files = false;
};

/// Every section of a run's configuration and those of the baselines.
struct Options {
  RunOptions run;
  BaselineOptions baseline;

  template <class Take>
  void each(Take&& take) {
    run.each(take);
    baseline.each(take);
  }
};

Options readOptions(const Arguments& arguments) {
  Config config = arguments.config.empty() ? Config() : Config::fromFile(arguments.config);
  for (const std::string& assignment : arguments.assignments) config.set(assignment);
  Options options;
  options.each([&](auto& section) { config.read(section); });
  config.requireAllKnown();
  options.baseline.motion = options.run.session.motion;
  options.baseline.edges = options.run.session.edges;
  options.baseline.detectors = options.run.session.detectors;
  return options;
}

/// What a baseline leaves of a log.
struct Record {
  Trajectory trajectory;
  std::vector<double> frame_ms;
  std::vector<double> read_ms;
  std::vector<double> map_ms;               ///< of frames that added to the map
  std::map<std::string, std::size_t> lost;  ///< reason -> frames
  double path_length_m = 0.0;
  double peak_rss_mb = 0.0;  ///< before anything is written
  bool interrupted = false;
};

class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - start_).count();
    start_ = now;
    return ms;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

Record follow(RawlogSource& source, Baseline& baseline) {
  Record record;
  Progress progress;
  const InterruptGuard interrupt;
  Stopwatch watch;
  while (!interrupt.requested()) {
    const auto frame = source.next();
    if (!frame) break;
    const double read_ms = watch.lap();
    const BaselineStep step = baseline.step(*frame);
    record.frame_ms.push_back(read_ms + watch.lap() - step.map_ms);
    record.read_ms.push_back(read_ms);
    if (step.map_ms > 0.0) record.map_ms.push_back(step.map_ms);
    if (!step.lost.empty()) ++record.lost[step.lost];
    const StampedPose pose{frame->stamp_s, step.T_world_robot.toIsometry3()};
    if (!record.trajectory.empty())
      record.path_length_m +=
          (pose.T_world_body.translation() - record.trajectory.back().T_world_body.translation())
              .norm();
    record.trajectory.push_back(pose);
    progress.show(source.progress(), record.trajectory.size(), "");
    watch.lap();  // bookkeeping is no part of the method
  }
  record.interrupted = interrupt.requested();
  record.peak_rss_mb = peakResidentMegabytes();
  progress.finish();
  return record;
}

Json summarize(const Arguments& arguments, const Record& record, const Baseline& baseline,
               const Damage& damage) {
  std::size_t lost = 0;
  for (const auto& [reason, count] : record.lost) lost += count;
  std::size_t skipped = 0;
  for (const auto& [reason, count] : damage.skipped) skipped += count;
  const double duration = record.trajectory.empty() ? 0.0
                                                    : record.trajectory.back().stamp_s -
                                                          record.trajectory.front().stamp_s;
  Json json;
  json["method"] = arguments.method;
  json["frames"] = record.trajectory.size() + skipped;
  json["frames_processed"] = record.trajectory.size();
  json["interrupted"] = record.interrupted;
  json["duration_s"] = duration;
  json["path_length_m"] = record.path_length_m;
  json["lost_frames"] = lost;
  json["lost"] = record.lost;
  Json landmarks = {{"pillar", 0}, {"floor_edge", 0}, {"depth_slope", 0}};
  for (const LandmarkRecord& landmark : baseline.landmarks())
    landmarks[name(landmark.kind)] = landmarks[name(landmark.kind)].get<int>() + 1;
  json["landmarks"] = landmarks;
  json["figures"] = baseline.figures();
  json["timing_ms"] = {{"frame", timingJson(record.frame_ms)},
                       {"read", timingJson(record.read_ms)},
                       {"map", timingJson(record.map_ms)}};
  json["peak_rss_mb"] = record.peak_rss_mb;
  json["damage"] = {{"ending", name(damage.ending)},
                    {"entries_read", damage.entries_read},
                    {"detail", damage.detail},
                    {"skipped", damage.skipped}};
  return json;
}

std::uintmax_t sizeOf(const fs::path& file) { return fs::exists(file) ? fs::file_size(file) : 0; }

std::string describe(const Json& json) {
  std::string text = formatFixed(json["duration_s"], 1) + " s, path " +
                     formatFixed(json["path_length_m"], 2) + " m, " +
                     std::to_string(json["frames_processed"].get<std::size_t>()) + " frames, " +
                     std::to_string(json["lost_frames"].get<std::size_t>()) + " lost, " +
                     formatFixed(json["timing_ms"]["frame"]["median"], 1) +
                     " ms a frame (median), " + formatFixed(json["peak_rss_mb"], 0) + " MB";
  if (json.contains("trajectory"))
    text += "; ATE " + formatFixed(json["trajectory"]["ate_rmse_m"], 3) + " m, heading " +
            formatFixed(json["trajectory"]["heading_rmse_deg"], 2) + " degrees";
  return text;
}

ExitCode run(const Arguments& arguments) {
  cv::setNumThreads(1);  // as `run`, so that times compare
  Options options = readOptions(arguments);
  Trajectory truth;
  if (!arguments.ground_truth.empty()) truth = readTum(arguments.ground_truth);
  const auto baseline = makeBaseline(arguments.method, options.baseline);
  RawlogSource source(arguments.log, options.run.source);

  const Record record = follow(source, *baseline);
  if (record.trajectory.empty())
    throw Error(arguments.log.string() + ": no frames; see: colonnade inspect " +
                arguments.log.string());
  const fs::path folder = makeResultsFolder(arguments.output, arguments.log);
  ConfigWriter writer;
  options.each([&](const auto& section) { writer.add(section); });
  writeFileAtomically(folder / "config.ini", writer.text());
  writeTum(folder / "trajectory.tum", record.trajectory);
  if (!arguments.no_map_files) baseline->writeMap(folder);
  if (const LandmarkMap landmarks = baseline->landmarks(); !landmarks.empty())
    writeLandmarksCsv(folder / "landmarks.csv", landmarks);

  Json json = summarize(arguments, record, *baseline, source.damage());
  const auto map_bytes = sizeOf(folder / "map.ply") + sizeOf(folder / "landmarks.csv");
  if (map_bytes > 0) json["map_bytes"] = map_bytes;
  std::string not_scored;
  if (!arguments.ground_truth.empty()) {
    try {
      json["trajectory"] = toJson(evaluateTrajectory(record.trajectory, truth));
    } catch (const Error& error) {
      not_scored = error.what();
    }
  }
  writeFileAtomically(folder / "summary.json",
                      json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  std::printf("%-10s %s\nresults    %s\n", arguments.method.c_str(), describe(json).c_str(),
              folder.c_str());
  for (const std::string& note : source.notes())
    std::fprintf(stderr, "%s: %s\n", arguments.log.c_str(), note.c_str());
  if (!source.damage().detail.empty())
    std::fprintf(stderr, "%s: %s\n", arguments.log.c_str(), source.damage().detail.c_str());
  if (!not_scored.empty())
    std::fprintf(stderr, "%s: not scored: %s\n", arguments.log.c_str(), not_scored.c_str());
  if (record.interrupted) return ExitCode::kInterrupted;
  if (!not_scored.empty()) return ExitCode::kFailed;
  return source.damage().any() ? ExitCode::kLossy : ExitCode::kDone;
}

}  // namespace

Action addBaseline(CLI::App& verb) {
  const auto arguments = std::make_shared<Arguments>();
  verb.add_option("METHOD", arguments->method, joined(baselineNames(), ", "))
      ->required()
      ->check(CLI::IsMember(baselineNames()));
  verb.add_option("LOG", arguments->log, "rawlog, plain or gz")->required();
  verb.add_option("-c,--config", arguments->config, "INI file; that of a run serves too");
  verb.add_option("-o,--output", arguments->output, "new folder; default: LOG's stem + _results");
  verb.add_option("--ground-truth", arguments->ground_truth, "robot poses, TUM file: adds a score");
  verb.add_option("--set", arguments->assignments, "Section.key=value, wins over the file")
      ->allow_extra_args(false);
  verb.add_flag("--no-map-files", arguments->no_map_files,
                "build the point map, but do not write map.ply");
  verb.footer(
      "Examples:\n"
      "  colonnade baseline kinect-3d-slam corridor.rawlog --set KinectSlam.subpixel=true\n"
      "  colonnade baseline difodo corridor.rawlog -o difodo --ground-truth truth.tum\n"
      "  colonnade baseline kf-slam corridor.rawlog --set KfSlam.update=davison\n"
      "  colonnade baseline dead-reckoning corridor.rawlog");
  return [arguments] { return run(*arguments); };
}

}  // namespace colonnade
