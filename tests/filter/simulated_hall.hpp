// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <map>
#include <random>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/filter/ekf_slam.hpp"

namespace colonnade::testing {

/// A robot on a circle among points and walls, with strong noise and known associations: what the
/// estimator itself is judged in.
class SimulatedHall {
 public:
  explicit SimulatedHall(unsigned seed, double noise_scale = 1.0)
      : noise_scale_(noise_scale), random_(seed) {
    for (int i = 0; i < 14; ++i) {
      const double angle = 2.0 * kPi * i / 14.0;
      points_.emplace_back(6.0 * std::cos(angle) + 0.5, 6.0 * std::sin(angle) + 3.0);
    }
  }

  void step(EkfSlam& filter) {
    const Pose2 u{0.15, 0.0, 0.05};
    const Eigen::Vector3d sigma = noise_scale_ * Eigen::Vector3d(0.03, 0.01, radians(1.5));
    truth_ = truth_ * Pose2{u.x + sigma(0) * normal(), u.y + sigma(1) * normal(),
                            u.phi + sigma(2) * normal()};
    filter.predict(u, sigma.cwiseAbs2().asDiagonal());
    std::vector<Match> matches;
    for (std::size_t i = 0; i < points_.size(); ++i)
      see(filter, static_cast<int>(i), LandmarkKind::kDepthSlope, BlockKind::kPoint, points_[i],
          {radians(2.0), 0.15}, matches);
    for (int i = 0; i < 2; ++i) {
      Eigen::Vector4d wall(0.0, 0.0, kPi / 2.0 * i, 9.0);
      see(filter, 100 + i, LandmarkKind::kFloorEdge, BlockKind::kFloorLine, wall,
          {radians(3.0), 0.2}, matches);
    }
    filter.update(matches);
  }

  double nees(const EkfSlam& filter) const {
    Eigen::Vector3d e = filter.pose().vector() - truth_.vector();
    e(2) = wrapAngle(e(2));
    return e.dot(filter.poseCovariance().ldlt().solve(e)) / 3.0;
  }

 private:
  double normal() { return normal_(random_); }

  void see(EkfSlam& filter, int key, LandmarkKind kind, BlockKind block_kind,
           const BlockVector& block, const Eigen::Vector2d& unit_sigma,
           std::vector<Match>& matches) {
    const Eigen::Vector2d sigma = noise_scale_ * unit_sigma;
    Measurement m;
    m.kind = kind;
    m.z = Eigen::Vector2d(0.0, 1.0);
    m.R = sigma.cwiseAbs2().asDiagonal();
    m.z = predictMeasurement(truth_, block_kind, block, m).z;
    if (m.z(1) < 0.0) m.z << wrapAngle(m.z(0) + kPi), -m.z(1);
    if (std::abs(m.z(0)) > kPi / 2.0 || m.z(1) > 7.0) return;
    m.z += Eigen::Vector2d(sigma(0) * normal(), sigma(1) * normal());
    m.z(0) = wrapAngle(m.z(0));
    const auto known = known_.find(key);
    if (known != known_.end())
      matches.push_back({known->second, m});
    else if (const auto id = filter.addLandmark(m))
      known_[key] = *id;
  }

  double noise_scale_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_{0.0, 1.0};
  std::vector<Eigen::Vector2d> points_;
  std::map<int, LandmarkId> known_;
  Pose2 truth_;
};

}  // namespace colonnade::testing
