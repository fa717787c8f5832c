// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "compare_result.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/base/trajectory.hpp"
#include "colonnade/maps/landmark_csv.hpp"

namespace colonnade {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr double kLeastCoverage = 0.90;
constexpr double kGreatestError = 0.10;  ///< of the true path
constexpr double kSmallError_m = 0.10;   ///< never a failure, however short the path

const Json* find(const Json& json, std::initializer_list<const char*> keys) {
  const Json* at = &json;
  for (const char* key : keys) {
    if (!at->is_object() || !at->contains(key)) return nullptr;
    at = &at->at(key);
  }
  return at;
}

void take(std::map<std::string, double>& figures, const std::string& name, const Json& summary,
          std::initializer_list<const char*> keys) {
  const Json* value = find(summary, keys);
  if (value && value->is_number()) figures[name] = value->get<double>();
}

/// Frames whose motion nothing measured: the last pose or the former velocity stands in.
double lostFrames(const Json& summary) {
  if (const Json* lost = find(summary, {"lost_frames"})) return lost->get<double>();
  const Json* coasting = find(summary, {"motion_sources", "constant_velocity"});
  return coasting ? coasting->get<double>() : 0.0;
}

void takeLandmarks(std::map<std::string, double>& figures, const fs::path& file, double frames) {
  if (!fs::exists(file)) return;
  double seen = 0.0;
  const LandmarkMap map = readLandmarksCsv(file);
  for (const LandmarkRecord& landmark : map) seen += landmark.observations;
  figures["landmarks"] = static_cast<double>(map.size());
  if (frames > 0.0) figures["landmarks_per_frame"] = seen / frames;
}

std::map<std::string, double> figuresOf(const Json& summary, const fs::path& folder) {
  std::map<std::string, double> figures;
  take(figures, "frames", summary, {"frames_processed"});
  take(figures, "path_length_m", summary, {"path_length_m"});
  take(figures, "ate_m", summary, {"trajectory", "ate_rmse_m"});
  take(figures, "rpe_1m_percent", summary, {"trajectory", "rpe_1m_percent"});
  take(figures, "drift_percent", summary, {"trajectory", "end_drift_percent"});
  take(figures, "heading_deg", summary, {"trajectory", "heading_rmse_deg"});
  take(figures, "true_path_length_m", summary, {"trajectory", "path_length_m"});
  take(figures, "frame_ms_median", summary, {"timing_ms", "frame", "median"});
  take(figures, "frame_ms_p95", summary, {"timing_ms", "frame", "p95"});
  take(figures, "map_ms_median", summary, {"timing_ms", "map", "median"});
  take(figures, "peak_rss_mb", summary, {"peak_rss_mb"});
  take(figures, "map_bytes", summary, {"map_bytes"});
  take(figures, "points", summary, {"figures", "map_points"});
  take(figures, "points_per_frame", summary, {"figures", "pairs_per_frame"});
  const double frames = figures.contains("frames") ? figures["frames"] : 0.0;
  figures["lost_frames"] = lostFrames(summary);
  takeLandmarks(figures, folder / "landmarks.csv", frames);
  if (!figures.contains("map_bytes") && fs::exists(folder / "landmarks.csv"))
    figures["map_bytes"] = static_cast<double>(fs::file_size(folder / "landmarks.csv"));
  // Poses that only repeat or extrapolate the last one cover nothing.
  if (const Json* coverage = find(summary, {"trajectory", "coverage"});
      coverage && coverage->is_number() && frames > 0.0)
    figures["coverage"] = coverage->get<double>() * (1.0 - figures["lost_frames"] / frames);
  return figures;
}

bool isFinite(const fs::path& trajectory) {
  const Trajectory poses = readTum(trajectory);
  return !poses.empty() && std::all_of(poses.begin(), poses.end(), [](const StampedPose& pose) {
    return pose.T_world_body.matrix().allFinite();
  });
}

std::string judge(const std::map<std::string, double>& figures, const fs::path& folder) {
  try {
    if (!isFinite(folder / "trajectory.tum")) return "its trajectory is not finite";
  } catch (const Error& error) {
    return error.what();
  }
  const double frames = figures.contains("frames") ? figures.at("frames") : 0.0;
  const double tracked = frames > 0.0 ? 1.0 - figures.at("lost_frames") / frames : 0.0;
  const double covered = figures.contains("coverage") ? figures.at("coverage") : tracked;
  if (covered < kLeastCoverage) return "covers " + formatFixed(100.0 * covered, 0) + " %";
  if (!figures.contains("ate_m")) return "";
  const double path =
      figures.contains("true_path_length_m") ? figures.at("true_path_length_m") : 0.0;
  const double ate = figures.at("ate_m");
  if (!(ate <= std::max(kSmallError_m, kGreatestError * path)))
    return "ATE " + formatFixed(100.0 * ate / path, 0) + " % of the path";
  return "";
}

}  // namespace

std::size_t MethodOutcome::failures() const {
  return static_cast<std::size_t>(std::count_if(
      runs.begin(), runs.end(), [](const RunOutcome& run) { return !run.failure.empty(); }));
}

std::vector<double> MethodOutcome::values(const std::string& figure) const {
  std::vector<double> values;
  for (const RunOutcome& run : runs)
    if (const auto value = run.figures.find(figure); value != run.figures.end())
      values.push_back(value->second);
  std::sort(values.begin(), values.end());
  return values;
}

std::string failureRule() {
  return "A run FAILED when it crashed, ran out of time or left no finite trajectory; when less "
         "than " +
         formatFixed(100.0 * kLeastCoverage, 0) +
         " % of the truth's time (without truth: of the frames) has a pose of its own, not a "
         "repeated or extrapolated one; or when its ATE is above " +
         formatFixed(100.0 * kGreatestError, 0) + " % of the true path (and above " +
         formatFixed(kSmallError_m, 1) +
         " m). A method FAILED when more than half of its runs did.";
}

RunOutcome outcomeOf(const JobResult& job, const fs::path& folder, const fs::path& log) {
  RunOutcome outcome;
  const bool ended = job.status == JobResult::Status::kExited;
  const bool done = ended && (job.exit_code == static_cast<int>(ExitCode::kDone) ||
                              job.exit_code == static_cast<int>(ExitCode::kLossy));
  const std::string said = lastLineOf(log);
  if (!done) outcome.failure = job.text() + (said.empty() ? "" : ": " + said);
  if (done && job.exit_code == static_cast<int>(ExitCode::kLossy)) outcome.remark = said;
  std::ifstream file(folder / "summary.json");
  const Json summary = Json::parse(file, nullptr, false);
  if (!summary.is_object()) {
    if (outcome.failure.empty()) outcome.failure = "left no summary.json";
    return outcome;
  }
  outcome.figures = figuresOf(summary, folder);
  outcome.figures["wall_s"] = job.wall_s;
  outcome.figures["cpu_s"] = job.cpu_s;
  if (outcome.failure.empty()) outcome.failure = judge(outcome.figures, folder);
  return outcome;
}

}  // namespace colonnade
