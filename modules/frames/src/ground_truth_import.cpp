// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ground_truth_import.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <string>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/frames/floor_plane.hpp"

namespace colonnade {
namespace {

/// The axis z of a world that is level; the other axes of one that is not are far from it.
constexpr double kMostOffVertical = radians(30.0);
constexpr double kNear_s = 0.1;  ///< a pose this far in time still tells a camera's rotation

/// The pose closest in time, or null when none is near.
const StampedPose* closest(const Trajectory& poses, double stamp_s) {
  const StampedPose* best = nullptr;
  for (const auto& pose : poses)
    if (std::abs(pose.stamp_s - stamp_s) <= (best ? std::abs(best->stamp_s - stamp_s) : kNear_s))
      best = &pose;
  return best;
}

/// The mean of `ups`, each carried into the poses' world; nothing where no pose is near in time.
std::optional<Eigen::Vector3d> upInWorld(const Trajectory& cameras,
                                         const std::vector<StampedUp>& ups) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& up : ups)
    if (const auto* pose = closest(cameras, up.stamp_s))
      sum += pose->T_world_body.linear() * up.up_camera;
  return sum.norm() < 0.5 ? std::nullopt : std::optional<Eigen::Vector3d>(sum.normalized());
}

}  // namespace

GroundTruthWorld guessWorld(const std::filesystem::path& file, const Trajectory& cameras,
                            const std::vector<StampedUp>& ups) {
  std::ifstream text(file);
  for (std::string line; std::getline(text, line) && line.starts_with('#');)
    if (line.find("in the first camera") != std::string::npos)
      return GroundTruthWorld::kFirstCamera;
  if (const auto up_world = upInWorld(cameras, ups))
    return up_world->z() > std::cos(kMostOffVertical) ? GroundTruthWorld::kZUp
                                                      : GroundTruthWorld::kFirstCamera;
  return !cameras.empty() &&
                 cameras.front().T_world_body.isApprox(Eigen::Isometry3d::Identity(), 1e-9)
             ? GroundTruthWorld::kFirstCamera
             : GroundTruthWorld::kZUp;
}

Trajectory robotGroundTruth(const Trajectory& cameras, GroundTruthWorld world,
                            const std::vector<StampedUp>& ups) {
  Eigen::Isometry3d T_level_world = Eigen::Isometry3d::Identity();
  if (world == GroundTruthWorld::kFirstCamera) {
    const auto up_world = upInWorld(cameras, ups);
    if (!up_world)
      throw Error(
          "the ground truth's world is its first camera, but no floor in the first depth images "
          "tells what is up; give --camera-pitch-deg and --camera-roll-deg",
          ExitCode::kUsage);
    T_level_world = cameraAboveFloor(*up_world, 0.0);
  }
  Trajectory robots;
  robots.reserve(cameras.size());
  for (const auto& camera : cameras) {
    const Eigen::Isometry3d T = T_level_world * camera.T_world_body;
    const Eigen::Vector3d axis = T.linear().col(2);
    StampedPose robot;
    robot.stamp_s = camera.stamp_s;
    robot.T_world_body =
        Pose2{T.translation().x(), T.translation().y(), std::atan2(axis.y(), axis.x())}
            .toIsometry3();
    robots.push_back(robot);
  }
  return robots;
}

}  // namespace colonnade
