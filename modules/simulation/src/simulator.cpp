// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/simulator.hpp"

#include <algorithm>
#include <cmath>

#include "colonnade/base/log_path.hpp"
#include "colonnade/base/trajectory.hpp"
#include "colonnade/frames/rawlog_writer.hpp"
#include "colonnade/maps/landmark_csv.hpp"
#include "colonnade/simulation/colour_noise.hpp"
#include "colonnade/simulation/depth_noise.hpp"
#include "colonnade/simulation/drive.hpp"
#include "colonnade/simulation/floor_plan.hpp"
#include "colonnade/simulation/odometry_noise.hpp"
#include "colonnade/simulation/renderer.hpp"
#include "colonnade/simulation/truth.hpp"

namespace colonnade {
namespace {

constexpr double kFirstStampS = 1767225600.0;  ///< 2026-01-01 00:00:00 UTC: logs have real stamps

cv::Mat millimetres(const cv::Mat& depth_m) {
  cv::Mat units(depth_m.size(), CV_16UC1);
  for (int row = 0; row < depth_m.rows; ++row) {
    for (int column = 0; column < depth_m.cols; ++column) {
      units.at<std::uint16_t>(row, column) =
          static_cast<std::uint16_t>(std::lround(1000.0F * depth_m.at<float>(row, column)));
    }
  }
  return units;
}

}  // namespace

SimulationSummary simulate(const World& world, const std::filesystem::path& log,
                           const SimulationOptions& options) {
  const Building building = buildBuilding(world);
  const auto poses = driveRoute(world.route, world.camera.rate_hz);
  const FloorPlan plan = drawFloorPlan(building, world.route.start.translation());

  Renderer renderer(world, building);
  OdometryNoise odometry(world.odometry, options.seed);
  DepthNoise depth_noise(world.depth, world.camera.pinhole(), options.seed);
  ColourNoise colour_noise(world.colour, options.seed);
  Truth truth(world, building);
  RawlogWriter writer(log, {.format = RawlogWriterOptions::Format::kActionSensoryFramePairs,
                            .gz_level = options.gz_level,
                            .jpeg_quality = world.camera.jpeg_quality});

  SimulationSummary summary;
  Trajectory trajectory;
  Pose2 previous = poses.front();
  for (const auto& pose : poses) {
    const double stamp_s =
        kFirstStampS + static_cast<double>(summary.frames) / world.camera.rate_hz;
    const Eigen::Isometry3d T_world_camera = pose.toIsometry3() * world.camera.T_robot_camera();
    const RenderedView view = renderer.render(T_world_camera, stamp_s - kFirstStampS);
    const auto motion = odometry.measure(previous.inverse() * pose);

    FrameRecord record;
    record.stamp_s = stamp_s;
    record.image = colour_noise.measure(view.colour);
    if (world.depth.enabled) record.depth_units = millimetres(depth_noise.measure(view.depth_m));
    record.camera = world.camera.pinhole();
    record.T_robot_camera = world.camera.T_robot_camera();
    record.motion = MotionRecord{motion.T_previous_robot, motion.covariance};
    writer.add(record);

    truth.observe(view.depth_m, T_world_camera, stamp_s);
    trajectory.push_back({stamp_s, pose.toIsometry3()});
    summary.path_length_m += (pose.translation() - previous.translation()).norm();
    previous = pose;
    ++summary.frames;
    if (options.progress) options.progress(summary.frames, poses.size());
  }
  writer.finish();

  const std::string stem = logStem(log).string();
  writeTum(stem + "_ground_truth.tum", trajectory);
  writeLandmarksCsv(stem + "_landmarks.csv", truth.landmarks());
  writeFloorPlan(stem + "_floor", plan);

  summary.duration_s = trajectory.back().stamp_s - trajectory.front().stamp_s;
  summary.landmarks = truth.landmarks().size();
  summary.landmarks_seen = static_cast<std::size_t>(
      std::count_if(truth.landmarks().begin(), truth.landmarks().end(),
                    [](const LandmarkRecord& landmark) { return landmark.observations > 0; }));
  summary.log_bytes = std::filesystem::file_size(log);
  return summary;
}

}  // namespace colonnade
