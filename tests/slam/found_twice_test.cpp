// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "colonnade/slam/loop_closer.hpp"

namespace colonnade {
namespace {

using Points = std::vector<Eigen::Vector2d>;

/// Edges seen from the origin, a long way that leaves the robot unsure where it is, and edges
/// founded anew from there while the old ones sleep.
class FoundTwiceTest : public ::testing::Test {
 protected:
  std::vector<LandmarkId> found(const Points& edges) {
    std::vector<LandmarkId> ids;
    for (int look = 0; look < 10; ++look) {
      for (std::size_t k = 0; k < edges.size(); ++k) {
        Detection detection;
        Measurement& m = detection.measurement;
        m.kind = LandmarkKind::kDepthSlope;
        m.z.resize(2);
        m.z << std::atan2(edges[k].y(), edges[k].x()), edges[k].norm();
        m.R = Eigen::Vector2d(1e-5, 1e-4).asDiagonal();
        if (look == 0) ids.push_back(*filter_.addLandmark(m));
        const Match match{ids[k], m};
        if (look > 0) filter_.update({&match, 1});
        book_.observe(ids[k], detection, ++stamp_s_, filter_);
      }
      book_.observeTogether(ids);
    }
    return ids;
  }
  void comeBack(double sigma_m = 0.06) {
    filter_.predict({}, Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, 1e-6).asDiagonal());
    book_.drive(30.0);
    for (const Block& block : filter_.state().blocks) book_.setAsleep(block.id, true);
  }
  std::vector<std::pair<LandmarkId, LandmarkId>> twins() const {
    std::vector<std::pair<LandmarkId, LandmarkId>> pairs;
    for (const Twins& t : LoopCloser(LoopOptions{}).foundTwice(filter_, book_))
      pairs.emplace_back(t.kept, t.twin);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
  }

  EkfSlam filter_{FilterOptions{}};
  LandmarkBook book_;
  double stamp_s_ = 0.0;
};

const Points kFrame = {{3.0, 1.0}, {3.12, 1.0}};

TEST_F(FoundTwiceTest, TwoEdgesOfAFrameTellWhichIsWhich) {
  const auto then = found(kFrame);
  comeBack();
  const auto now = found(kFrame);
  ASSERT_EQ(2u, twins().size());
  EXPECT_EQ(std::pair(then[0], now[0]), twins()[0]);
  EXPECT_EQ(std::pair(then[1], now[1]), twins()[1]);
  // Made one, the old ones are known again.
  std::vector<Twins> both{{then[0], now[0]}, {then[1], now[1]}};
  ASSERT_TRUE(fuse(both, {}, filter_, book_));
  EXPECT_FALSE(book_.isAsleep(then[0]));
  EXPECT_TRUE(book_.seenOnWay(then[0]).returned_m);
  EXPECT_FALSE(filter_.state().find(now[0]));
  EXPECT_TRUE(twins().empty());
}

TEST_F(FoundTwiceTest, OneEdgeBesideTwoMayBeEither) {
  found(kFrame);
  comeBack();
  found({kFrame[1]});
  EXPECT_TRUE(twins().empty());
}

TEST_F(FoundTwiceTest, OneEdgeBesideOneIsThatOne) {
  const auto then = found({kFrame[0]});
  comeBack();
  const auto now = found({kFrame[0]});
  ASSERT_EQ(1u, twins().size());
  EXPECT_EQ(std::pair(then[0], now[0]), twins()[0]);
}

TEST_F(FoundTwiceTest, EdgesAtEqualDistancesFitInMoreThanOneWay) {
  found({{3.0, 1.0}, {3.12, 1.0}, {3.24, 1.0}});
  comeBack();
  found({{3.0, 1.0}, {3.12, 1.0}});
  EXPECT_TRUE(twins().empty());
}

TEST_F(FoundTwiceTest, EdgesInAnotherRhythmAreOthers) {
  found({{3.0, 1.0}, {3.5, 1.0}, {4.2, 1.0}});
  comeBack(0.1);
  found({{3.1, 1.0}, {3.4, 1.0}, {4.4, 1.0}});
  EXPECT_TRUE(twins().empty());
}

TEST_F(FoundTwiceTest, ARobotThatMayBeElsewhereNeedsAClosing) {
  found(kFrame);
  comeBack(0.3);
  found(kFrame);
  EXPECT_TRUE(twins().empty());
}

}  // namespace
}  // namespace colonnade
