// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/renderer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "test_worlds.hpp"

namespace colonnade {
namespace {

#define REQUIRE_RENDERING() \
  if (const auto why = whyNoRendering(); !why.empty()) GTEST_SKIP() << why

/// Depth along the optical axis of the nearest face of the building that a pixel's ray meets.
double rayCast(const Building& building, const PinholeCamera& camera,
               const Eigen::Isometry3d& T_world_camera, double u, double v) {
  const Eigen::Vector3d origin = T_world_camera.translation();
  const Eigen::Vector3d ray = T_world_camera.linear() * camera.ray(u, v);  // z = 1: depth = scale
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& face : building.faces) {
    Eigen::Matrix3d system;
    system << face.along, face.up, -ray;
    if (std::abs(system.determinant()) < 1e-12) continue;
    const Eigen::Vector3d solution = system.inverse() * (origin - face.origin);
    if (solution.x() < 0 || solution.x() > 1 || solution.y() < 0 || solution.y() > 1) continue;
    if (solution.z() > 0.1) nearest = std::min(nearest, solution.z());
  }
  return nearest;
}

void expectDepthOfRayCast(const World& world, const Pose2& T_world_robot) {
  const auto building = buildBuilding(world);
  Renderer renderer(world, building);
  const Eigen::Isometry3d T_world_camera =
      T_world_robot.toIsometry3() * world.camera.T_robot_camera();
  const auto view = renderer.render(T_world_camera);
  const auto camera = world.camera.pinhole();
  int compared = 0, off = 0;
  for (int row = 2; row < camera.height_px; row += 7) {
    for (int column = 2; column < camera.width_px; column += 7) {
      const double expected = rayCast(building, camera, T_world_camera, column, row);
      const double found = view.depth_m.at<float>(row, column);
      if (!std::isfinite(expected)) continue;
      ++compared;
      if (std::abs(found - expected) > 0.003) ++off;  // at a silhouette either side may win
    }
  }
  EXPECT_GT(compared, 250);
  EXPECT_LE(off, compared / 100);
}

TEST(Renderer, depthEqualsARayCast) {
  REQUIRE_RENDERING();
  expectDepthOfRayCast(testing::roomWorld(), {0, 0, 0});
}

TEST(Renderer, depthEqualsARayCastWithATiltedOffsetCamera) {
  REQUIRE_RENDERING();
  expectDepthOfRayCast(
      testing::roomWorld("camera roll_deg=8 pitch_deg=20 left_m=0.3 forward_m=-0.2\n"
                         "door wall=r.2 at_m=2.5 recess_m=0.2\nboard wall=r.1 at_m=4\n"
                         "pillar 3 0.8 turn_deg=20\n"),
      {0.5, -0.4, radians(-25.0)});
}

TEST(Renderer, pixelsStayInPlaceWhateverTheSupersampling) {
  REQUIRE_RENDERING();
  for (const int factor : {1, 2, 4}) {
    expectDepthOfRayCast(
        testing::roomWorld("camera supersampling=" + std::to_string(factor) + "\n"),
        {0, 0, radians(10.0)});
  }
}

/// Corners are measured to 1e-4 of inverse depth, so what is rendered must be better than that.
TEST(Renderer, inverseDepthHasNoOffset) {
  REQUIRE_RENDERING();
  for (const int width : {320, 640}) {
    const auto world =
        testing::roomWorld("camera width_px=" + std::to_string(width) +
                           " height_px=" + std::to_string(width * 3 / 4) + " pitch_deg=12\n");
    const auto building = buildBuilding(world);
    Renderer renderer(world, building);
    for (const double heading : {10.0, 40.0, 200.0}) {
      const Eigen::Isometry3d T_world_camera =
          Pose2(0.2, -0.1, radians(heading)).toIsometry3() * world.camera.T_robot_camera();
      const auto view = renderer.render(T_world_camera);
      double sum = 0.0;
      int count = 0;
      for (int row = 2; row < view.depth_m.rows; row += 5) {
        for (int column = 2; column < view.depth_m.cols; column += 5) {
          const double expected =
              1.0 / rayCast(building, world.camera.pinhole(), T_world_camera, column, row);
          const double off =
              1.0 / static_cast<double>(view.depth_m.at<float>(row, column)) - expected;
          if (!(std::abs(off) < 0.01 * expected)) continue;  // a silhouette
          sum += off;
          ++count;
        }
      }
      ASSERT_GT(count, 1000);
      EXPECT_NEAR(sum / count, 0.0, 5e-6) << width << " " << heading;
    }
  }
}

TEST(Renderer, floorDepthAgreesWithGeometry) {
  REQUIRE_RENDERING();
  for (const int factor : {2, 3}) {
    const auto world = testing::roomWorld(
        "camera width_px=320 height_px=240 pitch_deg=30\n"
        "camera supersampling=" +
        std::to_string(factor) + "\n");
    const auto building = buildBuilding(world);
    Renderer renderer(world, building);
    const auto view = renderer.render(Pose2{}.toIsometry3() * world.camera.T_robot_camera());
    const auto lens = world.camera.pinhole();
    double worst = 0.0;
    for (int row = 130; row < 240; ++row) {
      for (int column = 100; column < 220; ++column) {
        // Height falls by y cos + z sin of the pitch along the ray.
        const auto ray = lens.ray(column, row);
        const double fall = ray.y() * std::cos(radians(30.0)) + std::sin(radians(30.0));
        const double depth = world.camera.height_m / fall;
        worst = std::max(worst, std::abs(view.depth_m.at<float>(row, column) - depth));
      }
    }
    EXPECT_LT(worst, 0.005) << factor;
  }
}

/// Where the image is brighter on one side than on the other along the projection of a vertical
/// edge: the column offset with the strongest horizontal gradient, averaged over its rows.
int strongestOffset(const cv::Mat& gray, const PinholeCamera& camera,
                    const Eigen::Isometry3d& T_world_camera, const Eigen::Vector2d& p_world,
                    double* strength) {
  cv::Mat gradient;
  cv::Sobel(gray, gradient, CV_32F, 1, 0);
  constexpr int kReach = 6;
  std::array<double, 2 * kReach + 1> sums{};
  int rows = 0;
  for (double z = 0.2; z < 1.2; z += 0.05) {
    const Eigen::Vector3d p =
        T_world_camera.inverse() * Eigen::Vector3d(p_world.x(), p_world.y(), z);
    const int u = static_cast<int>(std::lround(camera.cx_px + camera.fx_px * p.x() / p.z()));
    const int v = static_cast<int>(std::lround(camera.cy_px + camera.fy_px * p.y() / p.z()));
    if (v < 1 || v >= gray.rows - 1 || u < kReach + 1 || u >= gray.cols - kReach - 1) continue;
    for (int d = -kReach; d <= kReach; ++d) {
      sums[static_cast<std::size_t>(d + kReach)] += gradient.at<float>(v, u + d);
    }
    ++rows;
  }
  EXPECT_GT(rows, 5);
  int best = -kReach;
  for (int d = -kReach; d <= kReach; ++d) {
    const auto at = [&](int i) { return std::abs(sums[static_cast<std::size_t>(i + kReach)]); };
    if (at(d) > at(best)) best = d;
  }
  *strength = std::abs(sums[static_cast<std::size_t>(best + kReach)]) / std::max(1, rows);
  return best;
}

TEST(Renderer, landmarksLieOnVerticalGradients) {
  REQUIRE_RENDERING();
  const auto world = testing::roomWorld("camera width_px=320 height_px=240\n");
  const auto building = buildBuilding(world);
  Renderer renderer(world, building);
  const Pose2 T_world_robot{1.5, -1.0, 0.0};  // before the pilaster: its flanks are hidden
  const Eigen::Isometry3d T_world_camera =
      T_world_robot.toIsometry3() * world.camera.T_robot_camera();
  cv::Mat gray;
  cv::cvtColor(renderer.render(T_world_camera).colour, gray, cv::COLOR_BGR2GRAY);
  for (const double y : {-1.2, -0.8}) {  // the front edges of the pilaster, x = 4.8
    double strength = 0.0;
    const int offset =
        strongestOffset(gray, world.camera.pinhole(), T_world_camera, {4.8, y}, &strength);
    EXPECT_LE(std::abs(offset), 1) << "edge at y = " << y;
    EXPECT_GT(strength, 30.0) << "edge at y = " << y;
  }
}

/// The sub-pixel column of the edge near (u, row): centroid of the squared gradient of `rows` rows
/// along a line of slope du/dv.
double edgeColumn(const cv::Mat& gray, double u, int row) {
  double weights = 0.0, moments = 0.0;
  for (int column = static_cast<int>(std::lround(u)) - 3;
       column <= static_cast<int>(std::lround(u)) + 3; ++column) {
    // The difference of two neighbours stands half way between them.
    const double gradient = static_cast<double>(gray.at<unsigned char>(row, column + 1)) -
                            static_cast<double>(gray.at<unsigned char>(row, column));
    weights += gradient * gradient;
    moments += gradient * gradient * (column + 0.5);
  }
  return moments / weights;
}

TEST(Renderer, verticalEdgesLieWithinAThirdOfAPixelOfTheirProjection) {
  REQUIRE_RENDERING();
  for (const int factor : {2, 3}) {
    const auto world = testing::roomWorld(
        "material concrete pattern=plain colour=60,60,60\n"
        "camera width_px=640 height_px=480 supersampling=" +
        std::to_string(factor) + "\n");
    const auto building = buildBuilding(world);
    Renderer renderer(world, building);
    for (const double x : {0.5, 1.37}) {
      const Pose2 T_world_robot{x, -1.0, 0.02};  // before the pilaster: its flanks are hidden
      const Eigen::Isometry3d T_world_camera =
          T_world_robot.toIsometry3() * world.camera.T_robot_camera();
      cv::Mat gray;
      cv::cvtColor(renderer.render(T_world_camera).colour, gray, cv::COLOR_BGR2GRAY);
      const auto lens = world.camera.pinhole();
      for (const double y : {-1.2, -0.8}) {  // the front edges of the pilaster, x = 4.8
        double sum = 0.0;
        int count = 0;
        for (double z = 0.6; z < 1.2; z += 0.01) {
          const Eigen::Vector3d p = T_world_camera.inverse() * Eigen::Vector3d(4.8, y, z);
          const double u = lens.cx_px + lens.fx_px * p.x() / p.z();
          const double v = lens.cy_px + lens.fy_px * p.y() / p.z();
          const Eigen::Vector3d q = T_world_camera.inverse() * Eigen::Vector3d(4.8, y, z + 0.1);
          const double slope = (u - lens.cx_px - lens.fx_px * q.x() / q.z()) /
                               (v - lens.cy_px - lens.fy_px * q.y() / q.z());
          const int row = static_cast<int>(std::lround(v));
          const double expected = u + slope * (row - v);
          sum += edgeColumn(gray, expected, row) - expected;
          ++count;
        }
        EXPECT_LT(std::abs(sum / count), 0.3) << factor << " " << x << " " << y;
      }
    }
  }
}

TEST(Renderer, wallsHaveTextureAndLight) {
  REQUIRE_RENDERING();
  const auto world = testing::roomWorld();
  Renderer renderer(world, buildBuilding(world));
  const auto view = renderer.render(Pose2{}.toIsometry3() * world.camera.T_robot_camera());
  cv::Scalar mean, sigma;
  cv::meanStdDev(view.colour(cv::Rect(100, 20, 40, 20)), mean, sigma);  // a piece of bare wall
  EXPECT_GT(sigma[0], 0.5);
  EXPECT_GT(mean[0], 60.0);
  EXPECT_LT(mean[0], 250.0);
}

}  // namespace
}  // namespace colonnade
