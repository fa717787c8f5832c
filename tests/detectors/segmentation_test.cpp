// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/segmentation.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "synthetic_scene.hpp"

namespace colonnade::testing {
namespace {

constexpr int kWidth_px = 320;
constexpr int kHeight_px = 240;

Scene room() {
  Scene scene;
  scene.faces.push_back({{4.5, -2.5}, {4.5, 2.5}, 150.0});
  scene.faces.push_back({{-1.0, -2.0}, {4.5, -2.0}, 120.0});
  scene.faces.push_back({{3.0, 0.8}, {3.0, 1.2}, 60.0});  // a pillar
  return scene;
}

/// A corridor whose left wall opens into a room between x = 3.5 and 4.5.
Scene corridor() {
  Scene scene;
  scene.faces.push_back({{-1.0, 1.1}, {3.5, 1.1}, 150.0});
  scene.faces.push_back({{4.5, 1.1}, {9.0, 1.1}, 150.0});
  scene.faces.push_back({{2.0, 4.0}, {6.0, 4.0}, 120.0});
  scene.faces.push_back({{-1.0, -1.1}, {9.0, -1.1}, 120.0});
  scene.faces.push_back({{9.0, -1.1}, {9.0, 1.1}, 100.0});
  return scene;
}

/// A scene seen from where the robot is, with a person as wide as a trunk at p (world).
Frame seenFrom(Scene scene, const Pose2& T_world_robot,
               const std::optional<Eigen::Vector2d>& p_person, std::size_t index,
               double step_s = 0.1) {
  if (p_person) {
    const Eigen::Vector2d half(0.0, 0.22);
    scene.faces.push_back({*p_person - half, *p_person + half, 30.0, 0.0, 1.75});
  }
  const Pose2 T_robot_world = T_world_robot.inverse();
  for (Face& face : scene.faces) {
    face.a = transform(T_robot_world, face.a);
    face.b = transform(T_robot_world, face.b);
  }
  Frame frame =
      withNoise(render(scene, {1.0, radians(8.0), 0.0, 0.0, {0.0, 0.0}}, kWidth_px, kHeight_px),
                2.0, static_cast<std::uint32_t>(index + 1));
  frame.index = index;
  frame.stamp_s = step_s * static_cast<double>(index);
  return frame;
}

/// Shares of the pixels of the person (by depth) and of everything else that are called moving.
struct Called {
  double person = 0.0;
  double rest = 0.0;
};
Called called(const Frame& frame, const Segmentation& segmentation, double person_depth_m) {
  int person = 0, person_moving = 0, rest = 0, rest_moving = 0;
  for (int v = 4; v < 150; v += 4) {
    for (int u = 4; u < kWidth_px; u += 4) {
      const bool moving = segmentation.at({u, v}) == Segmentation::kMoving;
      const auto z = static_cast<double>(frame.depth_m.at<float>(v, u));
      if (std::abs(z - person_depth_m) < 0.15) {
        ++person;
        person_moving += moving;
      } else {
        ++rest;
        rest_moving += moving;
      }
    }
  }
  return {person ? static_cast<double>(person_moving) / person : 0.0,
          static_cast<double>(rest_moving) / std::max(rest, 1)};
}

struct Drive {
  Scene scene = room();
  double step_s = 0.1;
  Pose2 T_world_robot;
  Segmenter segmenter;
  DetectorBank bank;
  std::size_t index = 0;
  Frame frame;
  Segmentation segmentation;

