// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/filter/ekf_slam.hpp"

namespace colonnade::testing {

/// Standard deviations of what a robot in the hall senses; white, so that the filter's noise_scale
/// is 1.
struct HallNoise {
  double along_m = 0.01;                  ///< of a step
  double across_m = 0.005;                ///< of a step
  double heading = radians(0.5);          ///< of a step
  double bearing = radians(0.5);          ///< pillars, corners
  double range_m = 0.05;                  ///< pillars within depth, corners
  double floor_direction = radians(1.0);  ///< floor edges
  double floor_distance_m = 0.05;         ///< floor edges
  double wall_direction = radians(1.0);   ///< building axes
  HallNoise times(double k) const {
    return {along_m * k, across_m * k,        heading * k,          bearing * k,
            range_m * k, floor_direction * k, floor_distance_m * k, wall_direction * k};
  }
};

/// A robot on rounds through a hall of 24 m by 14 m: two rows of pillars (a bearing each, with
/// range only where depth reaches), the floor edges of the four walls, corners, and the direction
/// of the walls as a building axis. Associations are known; the noise is white and known.
class BuildingHall {
 public:
  BuildingHall(unsigned seed, const HallNoise& noise, bool axes = true)
      : noise_(noise), axes_(axes), random_(seed) {
    for (int i = 0; i < 7; ++i)
      for (const double y : {-3.0, 3.0}) pillars_.emplace_back(-9.0 + 3.0 * i, y);
    for (const double x : {-12.0, -4.0, 4.0, 12.0})
      for (const double y : {-7.0, 7.0}) corners_.emplace_back(x, y);
    walls_ = {{0.0, 0.0, 0.0, 12.0},
              {0.0, 0.0, kPi / 2.0, 7.0},
              {0.0, 0.0, kPi, 12.0},
              {0.0, 0.0, -kPi / 2.0, 7.0}};
    // The filter's world starts at the first pose.
    const Pose2 start = T_hall_start_.inverse();
    for (auto* points : {&pillars_, &corners_})
      for (Eigen::Vector2d& p : *points) p = transform(start, p);
    for (Eigen::Vector4d& wall : walls_) {
      wall.head<2>() = transform(start, Eigen::Vector2d(wall.head<2>()));
      wall(2) = wrapAngle(wall(2) + start.phi);
    }
  }

  static constexpr int kStepsARound = 300;

  void step(EkfSlam& filter) {
    drive(filter);
    std::vector<Match> matches;
    std::vector<std::pair<int, Measurement>> fresh;
    for (std::size_t i = 0; i < pillars_.size(); ++i)
      see(filter, static_cast<int>(i), LandmarkKind::kPillarEdge, pillars_[i], matches, fresh);
    for (std::size_t i = 0; i < corners_.size(); ++i)
      see(filter, 100 + static_cast<int>(i), LandmarkKind::kDepthSlope, corners_[i], matches,
          fresh);
    for (std::size_t i = 0; i < walls_.size(); ++i)
      see(filter, 200 + static_cast<int>(i), LandmarkKind::kFloorEdge, walls_[i], matches, fresh);
    std::vector<LandmarkId> needed;
    for (const Match& match : matches) needed.push_back(match.landmark);
    filter.focus(needed);  // nothing rests with as many active landmarks as the default
    filter.update(matches);
    if (axes_) seeAxis(filter);
    found(filter, fresh);
    filter.settleInverseDepths();
  }

  /// e^T P^-1 e / 3 of the pose.
  double nees(const EkfSlam& filter) const {
    Eigen::Vector3d e = filter.pose().vector() - truth_.vector();
    e(2) = wrapAngle(e(2));
    return e.dot(filter.poseCovariance().ldlt().solve(e)) / 3.0;
  }
  const Pose2& truth() const { return truth_; }
  /// Summed distance2 of the walls' directions, and how many.
  double axis_distance2 = 0.0;
  int axis_count = 0;

 private:
  struct FirstBearing {
    LandmarkId clone{};
    Measurement measurement;
  };
  double normal() { return normal_(random_); }

  void drive(EkfSlam& filter) {
    // A rounded rectangle: straight, a quarter turn, straight, ...
    static constexpr int kLong = 110, kShort = 20, kTurn = 10;
    const int at = steps_++ % (2 * (kLong + kShort) + 4 * kTurn);
    const int half = at % (kLong + kShort + 2 * kTurn);
    const bool turning = (half >= kLong && half < kLong + kTurn) || half >= kLong + kTurn + kShort;
    const Pose2 u{0.15, 0.0, turning ? kPi / 2.0 / kTurn : 0.0};
    truth_ = truth_ * Pose2{u.x + noise_.along_m * normal(), u.y + noise_.across_m * normal(),
                            u.phi + noise_.heading * normal()};
    filter.predict(
        u,
        Eigen::Vector3d(noise_.along_m, noise_.across_m, noise_.heading).cwiseAbs2().asDiagonal());
  }

