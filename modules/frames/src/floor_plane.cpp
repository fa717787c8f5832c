// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/frames/floor_plane.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace colonnade {
namespace {

constexpr int kGridColumns = 80;
constexpr int kHypotheses = 120;
constexpr int kRefinements = 4;
constexpr float kBelow = 3.0F;  ///< tolerances below a plane that count as under it

/// A Kinect-style sensor's depth noise grows with the square of the depth (Khoshelham and Elberink
/// 2012, about 1.4 mm at 1 m); generous, since floors are seen at a grazing angle.
float tolerance(float depth_m) { return 0.015F + 0.004F * depth_m * depth_m; }

struct Sample {
  Eigen::Vector3f p;
  float tolerance = 0.0F;
  bool faces_up = false;
};

struct Plane {
  Eigen::Vector3f normal;
  float height = 0.0F;
};

/// Repeatable pseudo-random indices (Numerical Recipes' linear congruential generator).
class Dice {
 public:
  std::size_t below(std::size_t count) {
    state_ = state_ * 1664525U + 1013904223U;
    return (static_cast<std::uint64_t>(state_) * count) >> 32U;
  }

 private:
  std::uint32_t state_ = 20260801U;
};

std::vector<Sample> sample(const cv::Mat& depth_m, const PinholeCamera& camera,
                           const FloorPrior& prior) {
  const int step = std::max(1, depth_m.cols / kGridColumns);
  const int columns = depth_m.cols / step, rows = depth_m.rows / step;
  std::vector<Eigen::Vector3f> grid(static_cast<std::size_t>(rows * columns),
                                    Eigen::Vector3f::Zero());
  const auto at = [&](int row, int column) -> Eigen::Vector3f& {
    return grid[static_cast<std::size_t>(row * columns + column)];
  };
  for (int row = 0; row < rows; ++row) {
    const int v = row * step + step / 2;
    const auto* line = depth_m.ptr<float>(v);
    for (int column = 0; column < columns; ++column) {
      const int u = column * step + step / 2;
      const float z = line[u];
      if (z >= static_cast<float>(prior.nearest_m) && z <= static_cast<float>(prior.farthest_m))
        at(row, column) = z * camera.ray(u, v).cast<float>();
    }
  }
  // The local surface counts as facing up with some margin over the tolerance, for its noise.
  const auto least =
      static_cast<float>(std::cos(std::min(prior.tolerance + radians(15.0), radians(75.0))));
  const Eigen::Vector3f up = prior.up_camera.normalized().cast<float>();
  std::vector<Sample> samples;
  samples.reserve(grid.size());
  for (int row = 1; row + 1 < rows; ++row)
    for (int column = 1; column + 1 < columns; ++column) {
      const auto& p = at(row, column);
      if (p.z() == 0.0F) continue;
      Sample s{p, tolerance(p.z()), false};
      const auto &left = at(row, column - 1), &right = at(row, column + 1);
      const auto &above = at(row - 1, column), &below = at(row + 1, column);
      if (left.z() != 0.0F && right.z() != 0.0F && above.z() != 0.0F && below.z() != 0.0F) {
        const Eigen::Vector3f normal = (right - left).cross(above - below);  // towards the camera
        s.faces_up = normal.dot(up) > least * normal.norm();
      }
      samples.push_back(s);
    }
  return samples;
}

bool plausible(const Plane& plane, const FloorPrior& prior) {
  if (plane.height < 0.05F) return false;
  if (plane.normal.cast<double>().dot(prior.up_camera.normalized()) < std::cos(prior.tolerance))
    return false;
  return !prior.height_m ||
         std::abs(static_cast<double>(plane.height) - *prior.height_m) < prior.height_tolerance_m;
}

/// Points on the plane, less the points below it: a floor has none, a table top many.
int score(const Plane& plane, const std::vector<Sample>& samples) {
  int on = 0, under = 0;
  for (const auto& s : samples) {
    const float distance = plane.normal.dot(s.p) + plane.height;
    if (std::abs(distance) < s.tolerance)
      on += s.faces_up ? 1 : 0;
    else if (distance < -kBelow * s.tolerance)
      ++under;
  }
  return on - under;
}

/// Weighted total least squares over the points near the plane.
std::optional<FloorPlane> refine(Plane plane, const std::vector<Sample>& samples) {
  FloorPlane result;
  for (int round = 0; round < kRefinements; ++round) {
    double weights = 0.0, squares = 0.0;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    result.inliers = 0;
    for (const auto& s : samples) {
      const float distance = plane.normal.dot(s.p) + plane.height;
      if (!s.faces_up || std::abs(distance) > s.tolerance) continue;
      const Eigen::Vector3d p = s.p.cast<double>();
      const double weight =
          1.0 / (static_cast<double>(s.tolerance) * static_cast<double>(s.tolerance));
      weights += weight;
      mean += weight * p;
      moment += weight * p * p.transpose();
      squares += static_cast<double>(distance) * static_cast<double>(distance);
      ++result.inliers;
    }
    if (result.inliers < 3) return std::nullopt;
    mean /= weights;
    moment = moment / weights - mean * mean.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moment);
    Eigen::Vector3d normal = solver.eigenvectors().col(0);
    if (normal.dot(plane.normal.cast<double>()) < 0.0) normal = -normal;
    result.normal_camera = normal;
    result.height_m = -normal.dot(mean);
    result.rms_m = std::sqrt(squares / result.inliers);
    plane = {normal.cast<float>(), static_cast<float>(result.height_m)};
  }
  return result;
}

