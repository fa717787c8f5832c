// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/log_path.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/frames/mrclam_import.hpp"
#include "colonnade/frames/tum_import.hpp"
#include "colonnade/maps/landmark_csv.hpp"
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

struct MrclamArguments {
  MrclamImportOptions options;
  double bearing_sigma_deg = degrees(MrclamImportOptions{}.bearing_sigma);
  bool as_recorded = false;
};

LandmarkMap truthOf(const MrclamImportResult& result) {
  LandmarkMap map;
  for (const MrclamLandmark& landmark : result.landmarks) {
    LandmarkRecord record;
    record.id = LandmarkId{landmark.subject};
    record.p_world = record.extent_a = record.extent_b = landmark.p_world;
    record.covariance.diagonal() = landmark.sigma.cwiseAbs2();
    record.observations = static_cast<int>(landmark.readings);
    map.push_back(record);
  }
  std::sort(map.begin(), map.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return map;
}

void report(const MrclamImportResult& result, const MrclamImportOptions& options,
            const std::string& landmark_file) {
  const auto& noise = options.odometry;
  const auto& c = options.calibration;
  std::size_t of_robots = 0;
  for (const auto& [subject, count] : result.robot_readings) of_robots += count;
  std::cout << options.log.string() << ": " << result.frames
            << " action and sensory-frame pairs, one for each measurement stamp, "
            << result.readings << " readings of landmarks, way by odometry "
            << formatFixed(result.path_m, 1) << " m\n"
            << "motion     " << formatDouble(c.drive_delay_s) << " s after the command, "
            << formatDouble(c.speed_gain) << " of its speed less " << formatDouble(c.slowed_by_turn)
            << " m for a radian of turn, " << formatDouble(c.turn_gain) << " of its turn ("
            << formatDouble(c.turn_gain_on_spot) << " on the spot) once it has run up "
            << formatDouble(c.breakaway_on_the_way) << " rad ("
            << formatDouble(c.breakaway_on_spot) << ")\n"
            << "ranges     "
            << (c.range_is_depth ? "from depths along the optical axis, read as " : "read as ")
            << formatDouble(c.depth_offset_m) << " m + " << formatDouble(c.depth_gain)
            << " times; stamped " << formatDouble(c.camera_delay_s) << " s after the image\n"
            << "sigmas     range " << formatDouble(options.range_sigma_m) << " m, bearing "
            << formatDouble(degrees(options.bearing_sigma), 6) << " deg; odometry along "
            << formatDouble(noise.along_m) << " m and across " << formatDouble(noise.across_m)
            << " m after 1 m, heading " << formatDouble(degrees(noise.heading), 6)
            << " deg after 1 m and " << formatDouble(degrees(noise.turn), 6) << " deg after 1 rad\n"
            << "dropped    " << of_robots << " readings of moving robots (subjects 1 to 5";
  for (const auto& [subject, count] : result.robot_readings)
    std::cout << ", " << subject << ": " << count;
  std::cout << ")\n";
  for (const auto& [barcode, count] : result.unknown_barcodes)
    std::cout << "dropped    " << count << " readings of barcode " << barcode
              << ", which Barcodes.dat does not know\n";
  if (result.bad_ranges > 0)
    std::cout << "dropped    " << result.bad_ranges << " readings whose range is not positive\n";
  std::cout << result.ground_truth.string() << ": " << result.ground_truth_poses << " poses\n"
            << landmark_file << ": " << result.landmarks.size() << " landmarks\n";
}

Action addMrclam(CLI::App& verb) {
  auto arguments = std::make_shared<MrclamArguments>();
  auto& options = arguments->options;
  verb.add_option("DIR", options.folder,
                  "folder with Barcodes.dat, Landmark_Groundtruth.dat, RobotN_*.dat")
      ->required();
  verb.add_option("--robot", options.robot, "whose log")->required()->check(CLI::Range(1, 5));
  verb.add_option("-o,--output", options.log, "the rawlog to write")->required();
  verb.add_option("--range-sigma", options.range_sigma_m, "metres, written into the observations")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb.add_option("--bearing-sigma-deg", arguments->bearing_sigma_deg,
                  "degrees, written into the observations")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb.add_flag("--as-recorded", arguments->as_recorded,
                "take commands for motion and barcode heights for ranges, as the files have them");
  verb.footer(
      "Examples:\n"
      "  colonnade import mrclam MRCLAM_Dataset7 --robot 3 -o robot3.rawlog\n"
      "  colonnade run robot3.rawlog --ground-truth robot3_ground_truth.tum");
  return [arguments] {
    auto& chosen = arguments->options;
    chosen.bearing_sigma = radians(arguments->bearing_sigma_deg);
    if (arguments->as_recorded) chosen.calibration = MrclamCalibration::asRecorded();
    if (std::filesystem::exists(chosen.log))
      throw Error(chosen.log.string() + ": exists; give -o a new name", ExitCode::kUsage);
    Progress progress;
    chosen.progress = [&progress](std::size_t done, std::size_t all) {
      progress.show(static_cast<double>(done) / static_cast<double>(all), done, "importing");
    };
    const auto result = importMrclam(chosen);
    progress.finish();
    const std::string landmark_file = logStem(chosen.log).string() + "_landmarks.csv";
    writeLandmarksCsv(landmark_file, truthOf(result));
    report(result, chosen, landmark_file);
    return ExitCode::kDone;
  };
}

}  // namespace

Action addImport(CLI::App& verb) {
  verb.require_subcommand(1);
  auto* const tum = verb.add_subcommand("tum", "folder of the TUM RGB-D benchmark to rawlog");
  auto* const mrclam =
      verb.add_subcommand("mrclam", "one robot of a UTIAS MRCLAM folder to a range-bearing rawlog");
  return [mrclam, import_tum = addTum(*tum), import_mrclam = addMrclam(*mrclam)] {
    return mrclam->parsed() ? import_mrclam() : import_tum();
  };
}

}  // namespace colonnade