  /// What the robot sees of it, if anything: forward within 60 degrees and 9 m; the range of a
  /// pillar only within 4 m.
  std::optional<Measurement> look(LandmarkKind kind, const BlockVector& block) {
    const bool wall = kind == LandmarkKind::kFloorEdge;
    const Eigen::Vector2d sigma =
        wall ? Eigen::Vector2d(noise_.floor_direction, noise_.floor_distance_m)
             : Eigen::Vector2d(noise_.bearing, noise_.range_m);
    Measurement m;
    m.kind = kind;
    m.p_robot_camera << 0.1, 0.0;
    m.z = Eigen::Vector2d(0.0, 1.0);
    m.R = sigma.cwiseAbs2().asDiagonal();
    m.z = predictMeasurement(truth_, wall ? BlockKind::kFloorLine : BlockKind::kPoint, block, m).z;
    if (wall && m.z(1) < 0.0) m.z << wrapAngle(m.z(0) + kPi), -m.z(1);
    if (std::abs(m.z(0)) > radians(wall ? 100.0 : 60.0) || m.z(1) > (wall ? 5.0 : 9.0))
      return std::nullopt;
    const bool ranged = kind != LandmarkKind::kPillarEdge || m.z(1) < 4.0;
    m.z += Eigen::Vector2d(sigma(0) * normal(), sigma(1) * normal());
    m.z(0) = wrapAngle(m.z(0));
    if (!ranged) {
      m.z = MeasurementVector(m.z.head(1).eval());
      m.R = MeasurementCovariance(m.R.topLeftCorner(1, 1).eval());
    }
    return m;
  }

  void see(EkfSlam&, int key, LandmarkKind kind, const BlockVector& block,
           std::vector<Match>& matches, std::vector<std::pair<int, Measurement>>& fresh) {
    const auto m = look(kind, block);
    if (!m) return;
    const auto known = known_.find(key);
    if (known != known_.end())
      matches.push_back({known->second, *m});
    else
      fresh.emplace_back(key, *m);
  }

  void seeAxis(EkfSlam& filter) {
    if (steps_ % 2 != 0) return;
    const double seen =
        wrapQuarterTurn(-T_hall_start_.phi - truth_.phi + noise_.wall_direction * normal());
    if (!axis_) {
      axis_ = filter.addAxis(seen, noise_.wall_direction);
      return;
    }
    const auto expected = filter.axisInnovation(*axis_, seen, noise_.wall_direction);
    if (!filter.updateAxis(*axis_, seen, noise_.wall_direction)) return;
    axis_distance2 += expected->distance2;
    ++axis_count;
  }

  /// With range at once; a bearing waits for parallax, with a clone of its pose in the state.
  void found(EkfSlam& filter, const std::vector<std::pair<int, Measurement>>& fresh) {
    std::optional<LandmarkId> clone;
    for (const auto& [key, m] : fresh) {
      if (m.hasRange()) {
        if (const auto first = first_bearings_.extract(key)) release(filter, first.mapped().clone);
        if (const auto id = filter.addLandmark(m)) known_[key] = *id;
        continue;
      }
      const auto first = first_bearings_.find(key);
      if (first == first_bearings_.end()) {
        if (!clone) clone = filter.addPoseClone();
        first_bearings_[key] = {*clone, m};
        continue;
      }
      const FirstBearing view = first->second;
      const auto seen = filter.parallax(view.clone, view.measurement, m);
      if (!seen || seen->baseline_m < 0.3 || std::abs(seen->angle) < radians(6.0) ||
          seen->inverse_depth < 4.0 * seen->inverse_depth_sigma)
        continue;
      if (const auto id = filter.addLandmark(view.clone, view.measurement, m)) known_[key] = *id;
      first_bearings_.erase(first);
      release(filter, view.clone);
    }
  }

  void release(EkfSlam& filter, LandmarkId clone) {
    for (const auto& [key, first] : first_bearings_)
      if (first.clone == clone) return;
    filter.remove(clone);
  }

  HallNoise noise_;
  bool axes_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_{0.0, 1.0};
  Pose2 T_hall_start_{-8.25, -5.0, 0.0};
  Pose2 truth_;
  int steps_ = 0;
  std::vector<Eigen::Vector2d> pillars_, corners_;
  std::vector<Eigen::Vector4d> walls_;
  std::map<int, LandmarkId> known_;
  std::map<int, FirstBearing> first_bearings_;
  std::optional<LandmarkId> axis_;
};

}  // namespace colonnade::testing
