// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "summary.hpp"

#include <algorithm>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/evaluation/consistency.hpp"
#include "colonnade/evaluation/score_json.hpp"
#include "measured.hpp"

namespace colonnade {
namespace {

using Json = nlohmann::ordered_json;

template <class Stage>
Json statistics(const std::vector<StageTimes>& times, Stage stage) {
  std::vector<double> values;
  for (const StageTimes& t : times) values.push_back(stage(t));
  return timingJson(values);
}

/// A learnt error of the sensor is surer than it was beforehand.
constexpr double kLearnt = 0.9;

std::string sensorText(const Json& sensor) {
  std::vector<std::string> learnt;
  const auto add = [&](const char* key, const char* name, double unit, int digits, const char* of) {
    const Json& error = sensor[key];
    const double sigma = error["sigma"];
    if (sigma < kLearnt * error["sigma_beforehand"].get<double>())
      learnt.push_back(std::string(name) + " " +
                       formatFixed(unit * error["estimate"].get<double>(), digits) + " +- " +
                       formatFixed(unit * sigma, digits) + of);
  };
  add("range_offset_m", "range offset", 1.0, 3, " m");
  add("range_scale", "range scale", 100.0, 1, " %");
  add("range_skew", "range skew", 100.0, 1, " % a radian");
  add("bearing_offset", "bearing offset", degrees(1.0), 1, " degrees");
  add("bearing_scale", "bearing scale", 100.0, 1, " %");
  return learnt.empty() ? "nothing learnt of its errors" : joined(learnt, ", ");
}

/// The most frequent source of motion; the counts stand beside it.
std::string mainSource(const std::map<std::string, std::size_t>& sources) {
  const auto most = std::max_element(sources.begin(), sources.end(),
                                     [](auto& a, auto& b) { return a.second < b.second; });
  return most == sources.end() ? "none" : most->first;
}

Json countLandmarks(const LandmarkMap& landmarks) {
  const auto count = [&](LandmarkKind kind) {
    return std::count_if(landmarks.begin(), landmarks.end(),
                         [&](const auto& record) { return record.kind == kind; });
  };
  const auto paired = std::count_if(landmarks.begin(), landmarks.end(),
                                    [](const auto& record) { return record.pair_id.has_value(); });
  return {{"pillar", count(LandmarkKind::kPillarEdge)},
          {"pillar_pairs", paired / 2},
          {"floor_edge", count(LandmarkKind::kFloorEdge)},
          {"depth_slope", count(LandmarkKind::kDepthSlope)}};
}

/// The mean per degree of freedom and where 95 % of honest, independent innovations would put it.
Json nisOf(const InnovationHealth& health, LandmarkKind kind) {
  const std::size_t dof = health.degreesOfFreedom(kind);
  Json json = {{"mean", nullptr}, {"count", health.accepted(kind)}, {"dof", dof}};
  json["band_95"] = nullptr;
  if (dof == 0) return json;
  const Band band = consistencyBand(1, dof);
  json["mean"] = health.meanNis(kind);
  json["band_95"] = {band.low, band.high};
  return json;
}

}  // namespace

Json toJson(const RunSummary& summary, const RunRecorder& recorder,
            const InnovationHealth& health) {
  const auto& times = recorder.times();
  Json json;
  json["frames"] = summary.frames;
  json["frames_processed"] = summary.frames_processed;
  json["interrupted"] = summary.interrupted;
  json["duration_s"] = recorder.duration();
  json["path_length_m"] = recorder.pathLength();
  json["motion_source"] = mainSource(recorder.motionSources());
  json["motion_sources"] = recorder.motionSources();
  json["landmarks"] = countLandmarks(summary.landmarks);
  json["axes"] = summary.axes;
  json["loop_closings"] = 0;
  if (summary.score) {
    json["trajectory"] = toJson(*summary.score);
  }
  if (summary.final_score) json["trajectory_final"] = toJson(*summary.final_score);
  json["timing_ms"] = {
      {"frame", statistics(times, [](const StageTimes& t) { return t.frame(); })},
      {"read", statistics(times, [](const StageTimes& t) { return t.read; })},
      {"motion", statistics(times, [](const StageTimes& t) { return t.motion; })},
      {"edges", statistics(times, [](const StageTimes& t) { return t.edges; })},
      {"detectors", statistics(times, [](const StageTimes& t) { return t.detectors; })},
      {"filter", statistics(times, [](const StageTimes& t) { return t.filter; })}};
  json["realtime_factor"] =
      summary.wall_seconds > 0.0 ? recorder.duration() / summary.wall_seconds : 0.0;
  json["peak_rss_mb"] = peakResidentMegabytes();
  for (const LandmarkKind kind :
       {LandmarkKind::kPillarEdge, LandmarkKind::kFloorEdge, LandmarkKind::kDepthSlope}) {
    json["nis_mean"][colonnade::name(kind)] = health.meanNis(kind);
    json["nis"][colonnade::name(kind)] = nisOf(health, kind);
  }
  json["refused"] = health.refused();
  json["damage"] = {
      {"ending", name(summary.damage.ending)}, {"entries_read", summary.damage.entries_read},
      {"entry", summary.damage.ending_entry},  {"offset", summary.damage.ending_offset},
      {"detail", summary.damage.detail},       {"skipped", summary.damage.skipped}};
  json["left_out"] = summary.maps.left_out;
  return json;
}

std::string toText(const Json& json) {
  const auto count = [&](const char* kind) {
    return std::to_string(json["landmarks"][kind].get<std::size_t>());
  };
  std::string text;
  text += "frames     " + std::to_string(json["frames_processed"].get<std::size_t>()) + " of " +
          std::to_string(json["frames"].get<std::size_t>()) + ", " +
          formatFixed(json["duration_s"], 1) + " s, path " + formatFixed(json["path_length_m"], 2) +
          " m\n";
  text += "motion     " + json["motion_source"].get<std::string>() + "\n";
  text += "landmarks  " + count("pillar") + " pillar edges (" + count("pillar_pairs") +
          " pairs), " + count("floor_edge") + " floor edges, " + count("depth_slope") +
          " depth-slope corners, " + std::to_string(json["axes"].get<std::size_t>()) +
          " building axes\n";
  if (const auto pointer = "/smoothing/landmarks_merged"_json_pointer;
      json.contains(pointer) && !json[pointer].empty())
    text += "merged     landmarks founded twice: " + std::to_string(json[pointer].size()) + "\n";
  if (json.contains("sensor")) text += "sensor     " + sensorText(json["sensor"]) + "\n";
  if (const int closings = json["loop_closings"].get<int>(); closings > 0)
    text += "loops      " + std::to_string(closings) + " closed\n";
  text += "time       " + formatFixed(json["timing_ms"]["frame"]["median"], 1) +
          " ms a frame (median), " + formatFixed(json["timing_ms"]["frame"]["p95"], 1) +
          " ms (95 %), " + formatFixed(json["realtime_factor"], 1) + " times real time, " +
          formatFixed(json["peak_rss_mb"], 0) + " MB\n";
  if (json.contains("trajectory"))
    text += "accuracy   ATE " + formatFixed(json["trajectory"]["ate_rmse_m"], 3) + " m (" +
            json["trajectory"]["alignment"].get<std::string>() + "-aligned, no scale), heading " +
            formatFixed(json["trajectory"]["heading_rmse_deg"], 2) + " degrees, coverage " +
            formatFixed(100.0 * json["trajectory"]["coverage"].get<double>(), 0) + " %\n";
  if (json.contains("trajectory_final"))
    text += "afterwards ATE " + formatFixed(json["trajectory_final"]["ate_rmse_m"], 3) +
            " m, heading " + formatFixed(json["trajectory_final"]["heading_rmse_deg"], 2) +
            " degrees\n";
  return text;
}

}  // namespace colonnade
