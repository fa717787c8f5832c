// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// Which histories of decisions are one.
#include "range_bearing_alike.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "colonnade/filter/covariance.hpp"
#include "map_of_posts.hpp"

namespace colonnade {
namespace {

using Posts = std::vector<Eigen::Vector2d>;

const RangeBearingOptions kOptions;

Posts posts(int count) {
  Posts posts;
  for (int i = 0; i < count; ++i) posts.emplace_back(2.0 + 0.7 * i, (i % 3) * 0.9 - 1.0 + 0.05 * i);
  return posts;
}

Resumption mapOf(const Posts& posts, double sigma_m, const Pose2& T_world = {}) {
  Resumption from = testing::mapOf(posts, sigma_m);
  moveWorld(from.map.state, T_world);
  from.map.state.x.head<3>().setZero();
  from.T_world_robot = T_world * Pose2{0.3, -0.2, 0.4};
  from.covariance = MapStart::startCovariance(0.5 * sigma_m, 0.2 * sigma_m);
  return from;
}

RangeBearingHypothesis historyOf(const Resumption& from, const FilterOptions& filter = {},
                                 const RangeBearingOptions& options = kOptions) {
  return {options, filter, from};
}

/// How many remain, the likelier first.
std::size_t remaining(const RangeBearingHypothesis& likelier, const RangeBearingHypothesis& other) {
  ReadingHistories histories;
  std::vector<RangeBearingHypothesis> hypotheses{likelier, other};
  for (int i = 0; i < 2; ++i)
    hypotheses[static_cast<std::size_t>(i)].leaf =
        histories.add(ReadingHistories::kRoot, LandmarkId{i});
  mergeAlike(histories, hypotheses);
  return hypotheses.size();
}

TEST(AlikeHistories, AnOutlookIsAsUnsureAsItsNumericJacobianSays) {
  RangeBearingHypothesis history = historyOf(mapOf(posts(4), 0.2));
  Measurement m;
  m.kind = LandmarkKind::kPillarEdge;
  m.z = Eigen::Vector2d(0.1, 2.2);
  m.R = Eigen::Vector2d(0.01, 0.02).asDiagonal();
  const Match match{LandmarkId{2}, m};
  ASSERT_TRUE(history.update({&match, 1}, 1.0).front());  // robot and map have much in common
  const State& state = history.filter.state();
  const auto seen = [](const Eigen::VectorXd& x, int at) {
    return transform(Pose2{x(0), x(1), x(2)}.inverse(), x.segment<2>(at));
  };
  for (const Block& block : state.blocks) {
    Eigen::MatrixXd J(2, state.x.size());
    constexpr double kStep = 1e-6;
    for (Eigen::Index i = 0; i < J.cols(); ++i) {
      const Eigen::VectorXd d = kStep * Eigen::VectorXd::Unit(J.cols(), i);
      J.col(i) = (seen(state.x + d, block.offset) - seen(state.x - d, block.offset)) / (2 * kStep);
    }
    const Outlook outlook = outlookOf(history, block);
    EXPECT_LT((outlook.p_robot - seen(state.x, block.offset)).norm(), 1e-12);
    EXPECT_LT((outlook.covariance - J * state.P * J.transpose()).norm(), 1e-8);
  }
}

TEST(AlikeHistories, WhereTheWorldIsDoesNotMatter) {
  const auto here = historyOf(mapOf(posts(5), 0.03));
  const auto there = historyOf(mapOf(posts(5), 0.03, {4.0, -7.0, 2.0}));
  EXPECT_EQ(remaining(here, there), 1u);
}

TEST(AlikeHistories, ASensorBesideTheMapHidesNothing) {
  static const RangeBearingOptions kEstimating = [] {
    RangeBearingOptions options;
    options.estimate_sensor = true;
    return options;
  }();
  const auto here = historyOf(mapOf(posts(5), 0.03), {}, kEstimating);
  ASSERT_TRUE(here.filter.sensor());
  EXPECT_EQ(remaining(here, historyOf(mapOf(posts(5), 0.03, {1.0, 2.0, 0.5}), {}, kEstimating)),
            1u);
  EXPECT_EQ(remaining(here, historyOf(mapOf(posts(4), 0.03), {}, kEstimating)), 2u);
}

TEST(AlikeHistories, WhatLandmarksAreCalledDoesNotMatter) {
  Posts other = posts(5);
  std::swap(other[0], other[3]);
  EXPECT_EQ(remaining(historyOf(mapOf(posts(5), 0.03)), historyOf(mapOf(other, 0.03))), 1u);
}

TEST(AlikeHistories, DifferInAPlaceANumberOrAnIdentity) {
  const auto likelier = historyOf(mapOf(posts(5), 0.03));
  Posts moved = posts(5);
  moved[4] += Eigen::Vector2d(0.0, 0.1);
  EXPECT_EQ(remaining(likelier, historyOf(mapOf(moved, 0.03))), 2u);
  EXPECT_EQ(remaining(likelier, historyOf(mapOf(posts(4), 0.03))), 2u);
  Posts twice = posts(5);
  twice[0] = twice[1];  // one of two in the other's place, and one where there is none
  EXPECT_EQ(remaining(likelier, historyOf(mapOf(twice, 0.03))), 2u);
  Resumption named = mapOf(posts(5), 0.03);
  named.map.identities[LandmarkId{2}] = 7;
  EXPECT_EQ(remaining(likelier, historyOf(named)), 2u);
}

/// In a world nobody knows the place of, either, a shift of one landmark is a difference.
TEST(AlikeHistories, DifferInWhatAnUnsureWorldWouldHide) {
  const auto unsure = [](const Posts& posts) {
    Resumption from = mapOf(posts, 0.01);
    const Eigen::Index size = from.map.state.x.size() - 3;  // all of it may be a metre off
    from.map.state.P.bottomRightCorner(size, size) +=
        Eigen::MatrixXd::Identity(2, 2).replicate(size / 2, size / 2);
    return from;
  };
  // The robot has the same metre in common with the map once it has seen two posts.
  const auto settled = [&](const Posts& at) {
    auto history = historyOf(unsure(at));
    history.filter.placeRobot(history.filter.pose(), MapStart::startCovariance(2.0, 1.0));
    for (int look = 0; look < 3; ++look)
      for (const Block& block : history.filter.state().blocks) {
        Measurement m;
        m.kind = LandmarkKind::kPillarEdge;
        const Eigen::Vector2d p = transform(Pose2{0.3, -0.2, 0.4}.inverse(),
                                            at[static_cast<std::size_t>(number(block.id) - 1)]);
        m.z = Eigen::Vector2d(std::atan2(p.y(), p.x()), p.norm());
        m.R = 1e-4 * Eigen::Matrix2d::Identity();
        const Match match{block.id, m};
        history.update({&match, 1}, 1.0);
      }
    return history;
  };
  Posts moved = posts(5);
  moved[4] += Eigen::Vector2d(0.0, 0.1);
  const auto history = settled(posts(5));
  ASSERT_GT(history.filter.state().P.diagonal().tail(4).minCoeff(), 0.1);
  EXPECT_EQ(remaining(history, settled(posts(5))), 1u);
  EXPECT_EQ(remaining(history, settled(moved)), 2u);
}

TEST(AlikeHistories, AFarLessSureOneIsAnotherOne) {
  const auto sure = historyOf(mapOf(posts(5), 0.03)), unsure = historyOf(mapOf(posts(5), 0.15));
  EXPECT_EQ(remaining(sure, unsure), 2u);
  EXPECT_EQ(remaining(unsure, sure), 1u);
}

TEST(AlikeHistories, DifferInWhatRests) {
  FilterOptions filter;
  filter.active_landmarks = 3;
  const auto resting = [&](const Posts& posts) {
    auto history = historyOf(mapOf(posts, 0.03), filter);
    history.focus({});
    EXPECT_FALSE(history.filter.resting().empty());
    return history;
  };
  const auto likelier = resting(posts(12));
  EXPECT_EQ(remaining(likelier, resting(posts(12))), 1u);
  auto fewer = resting(posts(12));
  fewer.filter.remove(LandmarkId{12});
  EXPECT_EQ(remaining(likelier, fewer), 2u);
  Posts moved = posts(12);
  moved.back() += Eigen::Vector2d(0.0, 0.5);
  EXPECT_EQ(remaining(likelier, resting(moved)), 2u);
}

TEST(AlikeHistories, InAMapThatStaysOnlyOldDecisionsCount) {
  Resumption fixed = mapOf(posts(5), 0.03);
  fixed.localize = true;
  EXPECT_EQ(remaining(historyOf(fixed), historyOf(fixed)), 2u);
}

}  // namespace
}  // namespace colonnade
