// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "colonnade/filter/ekf_slam.hpp"

namespace colonnade {

/// One reading and the landmarks it may be of.
struct OpenReading {
  Measurement measurement;
  std::vector<LandmarkId> allowed;
};

struct OpenAssociation {
  std::vector<std::optional<LandmarkId>> landmark;  ///< one for each reading
  /// Readings without a landmark, but within near_factor gates of one no other reading took: they
  /// found nothing new.
  std::vector<bool> near;
  bool exhaustive = true;  ///< jcbb: false when the search was cut short
};

struct OpenAssociationOptions {
  bool joint = true;        ///< JCBB; false: nearest neighbours
  bool likelihood = false;  ///< rank by d2 + log|S| in place of d2
  double gate_probability = 0.99;
  double joint_probability = 0.99;
  double near_factor = 2.0;
};

/// Which readings of one frame are of which landmarks, each landmark used once. Nearest neighbours:
/// nearest pairs first. JCBB (Neira and Tardos 2001): the largest set of pairs that passes the
/// chi-square test of all its numbers together, of the largest the one with the least joint
/// distance; the search stops after a fixed number of nodes and keeps the best set found.
OpenAssociation associateOpen(std::span<const OpenReading> readings, const EkfSlam& filter,
                              const OpenAssociationOptions& options);

}  // namespace colonnade