  void step(const Pose2& increment, const std::optional<Eigen::Vector2d>& p_person) {
    T_world_robot = T_world_robot * increment;
    frame = seenFrom(scene, T_world_robot, p_person, index++, step_s);
    segmentation = segmenter.segment(frame, index > 1 ? std::optional(increment) : std::nullopt);
  }
};

const Pose2 kAhead{0.05, 0.0, radians(1.0)};

TEST(Segmentation, CallsNothingMovingWhereTheWorldHoldsStill) {
  Drive drive;
  for (int i = 0; i < 14; ++i) {
    drive.step(kAhead, std::nullopt);
    EXPECT_EQ(drive.segmentation.count(Segmentation::kMoving), 0U) << "frame " << i;
  }
}

TEST(Segmentation, FindsAPersonWhoCrossesTheView) {
  Drive drive;
  for (int i = 0; i < 14; ++i) drive.step(kAhead, Eigen::Vector2d(2.6, -1.0 + 0.09 * i));
  double nearest = 9.0;
  for (int u = 0; u < kWidth_px; ++u) {
    const auto z = static_cast<double>(drive.frame.depth_m.at<float>(100, u));
    if (z > 0.2) nearest = std::min(nearest, z);
  }
  const Called share = called(drive.frame, drive.segmentation, nearest);
  EXPECT_GT(share.person, 0.85);
  EXPECT_LT(share.rest, 0.08);
}

TEST(Segmentation, FindsAPersonWhoComesAndOneWhoGoes) {
  for (const double speed : {-1.0, 1.0}) {
    Drive drive;
    for (int i = 0; i < 12; ++i)
      drive.step(
          {0.0, 0.0, 0.0},
          Eigen::Vector2d(speed < 0.0 ? 3.6 + 0.1 * speed * i : 2.0 + 0.1 * speed * i, -0.3));
    const double depth_m = speed < 0.0 ? 2.5 : 3.1;
    const Called share = called(drive.frame, drive.segmentation, depth_m);
    EXPECT_GT(share.person, 0.6) << "speed " << speed;
    EXPECT_LT(share.rest, 0.08) << "speed " << speed;
  }
}

TEST(Segmentation, KeepsWhatAPersonUncoversAtTwoFramesASecond) {
  Drive drive;
  drive.step_s = 0.5;
  for (int i = 0; i < 8; ++i) {
    drive.step({0.05, 0.0, 0.0}, Eigen::Vector2d(2.6, -1.0 + 0.35 * i));
    if (i < 4) continue;  // the first views are judged by too few
    const Called share = called(drive.frame, drive.segmentation, 2.6 - 0.05 * (i + 1));
    EXPECT_GT(share.person, 0.85) << "frame " << i;
    EXPECT_LT(share.rest, 0.03) << "frame " << i;
  }
}

TEST(Segmentation, KeepsTheWallThatSomebodyWhoWalksAheadUncovers) {
  Drive drive;
  drive.scene = corridor();
  drive.step_s = 0.5;
  for (int i = 0; i < 8; ++i) {
    const double x = 2.6 + 0.45 * i;  // along the wall, which goes on beyond the opening
    drive.step({0.35, 0.0, 0.0}, Eigen::Vector2d(x, 0.7));
    if (i < 3) continue;
    const Called share = called(drive.frame, drive.segmentation, x - 0.35 * (i + 1));
    EXPECT_GT(share.person, 0.55) << "frame " << i;  // of what is as far: walls and floor too
    EXPECT_LT(share.rest, 0.03) << "frame " << i;
  }
}

TEST(Segmentation, FindsAPersonWhoGoesAtTwoFramesASecond) {
  for (const double side_m : {-0.3, 0.4}) {
    Drive drive;
    drive.step_s = 0.5;
    for (int i = 0; i < 5; ++i) {
      drive.step({0.0, 0.0, 0.0}, Eigen::Vector2d(1.6 + 0.45 * i, side_m));
      if (i < 2) continue;
      const Called share = called(drive.frame, drive.segmentation, 1.6 + 0.45 * i);
      EXPECT_GT(share.person, 0.45) << "frame " << i << " at the side of " << side_m;
    }
  }
}

TEST(Segmentation, RefusesWhatIsSeenOnAPersonAndNothingElse) {
  Pose2 T_world_robot;
  DetectorBank bank, alone;
  const auto backend = makeEdgeLineBackend("opencv", {});
  int on_person = 0, refused = 0, pillar = 0;
  for (std::size_t i = 0; i < 14; ++i) {
    T_world_robot = T_world_robot * kAhead;
    const Eigen::Vector2d p_person(2.6, -1.2 + 0.08 * static_cast<double>(i));
    const Frame frame = seenFrom(room(), T_world_robot, p_person, i);
    const auto edges = backend->extract(frame.gray);
    const auto all = bank.detect(frame, edges, i > 0 ? std::optional(kAhead) : std::nullopt);
    if (i < 5) continue;
    const Eigen::Vector2d p = transform(T_world_robot.inverse(), p_person);
    for (const Detection& detection : all) {
      if (detection.kind() == LandmarkKind::kFloorEdge || !detection.measurement.hasRange())
        continue;
      const auto& z = detection.measurement.z;
      const Eigen::Vector2d at(z[1] * std::cos(z[0]), z[1] * std::sin(z[0]));
      if ((at - p).norm() < 0.4) {
        on_person += detection.accepted();
        refused += detection.refusal == "moving";
      }
      const Eigen::Vector2d p_pillar = transform(T_world_robot.inverse(), {3.0, 1.0});
      if ((at - p_pillar).norm() < 0.35) pillar += detection.accepted();
    }
  }
  EXPECT_EQ(on_person, 0);
  EXPECT_GE(refused, 9);
  EXPECT_GE(pillar, 14);
}

TEST(Segmentation, ForgetsFormerViewsWhenMotionIsNotKnown) {
  Drive drive;
  for (int i = 0; i < 12; ++i) drive.step({0.0, 0.0, 0.0}, Eigen::Vector2d(2.6, -1.0 + 0.09 * i));
  ASSERT_GT(drive.segmentation.count(Segmentation::kMoving), 0U);
  const Segmentation after = drive.segmenter.segment(drive.frame, std::nullopt);
  EXPECT_EQ(after.count(Segmentation::kMoving), 0U);
}

TEST(Segmentation, TakesAWrongMotionForWhatItIs) {
  Drive drive;
  for (int i = 0; i < 12; ++i) drive.step({0.0, 0.0, 0.0}, std::nullopt);
  // The robot holds still, the odometry says it went back a metre: everything seems nearer.
  Frame frame = drive.frame;
  frame.stamp_s += 0.1;
  const Segmentation after = drive.segmenter.segment(frame, Pose2{-1.0, 0.0, 0.0});
  EXPECT_EQ(after.count(Segmentation::kMoving), 0U);
}

TEST(Segmentation, KeepsAnEdgeBesideSomebodyNearer) {
  const Frame frame = seenFrom(room(), {}, std::nullopt, 0);
  Segmentation segmentation;
  segmentation.cell_px = 4;
  segmentation.columns = kWidth_px / 4;
  segmentation.rows = kHeight_px / 4;
  const std::size_t count = static_cast<std::size_t>(segmentation.columns * segmentation.rows);
  segmentation.labels.assign(count, Segmentation::kStatic);
  segmentation.near_m.assign(count, 4.5F);
  for (int row = 0; row < segmentation.rows; ++row)
    for (int column = 40; column < 50; ++column) {
      const auto cell = static_cast<std::size_t>(row * segmentation.columns + column);
      segmentation.labels[cell] = Segmentation::kMoving;
      segmentation.near_m[cell] = 2.0F;
    }
  const auto edge = [](double u, double range_m) {
    Detection detection;
    detection.measurement.kind = LandmarkKind::kPillarEdge;
    const Eigen::Index size = range_m > 0.0 ? 2 : 1;
    detection.measurement.z = Eigen::VectorXd::Zero(size);
    if (range_m > 0.0) detection.measurement.z[1] = range_m;
    detection.measurement.R = Eigen::MatrixXd::Identity(size, size);
    detection.a_px = {u, 25.0};
    detection.b_px = {u, 125.0};
    return detection;
  };
  // The mover begins at column 160.
  Detections detections{edge(155.0, 4.5), edge(155.0, 2.0), edge(155.0, 0.0), edge(165.0, 4.5)};
  refuseSegmented(frame, segmentation, {}, detections);
  EXPECT_EQ(detections[0].refusal, "");
  for (const std::size_t i : {1U, 2U, 3U}) EXPECT_EQ(detections[i].refusal, "moving") << i;
}

TEST(Segmentation, FindsAPaneAndNotAWayOut) {
  Frame frame = seenFrom(room(), {}, std::nullopt, 0);
  Segmenter segmenter;
  EXPECT_EQ(segmenter.segment(frame, std::nullopt).count(Segmentation::kReflective), 0U);
  const cv::Rect pane(140, 40, 80, 70);
  Frame with_pane = frame;
  with_pane.depth_m = frame.depth_m.clone();
  with_pane.depth_m(pane).setTo(0.0F);
  const Segmentation seen = segmenter.segment(with_pane, std::nullopt);
  EXPECT_EQ(seen.at({180.0, 75.0}), Segmentation::kReflective);
  EXPECT_EQ(seen.at({100.0, 75.0}), Segmentation::kStatic);
  // The same hole where everything around it lies at the end of the sensor's reach.
  Frame way_out = with_pane;
  way_out.depth_m = with_pane.depth_m * 1.3;
  SegmentationOptions options;
  options.sensor_reach_m = 5.8;
  EXPECT_EQ(Segmenter(options).segment(way_out, std::nullopt).count(Segmentation::kReflective), 0U);
}

TEST(Segmentation, RefusesWhatIsSeenInAPaneButNotItsFrame) {
  Frame frame = seenFrom(room(), {}, std::nullopt, 0);
  const cv::Rect pane(130, 20, 90, 110);
  frame.depth_m(pane).setTo(0.0F);
  const auto edge = [](double u) {
    Detection detection;
    detection.measurement.kind = LandmarkKind::kPillarEdge;
    detection.measurement.z = Eigen::VectorXd::Zero(1);
    detection.measurement.R = Eigen::MatrixXd::Identity(1, 1);
    detection.a_px = {u, 25.0};
    detection.b_px = {u, 125.0};
    return detection;
  };
  Detections detections{edge(175.0), edge(130.0), edge(60.0)};
  refuseSegmented(frame, Segmenter().segment(frame, std::nullopt), {}, detections);
  EXPECT_EQ(detections[0].refusal, "reflective");
  EXPECT_TRUE(detections[1].accepted());
  EXPECT_TRUE(detections[2].accepted());
}

}  // namespace
}  // namespace colonnade::testing
