// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/frames/tum_import.hpp"

#include <cmath>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>

#include "camera_views.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/base/log_path.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/frames/floor_plane.hpp"
#include "colonnade/frames/rawlog_writer.hpp"
#include "ground_truth_import.hpp"
#include "tum_folder.hpp"

namespace colonnade {
namespace {

constexpr double kTogether_s = 0.02;
constexpr std::size_t kMountingFrames = 10;
constexpr std::size_t kMountingTries = 60;  ///< pairs looked at for a floor

std::vector<std::uint8_t> readBytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

bool isColourJpeg(const std::vector<std::uint8_t>& bytes, const cv::Mat& decoded) {
  return bytes.size() > 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && decoded.type() == CV_8UC3;
}

/// The calibration to use: the options', else the folder's.
TumCalibration chooseCalibration(const TumImportOptions& options) {
  if (options.calibration) return *options.calibration;
  const auto file = options.folder / "calibration.txt";
  if (std::filesystem::exists(file)) return readTumCalibration(file);
  throw Error(options.folder.string() +
                  ": no calibration.txt; give --calibration FILE or --intrinsics fx,fy,cx,cy",
              ExitCode::kUsage);
}

class Importer {
 public:
  explicit Importer(const TumImportOptions& options)
      : options_(options),
        calibration_(chooseCalibration(options)),
        colour_(readTumList(options.folder / "rgb.txt")),
        depth_(readTumList(options.folder / "depth.txt")),
        pairs_(associate(colour_, depth_, kTogether_s)) {
    result_.depth_units_per_metre =
        options.depth_units_per_metre.value_or(calibration_.depth_units_per_metre.value_or(5000.0));
    result_.colour_without_depth = colour_.size() - pairs_.size();
    result_.depth_without_colour = depth_.size() - pairs_.size();
    if (pairs_.empty())
      throw Error(options.folder.string() + ": no colour and depth image within " +
                  formatDouble(kTogether_s) + " s of each other");
  }

  TumImportResult run() {
    mount();
    write();
    importGroundTruth();
    return result_;
  }

 private:
  PinholeCamera cameraFor(const cv::Mat& pixels) const {
    return {pixels.cols,        pixels.rows,        calibration_.fx_px,
            calibration_.fy_px, calibration_.cx_px, calibration_.cy_px};
  }

  cv::Mat readDepth(std::size_t index) const {
    try {
      return cv::imread((options_.folder / depth_[index].file).string(), cv::IMREAD_UNCHANGED);
    } catch (const cv::Exception&) {
      return {};
    }
  }

