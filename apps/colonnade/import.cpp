// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/frames/tum_import.hpp"
#include "progress.hpp"
#include "verbs.hpp"

namespace colonnade {
namespace {

struct TumArguments {
  TumImportOptions options;
  std::string calibration_file, intrinsics, ground_truth;
  std::string world = "guess";
  double depth_scale = 0.0, height_m = 0.0, pitch_deg = 0.0, roll_deg = 0.0;
};

TumCalibration parseIntrinsics(const std::string& text) {
  const auto numbers = fields(text, ',');
  TumCalibration calibration;
  double* const targets[] = {&calibration.fx_px, &calibration.fy_px, &calibration.cx_px,
                             &calibration.cy_px};
  bool sound = numbers.size() == std::size(targets);
  for (std::size_t i = 0; sound && i < numbers.size(); ++i) {
    const auto value = parseDouble(numbers[i]);
    sound = value && std::isfinite(*value) && *value > 0.0;
    if (sound) *targets[i] = *value;
  }
  if (!sound)
    throw Error("--intrinsics " + text + ": expected four positive numbers fx,fy,cx,cy in pixels",
                ExitCode::kUsage);
  return calibration;
}

void report(const TumImportResult& result, const TumImportOptions& options) {
  const auto& T = result.T_robot_camera;
  const double pitch = -std::asin(std::clamp(T.linear()(2, 2), -1.0, 1.0));
  const double roll = std::atan2(-T.linear()(2, 0), -T.linear()(2, 1));
  std::cout << options.log.string() << ": " << result.frames << " frames, depth unit 1/"
            << formatDouble(result.depth_units_per_metre) << " m\n"
            << "camera " << formatFixed(T.translation().z(), 3) << " m above the floor, pitch "
            << formatFixed(degrees(pitch), 2) << " deg (positive looks down), roll "
            << formatFixed(degrees(roll), 2) << " deg"
            << (result.mounting_from_floor ? ", from the floor in the first depth images" : "")
            << "\n";
  if (result.ground_truth)
    std::cout << result.ground_truth->string() << ": " << result.ground_truth_poses
              << " poses, world "
              << (result.ground_truth_world == GroundTruthWorld::kZUp ? "z-up" : "first camera")
              << " in the source\n";
  if (result.colour_without_depth + result.depth_without_colour > 0)
    std::cout << "without a partner within 0.02 s: " << result.colour_without_depth << " colour, "
              << result.depth_without_colour << " depth\n";
  for (const auto& [reason, count] : result.skipped)
    std::cout << "lost: " << count << " x " << reason << "\n";
}

Action addTum(CLI::App& verb) {
  auto arguments = std::make_shared<TumArguments>();
  auto& a = *arguments;
  verb.add_option("DIR", a.options.folder, "folder with rgb.txt and depth.txt")->required();
  verb.add_option("-o,--output", a.options.log, "the rawlog to write")->required();
  verb.add_option(
      "--calibration", a.calibration_file,
      "lines `fx 525`, fy, cx, cy, depth_units_per_metre (default: DIR/calibration.txt)");
  verb.add_option("--intrinsics", a.intrinsics, "fx,fy,cx,cy in pixels")->excludes("--calibration");
  verb.add_option("--depth-scale", a.depth_scale,
                  "depth units per metre (default: the calibration's, else 5000)")
      ->check(CLI::PositiveNumber);
  verb.add_option("--camera-height", a.height_m, "metres above the floor (default: floor fit)")
      ->check(CLI::PositiveNumber);
  verb.add_option("--camera-pitch-deg", a.pitch_deg, "positive looks down (default: floor fit)")
      ->check(CLI::Range(-80.0, 80.0));
  verb.add_option("--camera-roll-deg", a.roll_deg,
                  "positive lowers the right side (default: floor fit)")
      ->check(CLI::Range(-180.0, 180.0));
  verb.add_option("--ground-truth", a.ground_truth,
                  "camera poses, TUM format (default: DIR/groundtruth.txt or DIR/reference.tum)");
  verb.add_option("--ground-truth-world", a.world, "world of the ground truth")
      ->check(CLI::IsMember({"guess", "z-up", "first-camera"}));
  verb.footer(
      "Examples:\n"
      "  colonnade import tum rgbd_dataset_freiburg3 -o fr3.rawlog --intrinsics "
      "535.4,539.2,320.1,247.6\n"
      "  colonnade import tum corridor -o corridor.rawlog --camera-height 1.2 --camera-pitch-deg 8 "
      "--camera-roll-deg 0");
  CLI::App* const app = &verb;
  return [arguments, app] {
    auto& options = arguments->options;
    if (!arguments->calibration_file.empty())
      options.calibration = readTumCalibration(arguments->calibration_file);
    if (!arguments->intrinsics.empty())
      options.calibration = parseIntrinsics(arguments->intrinsics);
    if (app->count("--depth-scale") > 0) options.depth_units_per_metre = arguments->depth_scale;
    if (app->count("--camera-height") > 0) options.camera_height_m = arguments->height_m;
    if (app->count("--camera-pitch-deg") > 0) options.camera_pitch = radians(arguments->pitch_deg);
    if (app->count("--camera-roll-deg") > 0) options.camera_roll = radians(arguments->roll_deg);
    if (!arguments->ground_truth.empty()) options.ground_truth = arguments->ground_truth;
    if (arguments->world == "z-up") options.ground_truth_world = GroundTruthWorld::kZUp;
    if (arguments->world == "first-camera")
      options.ground_truth_world = GroundTruthWorld::kFirstCamera;
    if (std::filesystem::exists(options.log))
      throw Error(options.log.string() + ": exists; give -o a new name", ExitCode::kUsage);
    Progress progress;
    options.progress = [&progress](std::size_t done, std::size_t all) {
      progress.show(static_cast<double>(done) / static_cast<double>(all), done, "importing");
    };
    const auto result = importTum(options);
    progress.finish();
    report(result, options);
    return result.skipped.empty() ? ExitCode::kDone : ExitCode::kLossy;
  };
}

}  // namespace

Action addImport(CLI::App& verb) {
  verb.require_subcommand(1);
  auto* const tum = verb.add_subcommand("tum", "folder of the TUM RGB-D benchmark to rawlog");
  return addTum(*tum);
}

}  // namespace colonnade
