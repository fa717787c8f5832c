// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/landmark.hpp"
#include "colonnade/base/options.hpp"
#include "colonnade/base/pose2.hpp"
#include "colonnade/slam/landmark_looks.hpp"

namespace colonnade {

/// How a place in a map is found again from nothing.
struct PlaceOptions {
  static constexpr const char* kSection = "Places";
  double tolerance_m = 0.15;
  int min_places = 5;
  int min_named_places = 3;
  double min_share = 0.75;
  double min_evidence = 19.0;
  double ambiguity = 0.5;
  int confirmations = 2;
  double recent_m = 20.0;
  double try_every_m = 0.5;

  void visit(OptionVisitor& v) {
    v.number("tolerance_m", tolerance_m, {0.01, 2}, "between a landmark and that of the map");
    v.integer("min_places", min_places, {3, 1000}, "different places that must fit");
    v.integer("min_named_places", min_named_places, {2, 1000},
              "the same where the log tells their identities");
    v.number("min_share", min_share, {0, 1}, "of the places within the map that must fit");
    v.number("min_evidence", min_evidence, {0, 1000},
             "against chance, as a natural logarithm: more places that fit, or fit better");
    v.number("ambiguity", ambiguity, {0, 1},
             "with this share of the evidence for another place nothing is found");
    v.integer("confirmations", confirmations, {1, 20}, "in a row before the place is believed");
    v.number("recent_m", recent_m, {1, 1000},
             "way whose landmarks are compared with the map (cameras)");
    v.number("try_every_m", try_every_m, {0.05, 10}, "of the way the place is looked for");
  }
};

/// A landmark with a place, as maps are compared by.
struct PlaceMark {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();  ///< in the world of its map
  LandmarkKind kind = LandmarkKind::kPillarEdge;
  std::optional<int> identity;           ///< in the log
  const LandmarkLooks* looks = nullptr;  ///< where it was seen by a camera
  int offset = 0;                        ///< in the state of its map
};

/// Where a small map lies in a large one, if it is known.
struct FoundPlace {
  Pose2 T_map_here;
  /// Marks of the small map with those of the large one they fit.
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  int fits = 0;  ///< places that fit
  int of = 0;    ///< places of the small map where the large one has any
  double rms_m = 0.0;
  double evidence = 0.0;                      ///< against chance, as a natural logarithm
  double elsewhere = 0.0;                     ///< the most for any other place
  std::string refusal = "too few landmarks";  ///< empty: it stands
};

/// Lays a map just begun onto a known one: pairs of its landmarks are laid onto pairs of the same
/// length, kinds and looks (pose clustering: Stockman, Computer Vision, Graphics, and Image
/// Processing 40(3), 1987), the best of these are fitted by least squares, and the one chance does
/// least as well as is taken if nothing else comes near it. A place is what lies within 10 cm.
FoundPlace findPlace(std::span<const PlaceMark> map, std::span<const PlaceMark> here,
                     const PlaceOptions& options);

}  // namespace colonnade