/// The best plane among the samples, or nothing.
std::optional<FloorPlane> fitOnce(const std::vector<Sample>& samples, const FloorPrior& prior,
                                  Dice& dice) {
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (samples[i].faces_up) candidates.push_back(i);
  if (candidates.size() < static_cast<std::size_t>(prior.least_inliers)) return std::nullopt;
  std::optional<Plane> best;
  int best_score = 0;
  const auto draw = [&] { return samples[candidates[dice.below(candidates.size())]].p; };
  for (int i = 0; i < kHypotheses; ++i) {
    const Eigen::Vector3f a = draw(), b = draw(), c = draw();
    Eigen::Vector3f normal = (b - a).cross(c - a);
    const float size = normal.norm();
    if (size < 0.01F) continue;  // points too close or in a row
    normal /= size;
    if (normal.cast<double>().dot(prior.up_camera) < 0.0) normal = -normal;
    const Plane plane{normal, -normal.dot(a)};
    if (!plausible(plane, prior)) continue;
    const int points = score(plane, samples);
    if (points > best_score) {
      best_score = points;
      best = plane;
    }
  }
  if (!best) return std::nullopt;
  const auto floor = refine(*best, samples);
  if (!floor || floor->inliers < prior.least_inliers) return std::nullopt;
  if (!plausible({floor->normal_camera.cast<float>(), static_cast<float>(floor->height_m)}, prior))
    return std::nullopt;
  return floor;
}

}  // namespace

std::optional<FloorPlane> fitFloorPlane(const cv::Mat& depth_m, const PinholeCamera& camera,
                                        const FloorPrior& prior) {
  if (depth_m.empty() || !camera.isCalibrated()) return std::nullopt;
  auto samples = sample(depth_m, camera, prior);
  Dice dice;
  auto floor = fitOnce(samples, prior, dice);
  // A table can show more points than the floor around it: look below as long as there is a plane.
  constexpr int kMostLevels = 3;
  constexpr double kLeastShare = 0.15;  // of the points of the plane above
  for (int level = 0; floor && level < kMostLevels; ++level) {
    const Eigen::Vector3f normal = floor->normal_camera.cast<float>();
    const auto height = static_cast<float>(floor->height_m);
    std::erase_if(
        samples, [&](const Sample& s) { return normal.dot(s.p) + height > -kBelow * s.tolerance; });
    const auto lower = fitOnce(samples, prior, dice);
    if (!lower || lower->inliers < kLeastShare * floor->inliers) break;
    floor = lower;
  }
  return floor;
}

Eigen::Isometry3d cameraAboveFloor(const Eigen::Vector3d& normal_camera, double height_m) {
  const Eigen::Vector3d up = normal_camera.normalized();
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d forward = (axis - axis.dot(up) * up).normalized();
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  T_robot_camera.linear().row(0) = forward.transpose();
  T_robot_camera.linear().row(1) = up.cross(forward).transpose();
  T_robot_camera.linear().row(2) = up.transpose();
  T_robot_camera.translation().z() = height_m;
  return T_robot_camera;
}

}  // namespace colonnade