  /// Looks for the floor in the first depth images and decides where the camera sits.
  void mount() {
    Eigen::Vector3d up = Eigen::Vector3d::Zero();
    std::vector<double> heights;
    for (std::size_t i = 0; i < std::min(pairs_.size(), kMountingTries); ++i) {
      const cv::Mat units = readDepth(pairs_[i].second);
      if (units.type() != CV_16UC1) continue;
      cv::Mat depth_m;
      units.convertTo(depth_m, CV_32F, 1.0 / result_.depth_units_per_metre);
      const auto floor = fitFloorPlane(depth_m, cameraFor(units));
      if (!floor) continue;
      up += floor->normal_camera;
      heights.push_back(floor->height_m);
      ups_.push_back({colour_[pairs_[i].first].stamp_s, floor->normal_camera});
      if (heights.size() == kMountingFrames) break;
    }
    const bool seen = !heights.empty();
    const bool complete = options_.camera_height_m && options_.camera_pitch && options_.camera_roll;
    if (!seen && !complete)
      throw Error(options_.folder.string() +
                      ": no floor to be seen in the first depth images; give --camera-height, "
                      "--camera-pitch-deg and --camera-roll-deg",
                  ExitCode::kUsage);
    result_.mounting_from_floor = seen && !complete;
    double height = 0.0, pitch = 0.0, roll = 0.0;
    if (seen) {
      std::nth_element(heights.begin(), heights.begin() + std::ssize(heights) / 2, heights.end());
      height = heights[heights.size() / 2];
      const Eigen::Matrix3d R = cameraAboveFloor(up, height).linear() * opticalAxes().transpose();
      pitch = std::atan2(-R(2, 0), std::hypot(R(2, 1), R(2, 2)));
      roll = std::atan2(R(2, 1), R(2, 2));
    }
    height = options_.camera_height_m.value_or(height);
    pitch = options_.camera_pitch.value_or(pitch);
    roll = options_.camera_roll.value_or(roll);
    result_.T_robot_camera.linear() = (Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                                       Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
                                          .toRotationMatrix() *
                                      opticalAxes();
    result_.T_robot_camera.translation() << 0.0, 0.0, height;
    const bool is_told = options_.camera_pitch && options_.camera_roll;
    if (is_told) ups_.clear();
    if (is_told || !seen)
      ups_.push_back({colour_[pairs_.front().first].stamp_s,
                      result_.T_robot_camera.linear().row(2).transpose()});
  }

  void write() {
    RawlogWriterOptions writer_options;
    writer_options.gz_level = options_.gz_level;
    RawlogWriter writer(options_.log, writer_options);
    std::size_t done = 0;
    for (const auto& [colour, depth] : pairs_) {
      FrameRecord record;
      const std::string problem = read(colour, depth, record);
      if (problem.empty()) {
        writer.add(record);
        ++result_.frames;
      } else {
        ++result_.skipped[problem];
      }
      if (options_.progress) options_.progress(++done, pairs_.size());
    }
    if (result_.frames == 0)
      throw Error(options_.folder.string() + ": none of " + std::to_string(pairs_.size()) +
                  " image pairs can be read (" + result_.skipped.begin()->first + ")");
    writer.finish();
  }

  /// Fills the record; a reason when the pair is of no use.
  std::string read(std::size_t colour, std::size_t depth, FrameRecord& record) const {
    const auto colour_file = options_.folder / colour_[colour].file;
    const auto depth_file = options_.folder / depth_[depth].file;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(colour_file, ignored)) return "colour file missing";
    if (!std::filesystem::is_regular_file(depth_file, ignored)) return "depth file missing";
    auto bytes = readBytes(colour_file);
    try {
      if (!bytes.empty()) record.image = cv::imdecode(bytes, cv::IMREAD_ANYCOLOR);
    } catch (const cv::Exception&) {
      record.image.release();
    }
    if (record.image.empty()) return "colour file unreadable";
    record.depth_units = readDepth(depth);
    if (record.depth_units.empty()) return "depth file unreadable";
    if (record.depth_units.type() != CV_16UC1) return "depth file is no 16-bit gray image";
    if (record.depth_units.size() != record.image.size()) return "colour and depth differ in size";
    if (isColourJpeg(bytes, record.image)) record.encoded_image = std::move(bytes);
    record.stamp_s = colour_[colour].stamp_s;
    record.metres_per_unit = 1.0 / result_.depth_units_per_metre;
    record.camera = cameraFor(record.image);
    record.T_robot_camera = result_.T_robot_camera;
    return {};
  }

  void importGroundTruth() {
    auto file = options_.ground_truth;
    for (const char* name : {"groundtruth.txt", "reference.tum"})
      if (!file && std::filesystem::exists(options_.folder / name)) file = options_.folder / name;
    if (!file) return;
    const Trajectory cameras = readTum(*file);
    result_.ground_truth_world = options_.ground_truth_world == GroundTruthWorld::kGuess
                                     ? guessWorld(*file, cameras, ups_)
                                     : options_.ground_truth_world;
    const auto robots = robotGroundTruth(cameras, result_.ground_truth_world, ups_);
    result_.ground_truth = logStem(options_.log).string() + "_ground_truth.tum";
    result_.ground_truth_poses = robots.size();
    writeTum(*result_.ground_truth, robots);
  }

  TumImportOptions options_;
  TumCalibration calibration_;
  std::vector<TumEntry> colour_, depth_;
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;
  std::vector<StampedUp> ups_;
  TumImportResult result_;
};

}  // namespace

TumImportResult importTum(const TumImportOptions& options) { return Importer(options).run(); }

}  // namespace colonnade
