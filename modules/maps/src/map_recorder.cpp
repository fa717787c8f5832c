// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/maps/map_recorder.hpp"

#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <algorithm>
#include <cmath>

#include "colonnade/base/angle.hpp"
#include "grid_map.hpp"
#include "landmarks_map.hpp"
#include "mrpt_file.hpp"
#include "scan_log.hpp"
#include "scan_observation.hpp"
#include "scene.hpp"

namespace colonnade {
namespace {

constexpr double kSameStamp_s = 1e-5;  ///< stamps that went through a TUM file have microseconds
constexpr std::size_t kFewestBeams = 5;

/// Moves the key frames to where the trajectory has them at the same stamp.
/// To where the trajectory has them; those it does not have go.
void moveTo(const Trajectory& trajectory, std::vector<KeyFrame>& key_frames) {
  if (trajectory.empty()) return;
  std::erase_if(key_frames, [&](KeyFrame& key_frame) {
    const auto found = std::lower_bound(
        trajectory.begin(), trajectory.end(), key_frame.stamp_s - kSameStamp_s,
        [](const StampedPose& pose, double stamp) { return pose.stamp_s < stamp; });
    if (found == trajectory.end() || found->stamp_s > key_frame.stamp_s + kSameStamp_s) return true;
    key_frame.T_world_robot = planarPart(found->T_world_body);
    return false;
  });
}

mrpt::maps::CSimpleMap toSimpleMap(const std::vector<KeyFrame>& key_frames) {
  mrpt::maps::CSimpleMap map;
  for (const auto& key_frame : key_frames) {
    // Through SE(3): the overload for planar poses fails an assertion of its own in MRPT 2.5.8.
    const auto pose = mrpt::poses::CPose3DPDFGaussian::Create(
        mrpt::poses::CPose3DPDFGaussian(toMrpt(key_frame.T_world_robot, key_frame.covariance)));
    auto observations = mrpt::obs::CSensoryFrame::Create();
    observations->insert(key_frame.observation);
    map.insert(pose, observations);
  }
  return map;
}

mrpt::maps::CSimplePointsMap::Ptr toPoints(const std::vector<KeyFrame>& key_frames) {
  auto points = mrpt::maps::CSimplePointsMap::Create();
  points->insertionOptions.minDistBetweenLaserPoints = 0.02F;
  for (const auto& key_frame : key_frames) {
    const auto& pose = key_frame.T_world_robot;
    const mrpt::poses::CPose3D robot(pose.x, pose.y, 0.0, pose.phi, 0.0, 0.0);
    points->insertObservation(*key_frame.observation, robot);
  }
  return points;
}

}  // namespace

struct MapRecorder::Impl {
  Impl(const std::filesystem::path& results, const MapOptions& map_options,
       const ScanOptions& scan_options)
      : folder(results),
        options(map_options),
        max_range_m(scan_options.max_range_m),
        cutter(scan_options),
        scan_log(results / "scans.rawlog") {}

  bool isKeyFrame(const Pose2& T_world_robot) const {
    if (key_frames.empty()) return true;
    const auto& last = key_frames.back().T_world_robot;
    return (T_world_robot.translation() - last.translation()).norm() >=
               options.keyframe_distance_m ||
           std::abs(wrapAngle(T_world_robot.phi - last.phi)) >= options.keyframe_turn;
  }

  std::filesystem::path folder;
  MapOptions options;
  double max_range_m;
  ScanCutter cutter;
  ScanLog scan_log;
  std::vector<KeyFrame> key_frames;
  bool depth_seen = false;
};

MapRecorder::MapRecorder(const std::filesystem::path& folder, const MapOptions& map_options,
                         const ScanOptions& scan_options)
    : impl_(std::make_unique<Impl>(folder, map_options, scan_options)) {}

MapRecorder::~MapRecorder() = default;

void MapRecorder::add(const Frame& frame, const Pose2& T_world_robot,
                      const Eigen::Matrix3d& covariance, const Pose2& T_previous_robot,
                      const Eigen::Matrix3d& increment_covariance) {
  impl_->scan_log.addMotion(T_previous_robot, increment_covariance);
  const auto scan = impl_->cutter.cut(frame);
  if (!scan) return;
  impl_->depth_seen = true;
  const auto observation = toObservation(*scan, frame.stamp_s, impl_->max_range_m);
  impl_->scan_log.addScan(observation, frame.stamp_s);
  if (scan->validBeams() >= kFewestBeams && impl_->isKeyFrame(T_world_robot))
    impl_->key_frames.push_back({frame.stamp_s, T_world_robot, covariance, *scan, observation});
}

MapFiles MapRecorder::finish(const MapContents& contents) {
  MapFiles files;
  const auto file = [&](const char* file_name) {
    files.written.push_back(impl_->folder / file_name);
    return files.written.back();
  };
  auto& key_frames = impl_->key_frames;
  moveTo(contents.trajectory, key_frames);
  auto metric_maps = mrpt::maps::CMultiMetricMap::Create();
  GridPicture grid_picture;
  if (impl_->scan_log.scans() > 0) {
    impl_->scan_log.finish();
    file("scans.rawlog");
  } else {
    files.left_out.push_back("scans.rawlog: no frame has depth");
  }
  if (key_frames.empty()) {
    files.left_out.push_back(
        std::string("map.simplemap, map.gridmap.gz, map.png, map.yaml: ") +
        (impl_->depth_seen ? "no obstacle in any depth image" : "no frame has depth"));
  } else {
    writeObject(file("map.simplemap"), toSimpleMap(key_frames));
    const auto grid = buildGrid(key_frames, impl_->options.grid_resolution_m);
    writeObject(file("map.gridmap.gz"), *grid);
    grid_picture = toPicture(*grid);
    writeNavigationMap(impl_->folder, "map", grid_picture);
    file("map.png");
    file("map.yaml");
    metric_maps->maps.push_back(grid);
    metric_maps->maps.push_back(toPoints(key_frames));
  }
  const auto landmarks = toLandmarksMap(contents.landmarks);
  writeObject(file("map.landmarksmap.gz"), *landmarks);
  metric_maps->maps.push_back(landmarks);
  writeObject(file("map.metricmap.gz"), *metric_maps);
  writeObject(file("map.3Dscene"),
              makeScene(contents.landmarks, contents.trajectory, grid_picture));
  writeMapPicture(file("map_overview.png"), {.title = contents.title,
                                             .landmarks = contents.landmarks,
                                             .trajectory = contents.trajectory,
                                             .ground_truth = contents.ground_truth,
                                             .grid = grid_picture});
  return files;
}

}  // namespace colonnade
