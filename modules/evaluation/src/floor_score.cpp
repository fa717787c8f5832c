// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/floor_score.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "colonnade/base/error.hpp"

namespace colonnade {
namespace {

int cellOf(double metres, double resolution_m) {
  return static_cast<int>(std::floor(metres / resolution_m));
}

}  // namespace

FloorScore scoreFloor(const FloorMap& estimate, const FloorMap& truth,
                      const Pose2& T_truth_estimate) {
  const Pose2 T_corner_corner = truth.T_world_corner.inverse() * T_truth_estimate *
                                estimate.T_world_corner;  // truth's corner from the estimate's
  const double cell_m = truth.resolution_m;
  Eigen::AlignedBox2d box(Eigen::Vector2d::Zero(),
                          Eigen::Vector2d(truth.width, truth.height) * cell_m);
  for (const int x : {0, estimate.width})
    for (const int y : {0, estimate.height})
      box.extend(transform(T_corner_corner, Eigen::Vector2d(x, y) * estimate.resolution_m));

  const Pose2 T_estimate_truth = T_corner_corner.inverse();
  std::size_t in_estimate = 0;
  std::size_t in_truth = 0;
  std::size_t in_both = 0;
  for (int row = cellOf(box.min().y(), cell_m); row <= cellOf(box.max().y(), cell_m); ++row)
    for (int column = cellOf(box.min().x(), cell_m); column <= cellOf(box.max().x(), cell_m);
         ++column) {
      const Eigen::Vector2d p =
          transform(T_estimate_truth, Eigen::Vector2d(column + 0.5, row + 0.5) * cell_m);
      const bool estimated = estimate.isFree(cellOf(p.x(), estimate.resolution_m),
                                             cellOf(p.y(), estimate.resolution_m));
      const bool is_true = truth.isFree(column, row);
      in_estimate += estimated ? 1 : 0;
      in_truth += is_true ? 1 : 0;
      in_both += estimated && is_true ? 1 : 0;
    }
  if (in_both == 0)
    throw Error(
        "the free floors of map and truth do not overlap; are they of one building, and is "
        "the alignment right?");
  FloorScore score;
  score.resolution_m = cell_m;
  const auto area = [&](std::size_t cells) { return static_cast<double>(cells) * cell_m * cell_m; };
  const auto share = [&](std::size_t whole) {
    return static_cast<double>(in_both) / static_cast<double>(whole);
  };
  score.estimate_m2 = area(in_estimate);
  score.truth_m2 = area(in_truth);
  score.both_m2 = area(in_both);
  score.iou = share(in_estimate + in_truth - in_both);
  score.precision = share(in_estimate);
  score.recall = share(in_truth);
  return score;
}

}  // namespace colonnade
