// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "line_score.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "wall_line.hpp"

namespace colonnade {
namespace {

/// A second floor edge on a wall that shares less of its length with the first is another piece.
constexpr double kFurtherPieceShare = 0.5;

/// Estimated and true lines and which may be which.
struct LineTable {
  std::vector<WallLine> lines;
  std::vector<WallLine> truth;
  std::vector<Candidate> candidates;
  std::map<std::pair<std::size_t, std::size_t>, LineFit> fits;
  std::vector<std::optional<std::size_t>> nearest;  ///< the candidate of least cost
};

LineTable tabulate(const LandmarkLists& lists, const LandmarkScoreOptions& options) {
  LineTable table;
  table.truth = joinLines(lists.truth);
  for (const auto& record : lists.aligned) table.lines.push_back(toLine(record));
  for (std::size_t i = 0; i < table.lines.size(); ++i) {
    double least = 0.0;
    table.nearest.emplace_back();
    for (std::size_t j = 0; j < table.truth.size(); ++j) {
      const LineFit fit = fitLine(table.lines[i], table.truth[j]);
      if (std::abs(fit.angle) > options.gate || std::abs(fit.offset_m) > options.gate_m ||
          fit.gap_m > options.gate_m)
        continue;
      const double cost =
          std::pow(fit.offset_m / options.gate_m, 2) + std::pow(fit.angle / options.gate, 2);
      table.candidates.push_back({i, j, cost});
      table.fits[{i, j}] = fit;
      if (table.nearest[i] && least <= cost) continue;
      table.nearest[i] = j;
      least = cost;
    }
  }
  return table;
}

/// Sums over the lines that lie on a wall, and what of each true line they reach over.
struct LineSums {
  double offset2 = 0.0;
  double angle2 = 0.0;
  double count = 0.0;
  double length_m = 0.0;
  double on_truth_m = 0.0;
  std::map<std::size_t, std::vector<Interval>> covered;

  void add(std::size_t truth, const LineFit& fit) {
    covered[truth].push_back(fit.extent);
    offset2 += fit.offset_m * fit.offset_m;
    angle2 += fit.angle * fit.angle;
    count += 1.0;
    length_m += fit.extent.length();
    on_truth_m += fit.on_truth_m;
  }
  bool holds(std::size_t truth, const Interval& extent) const {
    const auto found = covered.find(truth);
    return found != covered.end() &&
           coveredLength(extent, found->second) >= kFurtherPieceShare * extent.length();
  }
};

std::optional<double> degreesOf(std::optional<double> angle) {
  if (angle) *angle = degrees(*angle);
  return angle;
}

/// The true line in the estimate's world, judged across the line at the landmark's own place.
std::optional<double> squaredError(const LandmarkRecord& estimate, const WallLine& truth,
                                   const Anchor& anchor) {
  const Eigen::Vector2d normal = anchor.T_truth_estimate.rotation().transpose() * truth.normal();
  const double variance = normal.dot(estimate.covariance * normal);
  const double doubt = normal.dot(anchor.doubtAt(estimate.p_world).topLeftCorner<2, 2>() * normal);
  if (!(variance > 0.0) || doubt > 0.01 * variance) return std::nullopt;
  const double error = truth.across(transform(anchor.T_truth_estimate, estimate.p_world));
  return error * error / variance;
}

WallScore scoreWalls(const LineTable& table) {
  WallScore walls;
  double direction2 = 0.0;
  double direction_weight = 0.0;
  double angle2 = 0.0;
  double angle_weight = 0.0;
  const auto& lines = table.lines;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!table.nearest[i]) continue;
    ++walls.edges;
    const auto& wall = table.truth[*table.nearest[i]];
    direction2 += lines[i].length() * std::pow(lineAngle(lines[i], wall), 2);
    direction_weight += lines[i].length();
    for (std::size_t j = 0; j < i; ++j) {
      if (!table.nearest[j]) continue;
      const double weight = lines[i].length() * lines[j].length();
      const double true_angle = lineAngle(wall, table.truth[*table.nearest[j]]);
      const double error = std::remainder(lineAngle(lines[i], lines[j]) - true_angle, kPi);
      angle2 += weight * error * error;
      angle_weight += weight;
    }
  }
  walls.direction_rmse_deg = degreesOf(rootMean(direction2, direction_weight));
  walls.angle_rmse_deg = degreesOf(rootMean(angle2, angle_weight));
  return walls;
}

/// Counts the true lines that were seen and found, and how much of their length.
void scoreRecall(const std::vector<WallLine>& truth,
                 const std::map<std::size_t, std::vector<Interval>>& covered, int min_observations,
                 KindScore& score) {
  double seen_m = 0.0;
  double found_m = 0.0;
  for (std::size_t j = 0; j < truth.size(); ++j) {
    if (truth[j].mostObservations() < min_observations) continue;
    ++score.true_seen;
    const auto found = covered.find(j);
    if (found == covered.end())
      score.missed_ids.push_back(truth[j].id);
    else
      ++score.true_found;
    for (std::size_t k = 0; k < truth[j].pieces.size(); ++k) {
      if (truth[j].observations[k] < min_observations) continue;
      seen_m += truth[j].pieces[k].length();
      if (found != covered.end()) found_m += coveredLength(truth[j].pieces[k], found->second);
    }
  }
  if (seen_m > 0.0) score.length_recall = found_m / seen_m;
}

}  // namespace

KindScore scoreLines(const LandmarkLists& lists, const LandmarkScoreOptions& options,
                     const std::optional<Anchor>& anchor, WallScore& walls) {
  const LineTable table = tabulate(lists, options);
  const auto& lines = table.lines;
  const auto truth_of = assignSeenFirst(
      lines.size(), table.truth.size(), table.candidates, 2.0,
      [&](std::size_t j) { return table.truth[j].mostObservations() >= options.min_observations; });

  KindScore score;
  score.estimated = lines.size();
  LineSums sums;
  double nees = 0.0;
  const auto take = [&](std::size_t i, std::size_t j) {
    sums.add(j, table.fits.at({i, j}));
    const auto squared =
        anchor ? squaredError(lists.estimate[i], table.truth[j], *anchor) : std::nullopt;
    if (!squared) return;
    nees += *squared;
    ++score.nees_landmarks;
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!truth_of[i]) continue;
    ++score.right;
    take(i, *truth_of[i]);
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (truth_of[i]) continue;
    if (!table.nearest[i]) {
      score.false_ids.push_back(lines[i].id);
    } else if (sums.holds(*table.nearest[i], table.fits.at({i, *table.nearest[i]}).extent)) {
      score.duplicate_ids.push_back(lines[i].id);
    } else {
      ++score.further;
      take(i, *table.nearest[i]);
    }
  }
  score.duplicates = score.duplicate_ids.size();
  scoreRecall(table.truth, sums.covered, options.min_observations, score);
  score.offset_rmse_m = rootMean(sums.offset2, sums.count);
  score.direction_rmse_deg = degreesOf(rootMean(sums.angle2, sums.count));
  if (sums.length_m > 0.0) score.extent_on_truth = sums.on_truth_m / sums.length_m;
  if (score.nees_landmarks > 0) score.nees_mean = nees / static_cast<double>(score.nees_landmarks);
  walls = scoreWalls(table);
  return score;
}

}  // namespace colonnade
