// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "floor_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "rgbd_pyramid.hpp"

namespace colonnade {
namespace {

constexpr int kMinPoints = 120;
constexpr double kMinSpread_m = 0.12;  ///< standard deviation of the seen floor's shorter side
// Depth errors of a structured-light camera are smooth over the image: this many neighbours err
// alike, and a bent depth scale tilts the whole floor a little whatever the number of points.
constexpr double kCorrelation = 60.0;
constexpr double kTiltBias = 0.0035;  ///< rad
constexpr double kHeightBias_m = 0.006;

struct Sample {
  Eigen::Vector3d p;
  double sigma;  ///< of the distance along `up`
};

}  // namespace

std::optional<FloorFit> fitFloorNear(const cv::Mat& depth_m, const PinholeCamera& camera,
                                     const Eigen::Vector3d& expected_up, double expected_height_m,
                                     const FloorSearch& search) {
  const int stride = std::max(1, camera.width_px / 160);
  std::vector<Sample> samples;
  Eigen::Vector3d up = expected_up.normalized();
  double height_m = expected_height_m;
  for (int v = stride / 2; v < depth_m.rows; v += stride) {
    const float* row = depth_m.ptr<float>(v);
    for (int u = stride / 2; u < depth_m.cols; u += stride) {
      const double depth = static_cast<double>(row[u]);
      if (depth < 0.3 || depth > 6.0) continue;
      const Eigen::Vector3d ray = camera.ray(u, v);
      const double slope = up.dot(ray);
      if (slope > -0.05) continue;  // not looking down
      const Eigen::Vector3d p = ray * depth;
      const double sigma =
          -slope * static_cast<double>(depthSigma(static_cast<float>(depth))) + 0.002;
      const double gate = search.height_m + search.tilt * p.norm() + 3.0 * sigma;
      if (std::abs(up.dot(p) + height_m) < gate) samples.push_back({p, sigma});
    }
  }
  FloorFit fit;
  for (int round = 0; round < 6; ++round) {
    fit.tangent_a = up.unitOrthogonal();
    fit.tangent_b = up.cross(fit.tangent_a);
    Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    fit.points = 0;
    const double shrink = round == 0 ? 1.0 : round == 1 ? 0.5 : 0.0;
    for (const Sample& sample : samples) {
      const double r = up.dot(sample.p) + height_m;
      const double gate = shrink * (search.height_m + search.tilt * sample.p.norm()) +
                          std::max(3.0 * sample.sigma, 0.012);
      if (std::abs(r) > gate) continue;
      const Eigen::Vector2d q(fit.tangent_a.dot(sample.p), fit.tangent_b.dot(sample.p));
      const Eigen::Vector3d J(q.x(), q.y(), 1.0);
      const double ratio = r / sample.sigma;
      const double w = 6.0 / (5.0 + ratio * ratio) / (sample.sigma * sample.sigma);
      H.noalias() += w * J * J.transpose();
      g.noalias() += w * r * J;
      mean += q;
      spread.noalias() += q * q.transpose();
      ++fit.points;
    }
    if (fit.points < kMinPoints) return std::nullopt;
    mean /= fit.points;
    spread = spread / fit.points - mean * mean.transpose();
    const double narrow = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvalues()(0);
    if (!(narrow > kMinSpread_m * kMinSpread_m)) return std::nullopt;
    const Eigen::Vector3d dx = -H.ldlt().solve(g);
    if (!dx.allFinite() || dx.head<2>().norm() > 0.5) return std::nullopt;
    up = (up + fit.tangent_a * dx.x() + fit.tangent_b * dx.y()).normalized();
    height_m += dx.z();
    fit.covariance = kCorrelation * H.inverse();
    if (round >= 3 && dx.head<2>().norm() < 1e-5 && std::abs(dx.z()) < 1e-5) break;
  }
  fit.covariance.diagonal() +=
      Eigen::Vector3d(kTiltBias * kTiltBias, kTiltBias * kTiltBias, kHeightBias_m * kHeightBias_m);
  fit.up = up;
  fit.height_m = height_m;
  const double moved = std::acos(std::clamp(up.dot(expected_up.normalized()), -1.0, 1.0));
  if (moved > 2.0 * search.tilt + 0.05 ||
      std::abs(height_m - expected_height_m) > 2.0 * search.height_m + 0.05) {
    return std::nullopt;
  }
  return fit;
}

}  // namespace colonnade
