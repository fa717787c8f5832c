// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "colonnade/filter/ekf_slam.hpp"
#include "colonnade/slam/landmark_book.hpp"
#include "colonnade/slam/loop_options.hpp"
#include "colonnade/slam/twins.hpp"

namespace colonnade {

/// A set of landmarks of now that together may be landmarks of then.
struct Constellation {
  std::vector<Twins> twins;
  double distance2 = 0.0;  ///< joint squared Mahalanobis distance of all differences
  int degrees_of_freedom = 0;
  int places = 0;       ///< vertical landmarks, those nearer than 10 cm counted once
  int floor_edges = 0;  ///< among the twins
  double spread_m = 0.0;
  double share = 0.0;  ///< of the recent places around it that are among the twins
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< mean displacement from then to now
  double largest_shift_m = 0.0;                     ///< of its vertical landmarks
  std::optional<double> colour_levels;              ///< median colour distance of the twins
  double other_colour_levels = 0.0;                 ///< of all other pairings of the same landmarks
};

/// What a search found: the best constellation, and why it is not enough, if so.
struct LoopCandidate {
  Constellation best;
  std::string refusal;  ///< empty: it stands, and needs cues besides to be closed
  std::string cues;     ///< what speaks for it
};

/// Looks for the largest jointly compatible set of pairs (recent, sleeping). Pairs must look alike
/// and lie within the uncertainty of the filter, widened by a drift it may not know of; the set is
/// grown by sequential conditioning from each pair as seed, which gives the joint chi-square
/// distance with all correlations (joint compatibility: Neira and Tardos, IEEE TRA 17(6), 2001).
LoopCandidate findConstellation(const std::vector<LandmarkId>& sleeping,
                                const std::vector<LandmarkId>& recent, const EkfSlam& filter,
                                const LandmarkBook& book, const LoopOptions& options);

}  // namespace colonnade
