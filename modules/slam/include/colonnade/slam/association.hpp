// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "colonnade/detectors/detection.hpp"
#include "colonnade/filter/ekf_slam.hpp"
#include "colonnade/slam/landmark_book.hpp"

namespace colonnade {

struct AssociationOptions {
  static constexpr const char* kSection = "Association";
  double joint_probability = 0.99;
  double near_factor = 2.0;
  double floor_edge_gap_m = 1.5;

  void visit(OptionVisitor& v) {
    v.number("joint_probability", joint_probability, {0.5, 0.999999},
             "share of right joint hypotheses the joint chi-square test lets through");
    v.number("near_factor", near_factor, {1, 100},
             "a detection within this many times the gate of a landmark founds no new one");
    v.number("floor_edge_gap_m", floor_edge_gap_m, {0, 20},
             "between the seen parts of one floor edge");
  }
};

/// Which detections are which landmarks, in one frame.
struct Association {
  std::vector<Match> matches;
  std::vector<std::size_t> detection_of_match;  ///< index into the frame's detections
  /// Unmatched detections so near to a landmark that they may be it: they found nothing new.
  std::vector<bool> near_landmark;
  std::size_t refused_jointly = 0;
};

/// Nearest neighbours under per-kind chi-square gates, each landmark and each detection used once,
/// then a test of all matches together: while their joint Mahalanobis distance is beyond the
/// chi-square bound of its degrees of freedom, the worst single one is dropped.
class Associator {
 public:
  explicit Associator(const AssociationOptions& options) : options_(options) {}
  Association match(const Detections& detections, const EkfSlam& filter,
                    const LandmarkBook& book) const;

 private:
  AssociationOptions options_;
};

}  // namespace colonnade
