// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/frames/log_inspection.hpp"
#include "progress.hpp"
#include "verbs.hpp"

namespace colonnade {
namespace {

using Json = nlohmann::ordered_json;

double pitch(const CameraSummary& camera) {
  return -std::asin(std::clamp(camera.T_robot_camera.linear()(2, 2), -1.0, 1.0));
}

double roll(const CameraSummary& camera) {
  const auto& R = camera.T_robot_camera.linear();
  return std::atan2(-R(2, 0), -R(2, 1));
}

Json toJson(const CameraSummary& camera) {
  const auto& c = camera.calibration;
  return {{"width_px", camera.width_px},
          {"height_px", camera.height_px},
          {"calibrated", c.isCalibrated()},
          {"calibration_width_px", c.width_px},
          {"calibration_height_px", c.height_px},
          {"fx_px", c.fx_px},
          {"fy_px", c.fy_px},
          {"cx_px", c.cx_px},
          {"cy_px", c.cy_px},
          {"distorted", camera.distorted},
          {"height_m", camera.T_robot_camera.translation().z()},
          {"pitch_deg", degrees(pitch(camera))},
          {"roll_deg", degrees(roll(camera))}};
}

Json toJson(const SensorSummary& sensor) {
  Json json{{"label", sensor.label},
            {"class", sensor.class_name},
            {"count", sensor.count},
            {"first_s", sensor.first_s},
            {"last_s", sensor.last_s},
            {"rate_hz", sensor.rate_hz()},
            {"invalid_stamps", sensor.invalid_stamps},
            {"not_growing_stamps", sensor.not_growing_stamps},
            {"gaps", sensor.gap_count},
            {"longest_gaps", Json::array()}};
  for (const auto& gap : sensor.longest_gaps)
    json["longest_gaps"].push_back({{"start_s", gap.start_s}, {"length_s", gap.length_s}});
  if (sensor.colour) json["colour"] = toJson(*sensor.colour);
  if (sensor.depth) {
    json["depth"] = toJson(*sensor.depth);
    json["depth"]["metres_per_unit"] = sensor.depth_unit_m;
    json["depth"]["along_optical_axis"] = sensor.depth_along_axis;
  }
  return json;
}

Json toJson(const Damage& damage) {
  return {{"ending", name(damage.ending)}, {"entries_read", damage.entries_read},
          {"entry", damage.ending_entry},  {"offset", damage.ending_offset},
          {"detail", damage.detail},       {"skipped", damage.skipped}};
}

Json toJson(const LogInspection& log, const std::string& path) {
  Json json{{"log", path},
            {"file_bytes", log.file_bytes},
            {"log_bytes", log.log_bytes},
            {"compressed", log.compressed},
            {"format", log.format()},
            {"sensory_frames", log.sensory_frames},
            {"action_collections", log.action_collections},
            {"loose_observations", log.loose_observations},
            {"motions", log.motions},
            {"odometry", log.hasOdometry()},
            {"first_s", nullptr},
            {"last_s", nullptr},
            {"sensors", Json::array()},
            {"damage", toJson(log.damage)}};
  if (log.first_s) json["first_s"] = *log.first_s;
  if (log.last_s) json["last_s"] = *log.last_s;
  for (const auto& sensor : log.sensors) json["sensors"].push_back(toJson(sensor));
  return json;
}

std::string megabytes(std::uint64_t bytes) {
  return formatFixed(static_cast<double>(bytes) / 1e6, 1) + " MB";
}

void print(const char* what, const CameraSummary& camera, const std::string& more) {
  const auto& c = camera.calibration;
  std::string line = std::to_string(camera.width_px) + "x" + std::to_string(camera.height_px);
  if (c.isCalibrated())
    line += ", fx " + formatDouble(c.fx_px, 6) + " fy " + formatDouble(c.fy_px, 6) + " cx " +
            formatDouble(c.cx_px, 6) + " cy " + formatDouble(c.cy_px, 6) +
            (camera.distorted ? ", lens distortion" : "");
  else
    line += ", NOT CALIBRATED (run needs --set Camera.fx_px=... fy_px, cx_px, cy_px)";
  if (c.isCalibrated() && (c.width_px != camera.width_px || c.height_px != camera.height_px))
    line += " for " + std::to_string(c.width_px) + "x" + std::to_string(c.height_px);
  line += ", " + formatFixed(camera.T_robot_camera.translation().z(), 3) + " m above the floor" +
          ", pitch " + formatFixed(degrees(pitch(camera)), 2) + " deg, roll " +
          formatFixed(degrees(roll(camera)), 2) + " deg";
  std::printf("      %-7s %s%s\n", what, line.c_str(), more.c_str());
}

void print(const SensorSummary& sensor) {
  std::printf(
      "  %-16s %-26s %8zu %9s Hz  %s\n", sensor.label.empty() ? "(no label)" : sensor.label.c_str(),
      sensor.class_name.c_str(), sensor.count, formatFixed(sensor.rate_hz(), 2).c_str(),
      sensor.gap_count == 0 ? "no gaps" : (std::to_string(sensor.gap_count) + " gaps").c_str());
  if (sensor.colour) print("image", *sensor.colour, "");
  if (sensor.depth)
    print("depth", *sensor.depth,
          ", unit " + formatDouble(sensor.depth_unit_m, 4) + " m" +
              (sensor.depth_along_axis ? "" : ", along the ray"));
  for (const auto& gap : sensor.longest_gaps)
    std::printf("      gap     %s s after %s\n", formatFixed(gap.length_s, 3).c_str(),
                formatFixed(gap.start_s, 6).c_str());
  if (sensor.gap_count > sensor.longest_gaps.size())
    std::printf("      gap     and %zu shorter ones\n",
                sensor.gap_count - sensor.longest_gaps.size());
  if (sensor.invalid_stamps > 0) std::printf("      stamps  %zu invalid\n", sensor.invalid_stamps);
  if (sensor.not_growing_stamps > 0)
    std::printf("      stamps  %zu repeat or go back\n", sensor.not_growing_stamps);
}

void print(const LogInspection& log, const std::string& path) {
  std::printf("%s: %s%s\n", path.c_str(), megabytes(log.file_bytes).c_str(),
              log.compressed ? (" gz, " + megabytes(log.log_bytes) + " inflated").c_str() : "");
  std::printf("format   %s: %zu sensory frames, %zu action collections, %zu loose observations\n",
              log.format(), log.sensory_frames, log.action_collections, log.loose_observations);
  if (log.first_s && log.last_s)
    std::printf("time     %s to %s s, %s s\n", formatFixed(*log.first_s, 6).c_str(),
                formatFixed(*log.last_s, 6).c_str(),
                formatFixed(*log.last_s - *log.first_s, 3).c_str());
  std::printf("odometry %s\n", log.motions > 0 ? (std::to_string(log.motions) + " motions").c_str()
                               : log.hasOdometry() ? "observations"
                                                   : "none");
  std::printf("sensors\n");
  for (const auto& sensor : log.sensors) print(sensor);
  const auto& damage = log.damage;
  if (damage.ending == LogEnding::kEnd)
    std::printf("ends     whole, %zu entries\n", damage.entries_read);
  else
    std::printf("ends     %s at entry %zu, byte %llu of the inflated log: %s\n",
                damage.ending == LogEnding::kCut ? "CUT" : "DAMAGED", damage.ending_entry,
                static_cast<unsigned long long>(damage.ending_offset), damage.detail.c_str());
  for (const auto& [reason, count] : damage.skipped)
    std::printf("lost     %zu x %s\n", count, reason.c_str());
}

ExitCode inspect(const std::string& path, bool json) {
  Progress progress;
  const auto log = inspectLog(path, [&](double share, std::size_t entries) {
    progress.show(share, entries, "inspecting");
  });
  progress.finish();
  if (json)
    std::printf("%s\n",
                toJson(log, path).dump(2, ' ', false, Json::error_handler_t::replace).c_str());
  else
    print(log, path);
  return log.damage.any() ? ExitCode::kLossy : ExitCode::kDone;
}

}  // namespace

Action addInspect(CLI::App& verb) {
  const auto path = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  verb.footer(
      "Examples:\n"
      "  colonnade inspect corridor.rawlog\n"
      "  colonnade inspect corridor.rawlog --json\n"
      "Exit code 3: the log is cut or damaged, or parts of it cannot be read.");
  verb.add_option("log", *path, "rawlog, plain or gz")->required();
  verb.add_flag("--json", *json, "print one JSON object instead of a table");
  return [path, json] { return inspect(*path, *json); };
}

}  // namespace colonnade
