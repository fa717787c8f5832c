// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "colonnade/detectors/detection.hpp"
#include "colonnade/filter/ekf_slam.hpp"
#include "colonnade/slam/association_options.hpp"
#include "colonnade/slam/landmark_book.hpp"

namespace colonnade {

/// Which detections are which landmarks, in one frame.
struct Association {
  std::vector<Match> matches;
  std::vector<std::size_t> detection_of_match;  ///< index into the frame's detections
  /// Unmatched detections so near to a landmark that they may be it: they found nothing new.
  std::vector<bool> near_landmark;
  /// Detections that lie near a landmark and were not matched, by reason.
  std::map<std::string, std::size_t> refused;
};

/// Pairs within the chi-square gate of their kind that look alike; of those the nearest or, with
/// jcbb, the largest set that passes the chi-square test of all its numbers together, each landmark
/// and each detection used once. Where a frame holds many, one-point RANSAC may choose instead.
/// What is no likelier than that something else was detected there is left out.
class Associator {
 public:
  explicit Associator(const AssociationOptions& options) : options_(options) {}
  Association match(const Detections& detections, const EkfSlam& filter,
                    const LandmarkBook& book) const;

 private:
  AssociationOptions options_;
};

}  // namespace colonnade
