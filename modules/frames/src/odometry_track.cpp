// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "odometry_track.hpp"

#include <algorithm>
#include <cmath>

#include "colonnade/base/angle.hpp"

namespace colonnade {

void MotionSum::add(const Pose2& T_before_after, const std::optional<Eigen::Matrix3d>& covariance) {
  Eigen::Matrix3d J_sum, J_increment;
  T_start_end_ = compose(T_start_end_, T_before_after, &J_sum, &J_increment);
  if (covariance)
    covariance_ = J_sum * covariance_ * J_sum.transpose() +
                  J_increment * *covariance * J_increment.transpose();
  else
    covariance_known_ = false;
}

std::optional<Eigen::Matrix3d> MotionSum::covariance() const {
  if (!covariance_known_) return std::nullopt;
  return covariance_;
}

bool OdometryTrack::add(double stamp_s, const Pose2& T_odom_robot) {
  if (!readings_.empty() && stamp_s <= readings_.back().stamp_s) return false;
  readings_.push_back({stamp_s, T_odom_robot});
  return true;
}

Pose2 OdometryTrack::between(const Reading& a, const Reading& b, double stamp_s) {
  const double share = (stamp_s - a.stamp_s) / (b.stamp_s - a.stamp_s);
  const auto& from = a.T_odom_robot;
  const auto& to = b.T_odom_robot;
  return {from.x + share * (to.x - from.x), from.y + share * (to.y - from.y),
          wrapAngle(from.phi + share * wrapAngle(to.phi - from.phi))};
}

std::optional<Pose2> OdometryTrack::at(double stamp_s) const {
  if (readings_.empty()) return std::nullopt;
  const auto after =
      std::lower_bound(readings_.begin(), readings_.end(), stamp_s,
                       [](const Reading& r, double stamp) { return r.stamp_s < stamp; });
  if (after != readings_.end() && after->stamp_s == stamp_s) return after->T_odom_robot;
  const bool before_first = after == readings_.begin(), behind_last = after == readings_.end();
  if (before_first || behind_last) {
    const Reading& nearest = before_first ? readings_.front() : readings_.back();
    if (std::abs(stamp_s - nearest.stamp_s) > kLongestReach_s) return std::nullopt;
    if (readings_.size() < 2) return nearest.T_odom_robot;
    const std::size_t first = before_first ? 0 : readings_.size() - 2;
    const Reading &a = readings_[first], &b = readings_[first + 1];
    if (b.stamp_s - a.stamp_s > kLongestGap_s) return nearest.T_odom_robot;
    return between(a, b, stamp_s);
  }
  const Reading &a = *(after - 1), &b = *after;
  if (b.stamp_s - a.stamp_s > kLongestGap_s) return std::nullopt;
  return between(a, b, stamp_s);
}

void OdometryTrack::forgetBefore(double stamp_s) {
  while (readings_.size() > 2 && readings_[2].stamp_s < stamp_s) readings_.pop_front();
}

}  // namespace colonnade
