// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "range_bearing_hypothesis.hpp"

namespace colonnade {

/// Two histories whose robots, or landmarks as seen from the robot, are so many squared deviations
/// apart say the same: what is to come cannot tell them apart.
inline constexpr double kAlike2 = 0.5;
/// Unless the less likely one is far less sure (ratio of deviations, in each direction): a robot
/// that may be anywhere is another one than a robot that is here.
inline constexpr double kFarLessSure = 2.0;

/// A landmark as the robot has it before itself.
struct Outlook {
  Eigen::Vector2d p_robot;
  Eigen::Matrix2d covariance;
  std::optional<int> identity;

  bool agrees(const Outlook& likelier) const;
};
/// Of an active point. No landmark is known better than 1e-5 m.
Outlook outlookOf(const RangeBearingHypothesis& history, const Block& block);

/// Of hypotheses, likeliest first, that expect the same from now on the likelier one remains, so
/// that those side by side really differ (Reid, IEEE Transactions on Automatic Control 24(6),
/// 1979): those that differ only in decisions long past, and, in a map that grows, those in which
/// every landmark lies alike before the robot and bears the same identity, and the same ones rest.
void mergeAlike(const ReadingHistories& histories, std::vector<RangeBearingHypothesis>& hypotheses);

}  // namespace colonnade
