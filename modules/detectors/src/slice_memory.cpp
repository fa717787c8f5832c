// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/slice_memory.hpp"

#include <algorithm>
#include <cmath>

#include "colonnade/base/angle.hpp"

namespace colonnade {
namespace {

constexpr double kFree_m = 0.15;     ///< farther than what is free, along the optical axis
constexpr double kSurface_m = 0.06;  ///< from a surface, noise and drift included
constexpr double kNearest_m = 0.2;
constexpr std::size_t kMostSlices = 48;

}  // namespace

void SliceMemory::add(const DepthProfile& profile) {
  if (profile.empty()) return;
  constexpr double kApart_m = 0.15, kTurn = radians(8.0);
  if (slices_.size() >= 2) {
    const Slice& kept = slices_[slices_.size() - 2];
    const Slice& latest = slices_.back();
    const double along =  // cosine of the turn between them
        kept.R_robot_slice.col(1).dot(latest.R_robot_slice.col(1));
    const double apart_m = (kept.p_robot_camera - latest.p_robot_camera).norm();
    if (apart_m < kApart_m && along > std::cos(kTurn)) slices_.pop_back();
  }
  if (slices_.size() >= kMostSlices) slices_.erase(slices_.begin());
  Slice& slice = slices_.emplace_back();
  slice.z_m.reserve(profile.columns.size());
  for (const auto& column : profile.columns) slice.z_m.push_back(static_cast<float>(column.z));
  slice.focal_px = profile.focal_px;
  slice.R_robot_slice = profile.R_robot_slice;
  slice.p_robot_camera = profile.p_robot_camera;
}

void SliceMemory::move(const Pose2& T_previous_robot) {
  const Pose2 T_robot_previous = T_previous_robot.inverse();
  const Eigen::Matrix2d R_robot_previous = T_robot_previous.rotation();
  const double way_m = T_previous_robot.translation().norm();
  for (Slice& slice : slices_) {
    slice.p_robot_camera = transform(T_robot_previous, slice.p_robot_camera);
    slice.R_robot_slice = R_robot_previous * slice.R_robot_slice;
    slice.way_m += way_m;
  }
  std::erase_if(slices_, [&](const Slice& slice) { return slice.way_m > max_way_m_; });
}

std::optional<double> SliceMemory::Slice::beyond_m(const Eigen::Vector2d& p_robot) const {
  const Eigen::Vector2d p = R_robot_slice.transpose() * (p_robot - p_robot_camera);
  if (p.y() < kNearest_m) return std::nullopt;
  const double middle = 0.5 * (static_cast<double>(z_m.size()) - 1.0);
  const double column = middle + focal_px * p.x() / p.y() + 0.5;
  if (column < 0.0 || column >= static_cast<double>(z_m.size())) return std::nullopt;
  const double z_m_there = z_m[static_cast<std::size_t>(column)];
  if (z_m_there <= 0.0) return std::nullopt;
  return z_m_there - p.y();
}

bool SliceMemory::isFree(const Eigen::Vector2d& p_robot) const {
  return std::any_of(slices_.rbegin(), slices_.rend(), [&](const Slice& slice) {
    const auto beyond_m = slice.beyond_m(p_robot);
    return beyond_m && *beyond_m > kFree_m;
  });
}

bool SliceMemory::isSurface(const Eigen::Vector2d& p_robot) const {
  return std::any_of(slices_.rbegin(), slices_.rend(), [&](const Slice& slice) {
    const auto beyond_m = slice.beyond_m(p_robot);
    return beyond_m && std::abs(*beyond_m) < kSurface_m;
  });
}

}  // namespace colonnade
