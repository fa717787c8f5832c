// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/detection_score.hpp"

#include <gtest/gtest.h>

namespace colonnade {
namespace {

ImageLine upright(double column, double top, double bottom,
                  std::optional<double> distance_m = std::nullopt) {
  return {LandmarkKind::kPillarEdge, {column, top}, {column, bottom}, distance_m};
}

TrueImageLine truth(double column, double top, double bottom, double distance_m = 3.0,
                    double contrast = 40.0) {
  TrueImageLine line;
  static_cast<ImageLine&>(line) = upright(column, top, bottom, distance_m);
  line.visible_px = bottom - top;
  line.contrast = contrast;
  return line;
}

class PillarScore : public ::testing::Test {
 protected:
  const DetectionScore::Kind& scored(const std::vector<ImageLine>& detected,
                                     const std::vector<TrueImageLine>& there) {
    score_.add(detected, there);
    return score_.of(LandmarkKind::kPillarEdge);
  }
  DetectionScore score_;
};

TEST_F(PillarScore, CountsWhatIsRightAndWhatIsFound) {
  const auto& kind = scored({upright(101.0, 50, 250, 3.1), upright(200.0, 50, 250)},
                            {truth(100.0, 40, 260), truth(300.0, 40, 260)});
  EXPECT_DOUBLE_EQ(0.5, kind.precision());
  EXPECT_DOUBLE_EQ(0.5, kind.recall());
  EXPECT_DOUBLE_EQ(1.0, kind.offsetRms());
  EXPECT_NEAR(0.1, kind.distanceRms(), 1e-12);
}

TEST_F(PillarScore, FaintFarAndShortLinesNeedNotBeFoundButMay) {
  const auto& kind = scored({upright(100, 0, 200)}, {truth(100, 0, 200, 3.0, 5.0),
                                                     truth(200, 0, 200, 9.0), truth(300, 0, 40)});
  EXPECT_EQ(0U, kind.wanted);
  EXPECT_EQ(1U, kind.ignored);
}

TEST_F(PillarScore, EdgesBeyondTheLimitsAreNeitherRightNorWrong) {
  const auto& kind = scored({upright(100, 0, 200), upright(200, 0, 200), upright(300, 0, 40),
                             upright(400, 0, 200), upright(500, 0, 200)},
                            {truth(100, 0, 200, 3.0, 5.0), truth(200, 0, 200, 9.0),
                             truth(300, 0, 40), truth(400, 0, 200)});
  EXPECT_EQ(3U, kind.ignored);
  EXPECT_EQ(1U, kind.right);
  EXPECT_DOUBLE_EQ(0.5, kind.precision());
  EXPECT_DOUBLE_EQ(1.0, kind.recall());
}

TEST_F(PillarScore, AFaintEdgeBesideAStrongOneIsJudgedWithIt) {
  const auto& kind =
      scored({upright(101, 0, 200)}, {truth(100, 0, 200), truth(101, 0, 200, 3.0, 5.0)});
  EXPECT_EQ(0U, kind.ignored);
  EXPECT_DOUBLE_EQ(1.0, kind.precision());
}

TEST_F(PillarScore, SaysWhatIsRightInTheStrictAndInTheWideSense) {
  TrueImageLine foot = truth(100, 0, 200), board = truth(200, 0, 200), leg = truth(300, 0, 200);
  foot.true_class = TrueClass::kStructure;
  board.true_class = TrueClass::kFixed;
  board.called = "fixture";
  leg.true_class = TrueClass::kMovable;
  leg.called = "furniture";
  const auto& kind = scored(
      {upright(100.5, 0, 200), upright(200, 0, 200), upright(300, 0, 200), upright(400, 0, 200)},
      {foot, board, leg});
  EXPECT_DOUBLE_EQ(0.25, kind.precision());
  EXPECT_DOUBLE_EQ(0.5, kind.precisionWide());
  EXPECT_EQ(0U, kind.wanted);  // none of them has to be found
  EXPECT_DOUBLE_EQ(0.5, kind.offsetRms());
  EXPECT_EQ(1U, kind.lie_on.at("furniture"));
  EXPECT_EQ(1U, kind.lie_on.at("nothing"));
}

TEST_F(PillarScore, TheLimitsHoldForWhateverALineLiesOn) {
  TrueImageLine far = truth(100, 0, 200, 9.0), faint = truth(200, 0, 200, 3.0, 5.0);
  TrueImageLine near = truth(300, 0, 200);
  for (TrueImageLine* line : {&far, &faint, &near}) line->true_class = TrueClass::kMovable;
  const auto& kind = scored({upright(100, 0, 200), upright(200, 0, 200), upright(300, 0, 200)},
                            {far, faint, near});
  EXPECT_EQ(2U, kind.ignored);
  EXPECT_DOUBLE_EQ(0.0, kind.precision());
}

TEST_F(PillarScore, CountsOpenDoorsApart) {
  TrueImageLine leaf = truth(200, 0, 200);
  leaf.true_class = TrueClass::kLeaf;
  const auto& kind = scored({upright(100, 0, 200), upright(200, 0, 200), upright(300, 0, 200)},
                            {truth(100, 0, 200), leaf});
  EXPECT_DOUBLE_EQ(1.0 / 3.0, kind.precision());
  EXPECT_DOUBLE_EQ(0.5, kind.precisionNoLeaf());
  EXPECT_DOUBLE_EQ(2.0 / 3.0, kind.precisionWide());
  EXPECT_EQ(1U, kind.wanted);
}

TEST_F(PillarScore, WhatLiesBehindAPaneIsNotKnown) {
  TrueImageLine pane;
  pane.true_class = TrueClass::kPane;
  pane.a_px = {80, 0};
  pane.b_px = {150, 220};
  const auto& kind = scored({upright(100, 0, 200), upright(120, 0, 300), upright(145, 0, 200)},
                            {pane, truth(145, 0, 210)});
  EXPECT_EQ(1U, kind.ignored);  // the second one leaves it
  EXPECT_EQ(1U, kind.right);
  EXPECT_DOUBLE_EQ(0.5, kind.precision());
  EXPECT_EQ(1U, kind.wanted);
}

TEST_F(PillarScore, ALandmarkWithinReachCountsBeforeAMarkBesideIt) {
  TrueImageLine mark = truth(102, 0, 200);
  mark.true_class = TrueClass::kFixed;
  const auto& kind = scored({upright(101.8, 0, 200)}, {mark, truth(100, 0, 200)});
  EXPECT_DOUBLE_EQ(1.0, kind.precision());
  EXPECT_DOUBLE_EQ(1.0, kind.recall());
  EXPECT_NEAR(0.2, kind.offsetRms(), 1e-12);  // but it is the mark that was measured
}

TEST_F(PillarScore, ALineMustLieThereOverItsLength) {
  // Crosses the true one, lies above it, or is of another kind.
  ImageLine slanted = upright(100, 0, 200);
  slanted.b_px.x() += 12.0;
  ImageLine other = upright(100, 0, 200);
  other.kind = LandmarkKind::kFloorEdge;
  const auto& kind = scored({slanted, upright(100, 260, 400), other}, {truth(100, 0, 200)});
  EXPECT_EQ(0U, kind.right);
  EXPECT_EQ(0U, kind.found);
  EXPECT_EQ(1U, score_.of(LandmarkKind::kFloorEdge).detected);
}

TEST_F(PillarScore, TheOrderOfEndsDoesNotMatter) {
  ImageLine reversed = upright(100.5, 0, 200);
  std::swap(reversed.a_px, reversed.b_px);
  const auto& kind = scored({reversed}, {truth(100, 0, 200)});
  EXPECT_DOUBLE_EQ(1.0, kind.precision());
  EXPECT_DOUBLE_EQ(0.5, kind.offsetRms());
}

TEST(ClippedLine, KeepsWhatIsInThePicture) {
  const auto line = clipped(upright(100.0, 147.0, 402.0, 2.0), 320, 240);
  ASSERT_TRUE(line);
  EXPECT_DOUBLE_EQ(147.0, line->a_px.y());
  EXPECT_DOUBLE_EQ(239.0, line->b_px.y());
  EXPECT_DOUBLE_EQ(100.0, line->b_px.x());
  EXPECT_EQ(2.0, line->distance_m);
  EXPECT_FALSE(clipped(upright(400.0, 0.0, 200.0), 320, 240));
  EXPECT_FALSE(clipped(upright(100.0, 250.0, 300.0), 320, 240));
  ImageLine slanted = upright(-10.0, 0.0, 100.0);
  slanted.b_px.x() = 10.0;
  EXPECT_NEAR(50.0, clipped(slanted, 320, 240)->a_px.y(), 1e-12);
}

}  // namespace
}  // namespace colonnade
