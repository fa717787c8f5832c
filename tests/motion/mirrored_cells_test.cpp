// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mirrored_cells.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "colonnade/motion/motion_estimator.hpp"
#include "synthetic_scene.hpp"

namespace colonnade {
namespace {

using testing::cameraInWorld;
using testing::mountingOf;
using testing::Scene;

/// A corridor whose floor shows more of the walls it mirrors than of itself.
Scene corridor(double gloss) {
  Scene scene = Scene::corridor(true, true);
  scene.walls.back().offset = 6.0;
  scene.gloss = gloss;
  return scene;
}

Eigen::Isometry3d cameraAt(double x) { return cameraInWorld(x, 0.1, 0.9, 0.0, radians(20.0)); }

/// The floor of a picture, seen again after 0.1 m.
MirroredCells cellsOf(const Scene& scene) {
  const Reference reference = makeReference(makePyramid(scene.render(0, 0.0, cameraAt(0.0)), 4));
  const RgbdPyramid current = makePyramid(scene.render(1, 0.1, cameraAt(0.1)), 4);
  return {current.levels.front().camera, pointsFacingUp(reference), current.levels.front(),
          cameraAt(0.1).inverse() * cameraAt(0.0)};
}

TEST(MirroredCells, ADullFloorMirrorsNothing) {
  const MirroredCells cells = cellsOf(corridor(0.0));
  EXPECT_GT(cells.judged(), 30);
  EXPECT_LE(cells.certain(), cells.judged() / 50);
}

TEST(MirroredCells, APolishedFloorMirrorsInManyPlaces) {
  const MirroredCells cells = cellsOf(corridor(0.7));
  EXPECT_GT(cells.judged(), 30);
  EXPECT_GT(cells.certain(), cells.judged() / 5);
  EXPECT_TRUE(cells.mirrorSomewhere());
}

TEST(MirroredCells, NothingIsJudgedWhileTheCameraStands) {
  const Scene scene = corridor(0.7);
  const Reference reference = makeReference(makePyramid(scene.render(0, 0.0, cameraAt(0.0)), 4));
  const MirroredCells cells(reference.pyramid.levels.front().camera, pointsFacingUp(reference),
                            reference.pyramid.levels.front(), Eigen::Isometry3d::Identity());
  EXPECT_EQ(cells.judged(), 0);
  EXPECT_FALSE(cells.mirrorSomewhere());
}

TEST(MirroredCells, WallsAreNoFloor) {
  const Scene scene = corridor(0.0);
  const Reference reference = makeReference(makePyramid(scene.render(0, 0.0, cameraAt(0.0)), 4));
  const auto points = pointsFacingUp(reference);
  EXPECT_GT(points.size(), 100u);
  for (const PhotometricPoint& point : points)
    EXPECT_LT((cameraAt(0.0) * point.p_reference.cast<double>()).z(), 0.25);
}

TEST(PolishedFloor, IsBelievedAfterSomeFramesAndForgottenAgain) {
  const MirroredCells dull = cellsOf(corridor(0.0)), polished = cellsOf(corridor(0.7));
  PolishedFloor floor;
  EXPECT_FALSE(floor.isLikely());
  for (int i = 0; i < 40; ++i) floor.look(dull);
  EXPECT_FALSE(floor.isLikely());
  for (int i = 0; i < 40; ++i) floor.look(polished);
  EXPECT_TRUE(floor.isLikely());
  for (int i = 0; i < 400; ++i) floor.look(dull);
  EXPECT_FALSE(floor.isLikely());
}

/// How far a camera with depth, carried straight on for 2 m, believes to have come.
double wayMeasured(const Scene& scene) {
  MotionOptions options;
  options.source = "visual";
  MotionEstimator estimator(options, std::make_shared<CameraTracker>(options));
  Pose2 T_first_last;
  for (int i = 0; i <= 40; ++i) {
    Frame frame = scene.render(static_cast<std::size_t>(i), 0.1 * i, cameraAt(0.05 * i));
    frame.T_robot_camera = mountingOf(cameraAt(0.05 * i));
    T_first_last = T_first_last * estimator.increment(frame).T_previous_robot;
  }
  return T_first_last.x;
}

TEST(VisualOdometryOnAPolishedFloor, IsNotHeldBackByWhatItMirrors) {
  EXPECT_NEAR(wayMeasured(corridor(0.0)), 2.0, 0.01);
  EXPECT_NEAR(wayMeasured(corridor(0.7)), 2.0, 0.02);
}

}  // namespace
}  // namespace colonnade
