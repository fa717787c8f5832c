// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/building.hpp"

#include <gtest/gtest.h>

#include <map>

#include "colonnade/base/error.hpp"
#include "colonnade/simulation/floor_plan.hpp"
#include "colonnade/simulation/truth.hpp"
#include "test_worlds.hpp"

namespace colonnade {
namespace {

const VerticalEdge* edgeAt(const Building& building, double x, double y) {
  for (const auto& edge : building.edges) {
    if ((edge.p_world - Eigen::Vector2d(x, y)).norm() < 1e-9) return &edge;
  }
  return nullptr;
}

double lengthOfFloorLines(const Building& building) {
  double sum = 0.0;
  for (const auto& line : building.floor_lines) sum += (line.b - line.a).norm();
  return sum;
}

TEST(Building, roomCornersAreConcaveSlopes) {
  const auto building = buildBuilding(testing::roomWorld());
  for (const auto& [x, y] : {std::pair{-1.0, -2.0}, {5.0, -2.0}, {5.0, 2.0}, {-1.0, 2.0}}) {
    const auto* edge = edgeAt(building, x, y);
    ASSERT_TRUE(edge) << x << " " << y;
    EXPECT_FALSE(edge->convex);
    EXPECT_TRUE(edge->slope);
  }
}

TEST(Building, pilasterHasTwoFrontEdgesThatArePartners) {
  const auto building = buildBuilding(testing::roomWorld());
  // On the wall x = 5 that runs north from y = -2: at 1.0 m, 0.4 m wide, 0.2 m deep.
  const auto* first = edgeAt(building, 4.8, -1.2);
  const auto* second = edgeAt(building, 4.8, -0.8);
  ASSERT_TRUE(first && second);
  EXPECT_TRUE(first->convex && second->convex);
  ASSERT_TRUE(first->partner && second->partner);
  EXPECT_EQ(&building.edges[*first->partner], second);
  EXPECT_EQ(&building.edges[*second->partner], first);
  EXPECT_FALSE(edgeAt(building, 5.0, -1.2)->convex);
  // The foot of the walls: 2 (6 + 4) m and the two flanks of the pilaster.
  EXPECT_NEAR(lengthOfFloorLines(building), 20.4, 1e-9);
}

TEST(Building, doorEdgesPairUpAcrossTheOpening) {
  const auto building = buildBuilding(testing::roomWorld(
      "door wall=r.1 at_m=3 width_m=0.9 recess_m=0.2 frame_m=0.08 protrusion_m=0.02\n"));
  // The wall y = -2 runs east from x = -1: the opening is from x = 1.55 to 2.45.
  const auto* inner = edgeAt(building, 1.55, -1.98);
  const auto* outer = edgeAt(building, 1.47, -1.98);
  ASSERT_TRUE(inner && outer);
  EXPECT_EQ(&building.edges[*inner->partner], edgeAt(building, 2.45, -1.98));
  EXPECT_EQ(&building.edges[*outer->partner], edgeAt(building, 2.53, -1.98));
  ASSERT_TRUE(edgeAt(building, 1.55, -2.2));
  EXPECT_FALSE(edgeAt(building, 1.55, -2.2)->convex);
  EXPECT_DOUBLE_EQ(inner->height_m, 2.05);
}

TEST(Building, pillarHasFourConvexEdges) {
  const auto building =
      buildBuilding(testing::roomWorld("pillar 3 1 size_m=0.4,0.6 turn_deg=90\n"));
  for (const double x : {2.7, 3.3}) {
    for (const double y : {0.8, 1.2}) {
      const auto* edge = edgeAt(building, x, y);
      ASSERT_TRUE(edge) << x << " " << y;
      EXPECT_TRUE(edge->convex && edge->slope && edge->partner);
    }
  }
}

TEST(Building, anOpenDoorLeadsThroughTwoWalls) {
  const auto building = buildBuilding(
      testing::roomWorld("room n  4 2.2  4 5  0 5  0 2.2\n"
                         "door wall=r.3 at_m=3 into=n.4 state=open hinge=right open_deg=90\n"));
  // The wall y = 2 runs west from x = 5: the opening is from x = 1.55 to 2.45.
  ASSERT_EQ(building.gaps.size(), 2U);
  for (const auto& gap : building.gaps) {
    EXPECT_NEAR(gap.a.y(), 2.1, 1e-9);
    EXPECT_NEAR((gap.b - gap.a).norm(), 0.9, 1e-9);
  }
  // Jambs end in edges on both sides, that find their partner across the opening.
  for (const double y : {1.98, 2.22}) {
    const auto* left = edgeAt(building, 1.55, y);
    const auto* right = edgeAt(building, 2.45, y);
    ASSERT_TRUE(left && right) << y;
    EXPECT_TRUE(left->convex && right->convex);
    EXPECT_EQ(&building.edges[*left->partner], right);
  }
  EXPECT_FALSE(edgeAt(building, 1.55, 2.1));  // where the two halves of a jamb meet
  // Seen from the first room the hinge is on the right, x = 2.45; the leaf points north.
  EXPECT_TRUE(edgeAt(building, 2.45, 2.22 + 0.9));
  const auto plan = drawFloorPlan(building, {0, 0});
  const int row = plan.cells.rows - 1 - static_cast<int>((4.0 - plan.origin.y()) / 0.05);
  const int column = static_cast<int>((2.0 - plan.origin.x()) / 0.05);
  EXPECT_EQ(static_cast<int>(plan.cells.at<unsigned char>(row, column)), 254);
}

TEST(Building, aSkirtingBoardThatStandsOutMovesTheFloorLine) {
  const auto building =
      buildBuilding(parseWorld("room r 0 0 5 0 5 4 0 4 skirting_out_m=0.02\ndrive 1 1\n", "w"));
  ASSERT_EQ(building.floor_lines.size(), 4U);
  // The south wall's: 2 cm inside, shorter by 2 cm at both concave corners.
  EXPECT_NEAR((building.floor_lines[0].a - Eigen::Vector2d(0.02, 0.02)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((building.floor_lines[0].b - Eigen::Vector2d(4.98, 0.02)).norm(), 0.0, 1e-9);
  EXPECT_TRUE(edgeAt(building, 5, 0));
}

TEST(Building, roundPillarsHaveNoEdgesAndFurnitureStandsOnItsLegs) {
  const auto bare = buildBuilding(testing::roomWorld());
  const auto round = buildBuilding(testing::roomWorld("column 3 1 diameter_m=0.4\n"));
  EXPECT_EQ(round.edges.size(), bare.edges.size());
  EXPECT_EQ(round.floor_lines.size(), bare.floor_lines.size());
  EXPECT_GT(round.outline.size(), bare.outline.size());
  const auto table = buildBuilding(testing::roomWorld("table 3 1 size_m=1.2,0.7\n"));
  EXPECT_EQ(table.edges.size(), bare.edges.size() + 16);
  const auto cabinet =
      buildBuilding(testing::roomWorld("cabinet 3 1 size_m=0.4,0.8 height_m=1.2\n"));
  const auto* edge = edgeAt(cabinet, 2.8, 0.6);
  ASSERT_TRUE(edge);
  EXPECT_DOUBLE_EQ(edge->height_m, 1.2);
}

TEST(Building, facesKnowGlassAndMirrors) {
  const auto building = buildBuilding(testing::roomWorld(
      "wall pane 2 -2 2 -1 material=glass skirting_m=0\nboard wall=r.3 at_m=2 material=mirror\n"));
  std::map<Surface, int> count;
  for (const auto& face : building.faces) ++count[face.surface];
  EXPECT_EQ(count[Surface::kGlass], 1);
  EXPECT_EQ(count[Surface::kMirror], 1);
}

TEST(Building, wallsOfOneLineHaveNoEdgeBetweenThem) {
  const auto building =
      buildBuilding(parseWorld("wall a 0 0 2 0\nwall b 2 0 5 0\ndrive 1 1\n", "w"));
  EXPECT_FALSE(edgeAt(building, 2, 0));
  ASSERT_TRUE(edgeAt(building, 5, 0));  // a wall that ends in the open
  EXPECT_TRUE(edgeAt(building, 5, 0)->convex);
}

TEST(Truth, listsEveryKindWithDirectionsAndPairs) {
  const auto world = testing::roomWorld();
  const auto building = buildBuilding(world);
  const Truth truth(world, building);
  std::array<int, kLandmarkKinds> count{};
  for (std::size_t i = 0; i < truth.landmarks().size(); ++i) {
    const auto& landmark = truth.landmarks()[i];
    EXPECT_EQ(number(landmark.id), static_cast<int>(i));
    ++count[static_cast<std::size_t>(landmark.kind)];
    EXPECT_EQ(landmark.direction.has_value(), landmark.kind == LandmarkKind::kFloorEdge);
    if (landmark.direction) {
      EXPECT_GE(*landmark.direction, 0.0);
      EXPECT_LT(*landmark.direction, kPi);
      const Eigen::Vector2d along(std::cos(*landmark.direction), std::sin(*landmark.direction));
      const Eigen::Vector2d extent = landmark.extent_b - landmark.extent_a;
      EXPECT_NEAR(std::abs(along.dot(extent)), extent.norm(), 1e-9);
    }
  }
  EXPECT_EQ(count[0], 8);  // four corners, four edges of the pilaster
  EXPECT_EQ(count[1], 8);  // three walls, the fourth in two pieces, three sides of the pilaster
  EXPECT_EQ(count[2], 8);
}

TEST(FloorPlan, isFreeInsideAndUnknownOutside) {
  const auto building = buildBuilding(testing::roomWorld("pillar 3 1\n"));
  const auto plan = drawFloorPlan(building, {0, 0});
  const auto at = [&](double x, double y) {
    const int column = static_cast<int>((x - plan.origin.x()) / plan.resolution_m);
    const int row =
        plan.cells.rows - 1 - static_cast<int>((y - plan.origin.y()) / plan.resolution_m);
    return static_cast<int>(plan.cells.at<unsigned char>(row, column));
  };
  EXPECT_EQ(at(0.0, 0.0), 254);
  EXPECT_EQ(at(4.7, 1.7), 254);
  EXPECT_EQ(at(-1.3, 0.0), 205);
  EXPECT_EQ(at(4.9, -1.0), 205);  // inside the pilaster
  EXPECT_EQ(at(3.0, 1.0), 205);   // inside the pillar
  EXPECT_EQ(at(5.01, 0.02), 0);
  EXPECT_THROW(drawFloorPlan(building, {40, 0}), Error);
}

}  // namespace
}  // namespace colonnade
