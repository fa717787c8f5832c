// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/frames/floor_plane.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <random>

#include "colonnade/base/trajectory.hpp"
#include "shared_data.hpp"

namespace colonnade {
namespace {

const PinholeCamera kCamera{640, 480, 535.0, 535.0, 319.5, 239.5};

struct Room {
  double height_m = 1.2, pitch = 0.2, roll = 0.05;
  bool table = false;  ///< a table top, 0.75 m above the floor, in the nearer half
  bool floor = true;
};

Eigen::Matrix3d opticalOnRobot(double pitch, double roll) {
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return (Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
             .toRotationMatrix() *
         axes;
}

/// A room 5 m deep and 4 m wide with the noise of a Kinect (1.4 mm at 1 m, growing with depth^2).
cv::Mat render(const Room& room, int seed) {
  const Eigen::Matrix3d R = opticalOnRobot(room.pitch, room.roll);
  std::mt19937 random(static_cast<unsigned>(seed));
  std::normal_distribution<double> normal;
  cv::Mat depth(480, 640, CV_32FC1, cv::Scalar(0));
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 640; ++u) {
      const Eigen::Vector3d ray = R * kCamera.ray(u, v);
      double z = 1e9;
      const auto hit = [&](double t) {
        if (t > 0.2 && t < z) z = t;
      };
      hit(5.0 / ray.x());
      hit(2.0 / std::abs(ray.y()));
      if (room.floor) hit(-room.height_m / ray.z());
      if (room.table) {
        const double t = (0.75 - room.height_m) / ray.z();
        const Eigen::Vector3d p = t * ray;
        if (p.x() > 0.5 && p.x() < 2.0 && std::abs(p.y()) < 0.4) hit(t);
      }
      if (z > 8.0) continue;
      depth.at<float>(v, u) = static_cast<float>(z + 0.0014 * z * z * normal(random));
    }
  return depth;
}

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::min(1.0, a.normalized().dot(b.normalized())));
}

class FloorPlaneFit : public ::testing::TestWithParam<Room> {};

TEST_P(FloorPlaneFit, FindsHeightAndTilt) {
  const Room room = GetParam();
  for (int seed = 0; seed < 5; ++seed) {
    const auto floor = fitFloorPlane(render(room, seed), kCamera);
    ASSERT_TRUE(floor) << "seed " << seed;
    const Eigen::Vector3d up =
        opticalOnRobot(room.pitch, room.roll).transpose() * Eigen::Vector3d::UnitZ();
    EXPECT_LT(angleBetween(floor->normal_camera, up), radians(0.4)) << "seed " << seed;
    EXPECT_NEAR(floor->height_m, room.height_m, 0.015) << "seed " << seed;
    EXPECT_LT(floor->rms_m, 0.03);
  }
}

INSTANTIATE_TEST_SUITE_P(Rooms, FloorPlaneFit,
                         ::testing::Values(Room{}, Room{0.4, 0.0, 0.0}, Room{1.6, 0.5, -0.3},
                                           Room{1.2, 0.3, 0.0, true}, Room{1.0, 0.6, 0.0, true}));

TEST(FloorPlane, WallsAreNoFloor) {
  EXPECT_FALSE(fitFloorPlane(render({1.2, 0.1, 0.0, false, false}, 1), kCamera));
  EXPECT_FALSE(fitFloorPlane(cv::Mat(480, 640, CV_32FC1, cv::Scalar(0)), kCamera));
  EXPECT_FALSE(fitFloorPlane(cv::Mat(), kCamera));
}

TEST(FloorPlane, APriorOnTheHeightRulesOutOtherPlanes) {
  FloorPrior prior;
  prior.height_m = 2.5;
  EXPECT_FALSE(fitFloorPlane(render({}, 1), kCamera, prior));
  prior.height_m = 1.1;
  EXPECT_TRUE(fitFloorPlane(render({}, 1), kCamera, prior));
}

TEST(FloorPlane, SameImageSameAnswer) {
  const auto depth = render({}, 3);
  const auto a = fitFloorPlane(depth, kCamera), b = fitFloorPlane(depth, kCamera);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->height_m, b->height_m);
  EXPECT_EQ(a->normal_camera, b->normal_camera);
}

TEST(FloorPlane, CameraAboveFloorInvertsTheFit) {
  const double pitch = 0.3, roll = -0.2;
  const Eigen::Matrix3d R = opticalOnRobot(pitch, roll);
  const auto T = cameraAboveFloor(R.transpose() * Eigen::Vector3d::UnitZ(), 1.3);
  EXPECT_TRUE(T.linear().isApprox(R, 1e-12));
  EXPECT_NEAR(T.translation().z(), 1.3, 1e-12);
}

TEST(FloorPlane, AgreesWithMotionCaptureOnARecording) {
  COLONNADE_REQUIRE_RECORDING(folder, "tum_fr3_cabinet");
  const PinholeCamera camera{640, 480, 535.4, 539.2, 320.1, 247.6};
  std::vector<double> errors;
  int frames = 0;
  for (const auto& pose : readTum(folder / "groundtruth.txt")) {
    char name[64];
    std::snprintf(name, sizeof name, "depth/%017.6f.png", pose.stamp_s);
    const cv::Mat units = cv::imread((folder / name).string(), cv::IMREAD_UNCHANGED);
    if (units.empty()) continue;
    ++frames;
    cv::Mat depth;
    units.convertTo(depth, CV_32F, 1.0 / 5000.0);
    const auto floor = fitFloorPlane(depth, camera);
    if (!floor) continue;
    const Eigen::Vector3d up = pose.T_world_body.linear().transpose() * Eigen::Vector3d::UnitZ();
    errors.push_back(angleBetween(floor->normal_camera, up));
  }
  ASSERT_GT(frames, 50);
  EXPECT_GT(errors.size(), static_cast<std::size_t>(frames) * 9 / 10);
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], radians(1.5));
  EXPECT_LT(errors[errors.size() * 9 / 10], radians(3.0));
}

}  // namespace
}  // namespace colonnade
