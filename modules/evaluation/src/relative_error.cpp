// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "relative_error.hpp"

#include <cmath>

#include "colonnade/base/angle.hpp"

namespace colonnade {
namespace {

constexpr double kLengths[] = {1.0, 2.0, 5.0, 10.0};
constexpr double kRoundingSlack = 1e-6;  ///< metres or seconds
constexpr double kPeriod = 1.0;
constexpr double kPeriodSlack = 0.1;

/// The matched poses along the path, cut where the matches pause for too long.
struct Path {
  std::vector<double> length_m;  ///< true distance travelled up to each pair
  std::vector<int> run;          ///< number of the uninterrupted run each pair belongs to
};

Path measurePath(const std::vector<PosePair>& pairs, double max_step_s) {
  Path path{{0.0}, {0}};
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const bool pause = pairs[i].stamp_s - pairs[i - 1].stamp_s > max_step_s;
    const double step =
        (pairs[i].T_truth_body.translation() - pairs[i - 1].T_truth_body.translation()).norm();
    path.length_m.push_back(path.length_m.back() + (pause ? 0.0 : step));
    path.run.push_back(path.run.back() + (pause ? 1 : 0));
  }
  return path;
}

struct MotionError {
  double distance_m = 0.0;
  double angle = 0.0;
};

/// E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j), truth Q and estimate P (Sturm 2012, equation 1).
MotionError motionError(const PosePair& i, const PosePair& j) {
  const Eigen::Isometry3d truth = i.T_truth_body.inverse() * j.T_truth_body;
  const Eigen::Isometry3d estimate = i.T_estimate_body.inverse() * j.T_estimate_body;
  const Eigen::Isometry3d error = truth.inverse() * estimate;
  return {error.translation().norm(), Eigen::AngleAxisd(error.linear()).angle()};
}

DistanceError errorOver(double length_m, const std::vector<PosePair>& pairs, const Path& path) {
  DistanceError result;
  result.length_m = length_m;
  double sum_distance = 0.0;
  double sum_angle = 0.0;
  std::size_t j = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    while (j < pairs.size() && path.length_m[j] - path.length_m[i] < length_m - kRoundingSlack) ++j;
    if (j == pairs.size()) break;
    if (path.run[i] != path.run[j]) continue;
    const double travelled = path.length_m[j] - path.length_m[i];
    const MotionError error = motionError(pairs[i], pairs[j]);
    sum_distance += std::pow(error.distance_m / travelled, 2);
    sum_angle += std::pow(error.angle / travelled, 2);
    ++result.pieces;
  }
  if (result.pieces == 0) return result;
  const auto count = static_cast<double>(result.pieces);
  result.percent = 100.0 * std::sqrt(sum_distance / count);
  result.deg_per_m = degrees(std::sqrt(sum_angle / count));
  return result;
}

void scoreOneSecond(const std::vector<PosePair>& pairs, const Path& path, TrajectoryScore& score) {
  double sum_distance = 0.0;
  double sum_angle = 0.0;
  double count = 0.0;
  std::size_t j = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    while (j < pairs.size() && pairs[j].stamp_s - pairs[i].stamp_s < kPeriod - kRoundingSlack) ++j;
    if (j == pairs.size()) break;
    const bool far = pairs[j].stamp_s - pairs[i].stamp_s > kPeriod + kPeriodSlack;
    if (far || path.run[i] != path.run[j]) continue;
    const MotionError error = motionError(pairs[i], pairs[j]);
    sum_distance += std::pow(error.distance_m, 2);
    sum_angle += std::pow(error.angle, 2);
    count += 1.0;
  }
  if (count == 0.0) return;
  score.rpe_1s_m = std::sqrt(sum_distance / count);
  score.rpe_1s_deg = degrees(std::sqrt(sum_angle / count));
}

/// The pose from `begin` on whose stamp is nearest, the earlier one when equal.
std::size_t nearest(const std::vector<PosePair>& pairs, std::size_t begin, double stamp_s) {
  std::size_t j = begin;
  while (j + 1 < pairs.size() &&
         std::abs(pairs[j + 1].stamp_s - stamp_s) < std::abs(pairs[j].stamp_s - stamp_s))
    ++j;
  return j;
}

/// The fixed-delta figure of the benchmark's program: (P_j^-1 P_i)^-1 (Q_j^-1 Q_i).
void scoreOneSecondAsTum(const std::vector<PosePair>& pairs, const Path& path,
                         TrajectoryScore& score) {
  double sum = 0.0;
  double count = 0.0;
  std::size_t j = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    j = nearest(pairs, std::max(i, j), pairs[i].stamp_s + kPeriod);
    const double off = std::abs(pairs[j].stamp_s - pairs[i].stamp_s - kPeriod);
    if (j + 1 == pairs.size() || off > kPeriodSlack || path.run[i] != path.run[j]) continue;
    sum += std::pow(motionError(pairs[j], pairs[i]).distance_m, 2);
    count += 1.0;
  }
  if (count > 0.0) score.rpe_1s_tum_m = std::sqrt(sum / count);
}

}  // namespace

void scoreRelativeErrors(const std::vector<PosePair>& pairs, const EvaluationOptions& options,
                         TrajectoryScore& score) {
  const Path path = measurePath(pairs, options.max_step_s);
  score.path_length_m = path.length_m.back();
  for (const double length_m : kLengths) {
    const auto error = errorOver(length_m, pairs, path);
    if (error.pieces > 0) score.rpe.push_back(error);
  }
  scoreOneSecond(pairs, path, score);
  scoreOneSecondAsTum(pairs, path, score);
  if (score.path_length_m > 0.0)
    score.end_drift_percent =
        100.0 * motionError(pairs.front(), pairs.back()).distance_m / score.path_length_m;
}

}  // namespace colonnade
