// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/trail.hpp"

#include <cmath>
#include <limits>

namespace colonnade {
namespace {

Pose2 poseOf(LandmarkId clone, const EkfSlam& filter) {
  const Block& block = *filter.state().find(clone);
  const Eigen::Vector3d x = filter.state().x.segment<3>(block.offset);
  return {x(0), x(1), x(2)};
}

Pose2 part(const Pose2& T, double share) { return {share * T.x, share * T.y, share * T.phi}; }

}  // namespace

void Trail::step(double stamp_s, EkfSlam& filter) {
  const Pose2 now = filter.pose();
  if (!options_.enabled) {
    entries_.push_back({stamp_s, 0, now, 0.0});
    return;
  }
  if (nodes_.empty()) distance_m_ = options_.distance_m;
  // The way is measured from the last node, whose estimate moves with the robot's.
  Pose2 T_node_robot;
  if (!nodes_.empty()) {
    T_node_robot = poseOf(nodes_.back(), filter).inverse() * now;
    const Entry& former = entries_.back();
    way_m_ += (former.node == nodes_.size() - 1 ? former.T_node_robot.inverse() * T_node_robot
                                                : T_node_robot)
                  .translation()
                  .norm();
  }
  if (nodes_.empty() || way_m_ - node_way_m_.back() >= distance_m_ ||
      std::abs(T_node_robot.phi) >= options_.turn) {
    if (static_cast<int>(nodes_.size()) >= options_.max_poses) thin(filter);
    if (!nodes_.empty()) T_before_node_.push_back(poseOf(nodes_.back(), filter).inverse() * now);
    nodes_.push_back(filter.addPoseClone());
    node_way_m_.push_back(way_m_);
    T_node_robot = {};
  }
  entries_.push_back({stamp_s, nodes_.size() - 1, T_node_robot, way_m_});
}

double Trail::distanceToFormer(const EkfSlam& filter, double young_m) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < nodes_.size() && way_m_ - node_way_m_[i] >= young_m; ++i)
    nearest = std::min(
        nearest, (poseOf(nodes_[i], filter).translation() - filter.pose().translation()).norm());
  return nearest;
}

/// Takes every second pose out; its frames hang on the one before.
void Trail::thin(EkfSlam& filter) {
  distance_m_ *= 2.0;
  std::vector<Pose2> T_kept_node(nodes_.size());
  for (std::size_t i = 1; i < nodes_.size(); i += 2)
    T_kept_node[i] = poseOf(nodes_[i - 1], filter).inverse() * poseOf(nodes_[i], filter);
  for (Entry& entry : entries_) {
    entry.T_node_robot = T_kept_node[entry.node] * entry.T_node_robot;
    entry.node /= 2;
  }
  std::vector<LandmarkId> nodes;
  std::vector<Pose2> T_before_node;
  std::vector<double> way;
  for (std::size_t i = 0; i < nodes_.size(); i += 2) {
    if (i > 0) T_before_node.push_back(T_kept_node[i - 1] * T_before_node_[i - 1]);
    nodes.push_back(nodes_[i]);
    way.push_back(node_way_m_[i]);
  }
  for (std::size_t i = 1; i < nodes_.size(); i += 2) filter.remove(nodes_[i]);
  nodes_ = std::move(nodes);
  T_before_node_ = std::move(T_before_node);
  node_way_m_ = std::move(way);
}

std::vector<Trail::StampedPose2> Trail::poses(const EkfSlam& filter) const {
  std::vector<StampedPose2> poses;
  poses.reserve(entries_.size());
  for (const Entry& entry : entries_) {
    if (nodes_.empty()) {
      poses.push_back({entry.stamp_s, entry.T_node_robot});
      continue;
    }
    const Pose2 node = poseOf(nodes_[entry.node], filter);
    Pose2 pose = node * entry.T_node_robot;
    const bool is_last = entry.node + 1 == nodes_.size();
    const Pose2 end = is_last ? filter.pose() : poseOf(nodes_[entry.node + 1], filter);
    const Pose2& T_node_end = is_last ? entries_.back().T_node_robot : T_before_node_[entry.node];
    const double end_m = is_last ? way_m_ : node_way_m_[entry.node + 1];
    const double length_m = end_m - node_way_m_[entry.node];
    if (length_m > 1e-6) {
      const Pose2 apart = (node * T_node_end).inverse() * end;
      pose = pose * part(apart, (entry.way_m - node_way_m_[entry.node]) / length_m);
    }
    poses.push_back({entry.stamp_s, pose});
  }
  return poses;
}

}  // namespace colonnade
