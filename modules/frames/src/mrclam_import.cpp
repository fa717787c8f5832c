// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/frames/mrclam_import.hpp"

#include <algorithm>
#include <cmath>

#include "colonnade/base/error.hpp"
#include "colonnade/base/log_path.hpp"
#include "colonnade/frames/rawlog_writer.hpp"
#include "mrclam_drive.hpp"
#include "mrclam_folder.hpp"

namespace colonnade {
namespace {

constexpr int kRobots = 5;
constexpr double kLastSpeedHolds_s =
    1.0;  ///< after the last record; between records until the next

constexpr double kWidestBearing = radians(80.0);  ///< no camera sees wider

/// Wheel speeds as a function of time, walked through once.
class Wheels {
 public:
  explicit Wheels(std::vector<WheelSpeed> driven) : speeds_(std::move(driven)) {}

  /// The motion from one time to a later one. Nothing is known before the first record: rest.
  ArcSum between(double from_s, double to_s, const WheelSpeedNoise& noise) {
    ArcSum sum(noise);
    while (current_ + 1 < speeds_.size() && speeds_[current_ + 1].stamp_s <= from_s) ++current_;
    double now_s = std::max(from_s, speeds_.front().stamp_s);
    for (std::size_t i = current_; i < speeds_.size() && now_s < to_s; ++i) {
      const bool last = i + 1 == speeds_.size();
      const double end_s = last ? speeds_[i].stamp_s + kLastSpeedHolds_s : speeds_[i + 1].stamp_s;
      const double until_s = std::min(to_s, end_s);
      if (until_s <= now_s) continue;
      sum.add(speeds_[i].speed_m_s, speeds_[i].turn_rate, until_s - now_s);
      now_s = until_s;
    }
    return sum;
  }

 private:
  std::vector<WheelSpeed> speeds_;
  std::size_t current_ = 0;
};

double rangeOf(const BarcodeReading& reading, const MrclamCalibration& calibration) {
  const double depth = (reading.range_m - calibration.depth_offset_m) / calibration.depth_gain;
  return calibration.range_is_depth ? depth / std::cos(reading.bearing) : depth;
}

/// The readings of one stamp that are of landmarks; the others are counted.
RangeBearingScan scanOf(const std::vector<BarcodeReading>& readings, std::size_t begin,
                        std::size_t end, const std::map<int, int>& subject_of_barcode,
                        const MrclamImportOptions& options, MrclamImportResult& result) {
  RangeBearingScan scan;
  scan.range_sigma_m = options.range_sigma_m;
  scan.yaw_sigma = options.bearing_sigma;
  for (std::size_t i = begin; i < end; ++i) {
    const BarcodeReading& reading = readings[i];
    const auto subject = subject_of_barcode.find(reading.barcode);
    const double range_m = rangeOf(reading, options.calibration);
    if (subject == subject_of_barcode.end())
      ++result.unknown_barcodes[reading.barcode];
    else if (subject->second <= kRobots)
      ++result.robot_readings[subject->second];
    else if (!(range_m > 0.0) || std::abs(reading.bearing) > kWidestBearing)
      ++result.bad_ranges;
    else {
      scan.readings.push_back({subject->second, range_m, reading.bearing, 0.0});
      for (MrclamLandmark& landmark : result.landmarks)
        if (landmark.subject == subject->second) ++landmark.readings;
    }
  }
  result.readings += scan.readings.size();
  return scan;
}

}  // namespace

MrclamCalibration MrclamCalibration::asRecorded() {
  return {.drive_delay_s = 0.0,
          .speed_gain = 1.0,
          .slowed_by_turn = 0.0,
          .turn_gain = 1.0,
          .turn_gain_on_spot = 1.0,
          .turn_offset = 0.0,
          .least_turn_rate = 0.0,
          .least_turn_below = 0.0,
          .breakaway_on_the_way = 0.0,
          .breakaway_on_spot = 0.0,
          .camera_delay_s = 0.0,
          .range_is_depth = false,
          .depth_offset_m = 0.0,
          .depth_gain = 1.0};
}

Pose2 arcOf(double speed_m_s, double turn_rate, double duration_s) {
  const double way = speed_m_s * duration_s;
  const double turn = turn_rate * duration_s;
  // Taylor approximation below 1e-6 rad: the next terms are turn^2 / 6 and turn^3 / 24 of the way.
  const bool straight = std::abs(turn) < 1e-6;
  return {straight ? way : way * std::sin(turn) / turn,
          straight ? 0.5 * way * turn : way * (1.0 - std::cos(turn)) / turn, wrapAngle(turn)};
}

void ArcSum::add(double speed_m_s, double turn_rate, double duration_s) {
  Eigen::Matrix3d J_start, J_arc;
  T_start_end_ = compose(T_start_end_, arcOf(speed_m_s, turn_rate, duration_s), &J_start, &J_arc);
  const double way = std::abs(speed_m_s * duration_s);
  const double turn = std::abs(turn_rate * duration_s);
  const Eigen::Vector3d variances(
      noise_.along_m * noise_.along_m * way, noise_.across_m * noise_.across_m * way,
      noise_.heading * noise_.heading * way + noise_.turn * noise_.turn * turn);
  covariance_ = J_start * covariance_ * J_start.transpose() +
                J_arc * variances.asDiagonal() * J_arc.transpose();
}

Eigen::Matrix3d ArcSum::covariance() const {
  Eigen::Matrix3d covariance = 0.5 * (covariance_ + covariance_.transpose());
  covariance.diagonal() +=
      Eigen::Vector3d(noise_.floor_m, noise_.floor_m, noise_.floor_angle).cwiseAbs2();
  return covariance;
}

MrclamImportResult importMrclam(const MrclamImportOptions& options) {
  if (options.robot < 1 || options.robot > kRobots)
    throw Error("robot " + std::to_string(options.robot) + ": the data set has robots 1 to 5",
                ExitCode::kUsage);
  if (!std::filesystem::is_directory(options.folder))
    throw Error(options.folder.string() + ": no such folder");
  const auto subject_of_barcode = readSubjectOfBarcode(options.folder);
  const auto readings = readBarcodeReadings(options.folder, options.robot);
  Wheels wheels(drivenSpeeds(readWheelSpeeds(options.folder, options.robot), options.calibration));
  const Trajectory truth = readMrclamTruth(options.folder, options.robot);

  MrclamImportResult result;
  result.landmarks = readMrclamLandmarks(options.folder);
  RawlogWriterOptions format;
  format.format = RawlogWriterOptions::Format::kActionSensoryFramePairs;
  format.keep_motion_covariance = true;
  RawlogWriter writer(options.log, format);
  double former_s = readings.front().stamp_s;
  for (std::size_t begin = 0, end = 0; begin < readings.size(); begin = end) {
    FrameRecord record;
    record.stamp_s = readings[begin].stamp_s;
    while (end < readings.size() && readings[end].stamp_s == record.stamp_s) ++end;
    const ArcSum sum = wheels.between(former_s, record.stamp_s, options.odometry);
    record.motion = MotionRecord{sum.motion(), sum.covariance()};
    record.range_bearing = scanOf(readings, begin, end, subject_of_barcode, options, result);
    writer.add(record);
    result.path_m += sum.motion().translation().norm();
    former_s = record.stamp_s;
    ++result.frames;
    if (options.progress) options.progress(end, readings.size());
  }
  result.ground_truth = logStem(options.log).string() + "_ground_truth.tum";
  result.ground_truth_poses = truth.size();
  writeTum(result.ground_truth, truth);
  writer.finish();
  return result;
}

}  // namespace colonnade
