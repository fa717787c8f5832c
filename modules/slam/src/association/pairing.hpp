// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "colonnade/filter/ekf_slam.hpp"

namespace colonnade {

/// A detection that may be of a landmark: it lies within the gate and looks alike.
struct Pairing {
  std::size_t detection = 0;
  LandmarkId landmark{};
  double distance2 = 0.0;  ///< alone
  double cost = 0.0;       ///< distance2, and by how much the looks differ
  /// Logarithm of how many detections of something else lie in one unit of what is measured
  /// (1/rad, 1/(rad m)).
  double log_clutter = 0.0;
};

/// All pairings of a frame and how their innovations hang together: pairing i has the rows
/// [first[i], first[i] + size[i]) of nu and S. Sets of pairings are indices into `pairings`.
struct JointPairings {
  std::vector<Pairing> pairings;
  Eigen::VectorXd nu;
  Eigen::MatrixXd S;  ///< without the noise two pairings of one detection share
  std::vector<Eigen::Index> first;
  std::vector<Eigen::Index> size;
};

/// The cheapest pairings first, each detection and each landmark once.
std::vector<std::size_t> nearestPairings(const std::vector<Pairing>& pairings);

/// The largest set, each detection and each landmark once, that passes the chi-square test of all
/// its numbers together; of the largest sets the cheapest (joint compatibility branch and bound,
/// Neira and Tardos 2001; MRPT's data association of that name tests pairs only). Visits at most
/// `most_nodes` nodes, after which the best set so far counts.
std::vector<std::size_t> jointPairings(const JointPairings& joint, double probability,
                                       int most_nodes);

/// The largest set that agrees with one single pairing, every one tried, and what lies within its
/// gate once all of that set have corrected the state (one-point RANSAC, Civera, Grasa, Davison and
/// Montiel 2010; linear, on S alone). `probability`: of the last chi-square test.
std::vector<std::size_t> consensusPairings(const JointPairings& joint, double probability);

/// What is left of a set when each of its pairings, given the rest, is likelier than that something
/// else was detected there; the unlikeliest go first. A lone bearing says little to a robot that is
/// unsure of itself, several that fit together a lot. (The score of a track in multiple hypothesis
/// tracking, Blackman 2004; the density given the rest after Rasmussen and Williams 2006, 5.4.2.)
std::vector<std::size_t> likelierThanClutter(const JointPairings& joint,
                                             std::vector<std::size_t> set);

/// The squared joint Mahalanobis distance of a set; infinite when its S is singular.
double jointDistance2(const JointPairings& joint, const std::vector<std::size_t>& set);
int degreesOfFreedom(const JointPairings& joint, const std::vector<std::size_t>& set);

}  // namespace colonnade
