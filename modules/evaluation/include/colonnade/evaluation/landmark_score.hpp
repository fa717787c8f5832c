// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/options.hpp"
#include "colonnade/base/pose2.hpp"
#include "colonnade/evaluation/anchor.hpp"
#include "colonnade/filter/landmark_map.hpp"

namespace colonnade {

/// When an estimated landmark may be a true one, and which true ones a robot could have found.
struct LandmarkScoreOptions {
  static constexpr const char* kSection = "LandmarkScore";
  double gate_m = 0.3;          ///< points: distance; floor edges: distance across the line
  double gate = radians(10.0);  ///< floor edges: between the directions
  int min_observations = 10;    ///< a true landmark seen in fewer frames need not be found

  void visit(OptionVisitor& v) {
    v.number("gate_m", gate_m, {0.001, 10.0}, "largest distance of a landmark from the true one");
    v.angle("gate_deg", gate, {0.1, 45.0}, "largest angle of a floor edge to the true one");
    v.integer("min_observations", min_observations, {0, 1000000},
              "frames that must have seen a true landmark before it counts as missed");
  }
};

/// How well the landmarks of one kind were found. Numbers without data are absent.
struct KindScore {
  std::size_t estimated = 0;
  std::size_t right = 0;       ///< assigned to a true landmark, one to one
  std::size_t further = 0;     ///< floor edges: another piece of a wall, beside the assigned one
  std::size_t duplicates = 0;  ///< within the gate only of landmarks that have theirs
  std::vector<LandmarkId> duplicate_ids;
  std::vector<LandmarkId> false_ids;  ///< nothing true within the gate
  std::size_t other_kind = 0;  ///< false ones with a true upright landmark of the other kind there
  std::size_t true_seen = 0;   ///< true landmarks seen in min_observations frames or more
  std::size_t true_found = 0;  ///< of those, the assigned ones
  std::vector<LandmarkId> missed_ids;  ///< the others, numbered as in the truth
  std::optional<double> precision;     ///< (right + further) / estimated
  std::optional<double> recall;        ///< true_found / true_seen

  std::optional<double> position_rmse_m;  ///< points, over the right ones
  std::optional<double> position_median_m;
  std::optional<double> offset_rmse_m;  ///< floor edges: across the line, where the extents overlap
  std::optional<double> direction_rmse_deg;
  /// Floor edges: share of the right ones' length that has a true floor edge beside it, and share
  /// of the seen true length that a right one's extent reaches over.
  std::optional<double> extent_on_truth;
  std::optional<double> length_recall;

  /// Mean of e' P^-1 e over the degrees of freedom (points 2; floor edges 1, across the line).
  std::optional<double> nees_mean;
  std::size_t nees_landmarks = 0;
  /// Points: right ones farther off than their covariance allows in 997 of 1000 cases. Something
  /// else near a true landmark, such as the panels of a door, is often among them.
  std::vector<LandmarkId> improbable_ids;
};

/// Walls by their floor edges, weighted by length.
struct WallScore {
  std::size_t edges = 0;  ///< estimated floor edges that lie on a wall of the truth
  /// Of the angle between two walls, over all pairs, weighted by the product of their lengths; no
  /// alignment enters.
  std::optional<double> angle_rmse_deg;
  /// Of the direction of a wall in the world, after the alignment.
  std::optional<double> direction_rmse_deg;
};

struct LandmarkScore {
  LandmarkScoreOptions options;
  std::array<KindScore, kLandmarkKinds> kinds;
  WallScore walls;
  const KindScore& operator[](LandmarkKind kind) const {
    return kinds[static_cast<std::size_t>(kind)];
  }
};

/// Compares a map with the true one; kinds apart, since a depth-slope corner may stand where a
/// pillar edge does. T_truth_estimate is the alignment of the trajectory. Estimates are assigned
/// one to one (assignment.hpp; cost: squared error over the gate), first to true landmarks that
/// were seen often enough, then to the others. True floor edges in one line (3 cm, 1 degree, same
/// hallway) are one landmark with several pieces, because the estimate's is a line with an extent.
/// NEES takes the anchor of the trajectory (trajectory_score.hpp) instead of the alignment, and
/// leaves out landmarks it does not serve. Throws Error when the truth holds no landmark.
LandmarkScore scoreLandmarks(const LandmarkMap& estimate, const LandmarkMap& truth,
                             const Pose2& T_truth_estimate,
                             const LandmarkScoreOptions& options = {},
                             const std::optional<Anchor>& anchor = std::nullopt);

}  // namespace colonnade
