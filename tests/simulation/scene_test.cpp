// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// What the content of a world looks like.
#include <gtest/gtest.h>

#include "colonnade/simulation/renderer.hpp"
#include "test_worlds.hpp"

namespace colonnade {
namespace {

class SceneTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto why = whyNoRendering(); !why.empty()) GTEST_SKIP() << why;
  }

  /// From the robot's start, looking at the far wall x = 5.
  static RenderedView view(const World& world, double time_s = 0.0) {
    Renderer renderer(world, buildBuilding(world));
    return renderer.render(world.camera.T_robot_camera(), time_s);
  }
  static cv::Vec3b pixel(const RenderedView& view, int u, int v) {
    return view.colour.at<cv::Vec3b>(v, u);
  }
  static double difference(const cv::Vec3b& a, const cv::Vec3b& b) { return cv::norm(cv::Vec3d(a) - cv::Vec3d(b)); }
};

TEST_F(SceneTest, glassLetsWhatIsBehindShineThrough) {
  const std::string red = "material red pattern=plain colour=220,20,20\npillar 4 0 material=red\n";
  const auto bare = view(testing::roomWorld(red));
  const auto clear =
      view(testing::roomWorld(red + "material pane surface=glass opacity=0.3 colour=20,20,220\n"
                                    "wall p 2 -1 2 1 material=pane skirting_m=0\n"));
  const auto opaque =
      view(testing::roomWorld(red + "material pane surface=glass opacity=1 colour=20,20,220\n"
                                    "wall p 2 -1 2 1 material=pane skirting_m=0\n"));
  const int u = 80, v = 40;
  ASSERT_GT(pixel(bare, u, v)[2], 2 * pixel(bare, u, v)[0]);  // red
  EXPECT_GT(pixel(opaque, u, v)[0], 2 * pixel(opaque, u, v)[2]);
  const cv::Vec3b expected = 0.7 * pixel(bare, u, v) + 0.3 * pixel(opaque, u, v);
  EXPECT_LT(difference(pixel(clear, u, v), expected), 12.0);
}

TEST_F(SceneTest, peopleWalkAndAreInTheWayOfTheDepthSensor) {
  const auto world = testing::roomWorld("walker 3 -1.5 3 1.5 speed_m_per_s=1 clothes=200,30,30\n");
  const auto away = view(world, 0.0);
  const auto ahead = view(world, 1.5);
  const int u = 80, v = 25;  // the belt of someone 3 m ahead
  EXPECT_GT(away.depth_m.at<float>(v, u), 4.0F);
  EXPECT_NEAR(ahead.depth_m.at<float>(v, u), 2.9F, 0.35F);
  EXPECT_GT(difference(pixel(away, u, v), pixel(ahead, u, v)), 30.0);
}

TEST_F(SceneTest, aGlossyFloorMirrorsAndKeepsItsDepth) {
  const std::string white =
      "material white pattern=plain colour=250,250,250 grain=0 blotches=0\n"
      "material black pattern=plain colour=30,30,30 grain=0 blotches=0";
  const std::string more = "\nfloor material=black\npillar 3 0 size_m=0.6,0.6 material=white\n";
  const auto dull = view(testing::roomWorld(white + more));
  const auto glossy = view(testing::roomWorld(white + " gloss=0.3" + more));
  // The floor 2.2 m ahead: in the mirror there is the pillar.
  const int u = 80, v = 92;
  EXPECT_GT(pixel(glossy, u, v)[1], pixel(dull, u, v)[1] + 20);
  EXPECT_NEAR(glossy.depth_m.at<float>(v, u), dull.depth_m.at<float>(v, u), 1e-4);
}

}  // namespace
}  // namespace colonnade
