// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <mrpt/core/Clock.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/serialization/CArchive.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "colonnade/frames/rawlog_source.hpp"
#include "colonnade/frames/rawlog_writer.hpp"
#include "temporary_folder.hpp"

namespace colonnade::testing {

using Bytes = std::vector<std::uint8_t>;

inline Bytes readFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void writeFile(const std::filesystem::path& path, const Bytes& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

/// A small camera, so that tests of many logs stay quick.
inline PinholeCamera smallCamera() { return {64, 48, 60.0, 61.0, 31.0, 24.5}; }

inline cv::Mat texture(int seed, int type = CV_8UC3) {
  cv::Mat image(48, 64, type);
  cv::RNG rng(static_cast<std::uint64_t>(seed) + 1);
  rng.fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

/// Values over the whole range of 16 bits, zeros among them.
inline cv::Mat depthUnits(int seed) {
  cv::Mat depth(48, 64, CV_16UC1);
  cv::RNG rng(static_cast<std::uint64_t>(seed) + 1000);
  rng.fill(depth, cv::RNG::UNIFORM, 0, 65536);
  depth.row(seed % 48).setTo(0);
  return depth;
}

/// A camera 0.7 m above the floor, left of the middle, looking forward and a little down.
inline Eigen::Isometry3d lookingForward() {
  Eigen::Matrix3d R_robot_optical;
  R_robot_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()) * R_robot_optical;
  T.translation() << 0.1, 0.05, 0.7;
  return T;
}

/// The i-th instant of a drive.
inline FrameRecord record(int i) {
  FrameRecord r;
  r.stamp_s = 1700000000.0 + 0.1 * i;
  r.image = texture(i);
  r.depth_units = depthUnits(i);
  r.metres_per_unit = 1.0 / 5000.0;
  r.camera = smallCamera();
  r.T_robot_camera = lookingForward();
  r.T_odom_robot = Pose2{0.1 * i, 0.01 * i, 0.02 * i};
  if (i > 0) {
    Eigen::Matrix3d covariance = Eigen::Vector3d(1e-4, 2e-4, 3e-4).asDiagonal();
    covariance(0, 1) = covariance(1, 0) = 5e-5;
    r.motion = MotionRecord{record(i - 1).T_odom_robot->inverse() * *r.T_odom_robot, covariance};
  }
  return r;
}

inline void writeLog(const std::filesystem::path& path, int frames,
                     const RawlogWriterOptions& options = {}) {
  RawlogWriter writer(path, options);
  for (int i = 0; i < frames; ++i) writer.add(record(i));
  writer.finish();
}

/// Everything a source gives, and how it ended.
struct ReadLog {
  std::vector<Frame> frames;
  Damage damage;
};

inline ReadLog readLog(const std::filesystem::path& path, const SourceOptions& options = {}) {
  RawlogSource source(path, options);
  ReadLog log;
  while (auto frame = source.next()) log.frames.push_back(std::move(*frame));
  log.damage = source.damage();
  return log;
}

/// A log written by MRPT itself.
class MrptLog {
 public:
  explicit MrptLog(const std::filesystem::path& path) : file_(path.string()) {}
  void add(const mrpt::serialization::CSerializable& object) {
    auto archive = mrpt::serialization::archiveFrom(file_);
    archive << object;
  }

 private:
  mrpt::io::CFileGZOutputStream file_;
};

/// MRPT's stamp (100 ns since 1601) of UNIX seconds.
inline mrpt::Clock::time_point stamp(double seconds) {
  return mrpt::Clock::time_point(
      mrpt::Clock::duration(std::llround(seconds * 1e7) + 116444736000000000LL));
}

}  // namespace colonnade::testing
