// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sample_entropy.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <random>

#include "colonnade/base/angle.hpp"
#include "policies.hpp"
#include "two_poses.hpp"

namespace colonnade {
namespace {

using Draw = Eigen::Matrix<double, 5, 1>;  ///< three of the way, one of either bearing

/// The same standard normal numbers for every candidate, so that runs repeat (Box and Muller 1958,
/// since the numbers of std::normal_distribution differ between libraries).
std::vector<Draw> standardDraws(int count) {
  std::mt19937_64 generator(20050418);
  const auto uniform = [&] {
    return (static_cast<double>(generator() >> 11) + 0.5) / 9007199254740992.0;  // 2^53
  };
  std::vector<Draw> draws(static_cast<std::size_t>(count));
  for (Draw& draw : draws)
    for (double& number : draw)
      number = std::sqrt(-2.0 * std::log(uniform())) * std::cos(2.0 * kPi * uniform());
  return draws;
}

/// A with A A^T = P, also where P is singular.
Eigen::Matrix3d squareRoot(const Eigen::Matrix3d& P) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(0.5 * (P + P.transpose()));
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

/// Where the rays meet, with what the densities need of it.
struct Meeting {
  Eigen::Vector2d p;
  double volume = 0.0;  ///< |d bearings / d p| = |sin parallax| / (distance_a distance_b)
  bool in_front = false;
};
Meeting meet(const Triangulation& t, const Eigen::Vector2d& p_camera_b) {
  Meeting m;
  if (!t.block.allFinite() || t.block(3) == 0.0) return m;
  m.p = pointOf(t.block);
  const Eigen::Vector2d from_b = m.p - p_camera_b;
  const double beta = t.block(2) + t.parallax;
  m.in_front =
      t.block(3) > 0.0 && from_b.dot(Eigen::Vector2d(std::cos(beta), std::sin(beta))) > 0.0;
  m.volume = std::abs(std::sin(t.parallax) * t.block(3)) / from_b.norm();
  return m;
}

}  // namespace

double sampleRelativeEntropy(const Pose2& T_a_b, const Eigen::Matrix3d& covariance,
                             const Measurement& bearing_a, const Measurement& bearing_b,
                             int samples) {
  const Triangulation t = triangulate(Pose2{}, bearing_a, T_a_b, bearing_b);
  const Meeting mean = meet(t, transform(T_a_b, bearing_b.p_robot_camera));
  if (!mean.in_front) return HUGE_VAL;
  Eigen::Matrix<double, 2, 4> J_point;
  pointOf(t.block, &J_point);
  const Eigen::Matrix<double, 2, 3> J_way = J_point * t.J_robot_b;
  Eigen::Matrix2d J_bearings;
  J_bearings << J_point * t.J_bearing_a, J_point * t.J_bearing_b;
  const Eigen::Matrix2d bearings_of_point = J_bearings.inverse();
  const Eigen::Vector2d sigma(std::sqrt(bearing_a.R(0, 0)), std::sqrt(bearing_b.R(0, 0)));
  const Eigen::Matrix3d root = squareRoot(covariance);

  // f and g share the density of the way, so their ratio is that of the place given the way:
  // f = N(bearings) |d bearings / d p|, g = N(p_mean + J_way delta, J_bearings R J_bearings^T).
  double sum = 0.0;
  for (const Draw& draw : standardDraws(samples)) {
    const Eigen::Vector3d delta = root * draw.head<3>();
    const Eigen::Vector2d whitened = draw.tail<2>();
    Measurement a = bearing_a;
    Measurement b = bearing_b;
    a.z(0) += sigma(0) * whitened(0);
    b.z(0) += sigma(1) * whitened(1);
    const Pose2 T{T_a_b.x + delta(0), T_a_b.y + delta(1), T_a_b.phi + delta(2)};
    const Meeting m = meet(triangulate(Pose2{}, a, T, b), transform(T, b.p_robot_camera));
    if (!m.in_front) return HUGE_VAL;  // so often that a hundred draws show it
    const Eigen::Vector2d u =
        (bearings_of_point * (m.p - mean.p - J_way * delta)).cwiseQuotient(sigma);
    sum += 0.5 * (u.squaredNorm() - whitened.squaredNorm()) + std::log(m.volume / mean.volume);
  }
  return sum / samples;
}

namespace {

/// Constrained: two bearings found the landmark once their place is Gaussian enough (thesis 2015,
/// section 1.4, reference [12]: Bailey 2003). The place is judged in the axes of the first pose:
/// where that lies in the world is a turn and a shift of everything, which bends no place.
class SampleEntropy final : public ClonedInitialization {
 public:
  SampleEntropy(const InitializationOptions& options, const Measurement& first, PoseClones& clones,
                EkfSlam& filter)
      : ClonedInitialization(first, clones, filter),
        max_entropy_(options.max_entropy),
        samples_(options.entropy_samples) {}

  Verdict see(const BearingSighting& sighting, EkfSlam& filter) override {
    if (!sighting.confirmed) return {};
    const auto seen = filter.parallax(clone(), first(), sighting.measurement);
    if (!seen) return {};
    // Rays that part by far more than their noise never meet.
    if (seen->inverse_depth < -3.0 * seen->inverse_depth_sigma)
      return {Verdict::kRejected, {}, "rays do not meet"};
    if (seen->inverse_depth <= 0.0) return {};
    const Way way = wayFromClone(filter.state(), clone());
    const double entropy = sampleRelativeEntropy(way.T_clone_robot, way.covariance, first(),
                                                 sighting.measurement, samples_);
    if (!(entropy <= max_entropy_)) return {};
    return foundByTwoBearings(sighting.measurement, filter);
  }

 private:
  double max_entropy_;
  int samples_;
};

}  // namespace

std::unique_ptr<BearingInitialization> beginSampleEntropy(const InitializationOptions& options,
                                                          const Measurement& first,
                                                          PoseClones& clones, EkfSlam& filter) {
  return std::make_unique<SampleEntropy>(options, first, clones, filter);
}

}  // namespace colonnade
