// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "recorder.hpp"

#include <opencv2/core.hpp>

#include "colonnade/base/log_path.hpp"
#include "surfaces.hpp"

namespace colonnade {
namespace {

constexpr double kFirstStampS = 1767225600.0;  ///< 2026-01-01 00:00:00 UTC: logs have real stamps

/// The gray levels that a picture gets without noise. `gain`: of red, green and blue.
cv::Mat exposedGray(const cv::Mat& colour, const Eigen::Vector3d& gain) {
  const cv::Matx13d weights(0.114 * gain.z(), 0.587 * gain.y(), 0.299 * gain.x());
  cv::Mat gray;
  cv::transform(colour, gray, weights);
  return gray;
}

}  // namespace

Recorder::Recorder(const World& world, const Building& building, const std::filesystem::path& log,
                   std::uint64_t seed, int gz_level)
    : world_(world),
      odometry_(world.odometry, seed),
      depth_(world.depth, world.camera.pinhole(), seed),
      colour_(world.colour, seed),
      mono_(world.colour, seed, "mono"),
      truth_(world, building),
      special_(world, building),
      log_(log, {.format = RawlogWriterOptions::Format::kActionSensoryFramePairs,
                 .gz_level = gz_level,
                 .jpeg_quality = world.camera.jpeg_quality}),
      columns_(logStem(log).string() + "_columns.csv") {}

double Recorder::stampOf(const TrueFrame& frame) { return kFirstStampS + frame.time_s; }

void Recorder::add(const TrueFrame& frame) {
  const Eigen::Isometry3d T_world_camera =
      frame.T_world_robot.toIsometry3() * world_.camera.T_robot_camera();
  const Eigen::Vector3d light = world_.light.lightAt(frame.time_s, frame.driven_m);
  const Surfaces surfaces(frame.view.depth_m);
  auto special = special_.look(frame.view.depth_m, T_world_camera, frame.time_s);

  FrameRecord record;
  record.stamp_s = stampOf(frame);
  record.image = colour_.measure(frame.view.colour, light, frame.interval_s);
  if (world_.depth.enabled) record.depth_units = depth_.measure(surfaces, special.no_return);
  record.camera = world_.camera.pinhole();
  record.T_robot_camera = world_.camera.T_robot_camera();
  if (!frame.mono.empty()) {
    record.more_images.push_back({"MONO",
                                  mono_.measure(frame.mono, light, frame.time_s - mono_before_s_),
                                  world_.mono.pinhole(), world_.mono.T_robot_camera()});
    mono_before_s_ = frame.time_s;
  }
  const auto motion = odometry_.measure(frame.T_previous_robot);
  record.motion = MotionRecord{motion.T_previous_robot, motion.covariance};
  log_.add(record);

  const cv::Mat gray = exposedGray(frame.view.colour, colour_.gain() * light);
  auto columns = truth_.observe(surfaces, gray, T_world_camera, record.stamp_s);
  columns.insert(columns.end(), special.seen.begin(), special.seen.end());
  columns_.add(record.stamp_s, frame.index, columns);
}

void Recorder::finish() {
  log_.finish();
  columns_.finish();
}

}  // namespace colonnade
