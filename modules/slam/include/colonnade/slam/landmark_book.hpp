// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "colonnade/detectors/detection.hpp"
#include "colonnade/filter/ekf_slam.hpp"
#include "colonnade/slam/landmark_looks.hpp"

namespace colonnade {

/// What is known of landmarks beside their geometry: how they look and which belong together.
class LandmarkBook {
 public:
  /// Counts an observation: stamps, seen extent of floor edges, appearance.
  void observe(LandmarkId landmark, const Detection& detection, double stamp_s, EkfSlam& filter);
  /// The two edges of one pillar were seen together.
  void observePair(LandmarkId a, LandmarkId b);
  void forget(LandmarkId landmark);
  /// All that is known of `twin` is known of `kept` from now on.
  void merge(LandmarkId kept, LandmarkId twin, const State& state);

  /// The robot has driven on; observations are dated by the way driven.
  void drive(double distance_m) { way_m_ += distance_m; }
  double way() const { return way_m_; }
  /// A way without seeing a landmark, after which seeing it is a return.
  static constexpr double kLongWay_m = 15.0;
  /// The way at which a landmark was first and last seen.
  struct Seen {
    double first_m = 0.0;
    double last_m = 0.0;
    std::optional<double> returned_m;  ///< when it was last seen again after a long way without
  };
  Seen seenOnWay(LandmarkId landmark) const;

  /// A landmark that sleeps is not offered to the association: the way since it was last seen left
  /// its place relative to the robot so uncertain that its neighbours fit as well.
  void setAsleep(LandmarkId landmark, bool asleep) { pages_[landmark].asleep = asleep; }
  bool isAsleep(LandmarkId landmark) const;
  void wakeAll();
  /// A landmark whose place relative to the robot turned out wrong sleeps, however well the filter
  /// believes to know it, until a constellation says where the robot is.
  void setEstranged(const std::set<LandmarkId>& landmarks);
  bool isEstranged(LandmarkId landmark) const;
  void endEstrangement();

  /// Whether two landmarks were matched in one frame: then they are two.
  bool seenTogether(LandmarkId a, LandmarkId b) const;
  void observeTogether(const std::vector<LandmarkId>& landmarks);
  /// Whether both may be the same by their looks.
  bool lookAlike(LandmarkId a, LandmarkId b, const State& state) const;
  /// How far their colours are apart, in gray levels; nothing when one has never been looked at.
  std::optional<double> colourDistance(LandmarkId a, LandmarkId b, const State& state) const;

  /// Whether a detection can be this landmark by its looks: a vertical edge keeps its dark side,
  /// and so does a floor edge that is seen from the other side. The foot of a wall does not: that
  /// is the foot on the wall's other side.
  bool looksLike(const Block& landmark, const Detection& detection, const EkfSlam& filter) const;
  /// How the detection would look from the side of a floor edge's first sighting; others as they
  /// are.
  static Detection fromFirstSide(const Block& landmark, const Detection& detection,
                                 const EkfSlam& filter);

  /// Whether it is a line on the floor and no part of the building.
  bool isJoint(LandmarkId landmark) const;

  /// nullptr for a landmark never observed.
  const LandmarkLooks* looks(LandmarkId landmark) const;

  /// Fills pair_id where two edges are each other's most frequent partner, seen together three
  /// times or more.
  void fillPairs(LandmarkMap& map) const;

 private:
  /// How `of` looks in the axes of `like`: floor edges first seen from opposite sides are turned.
  LandmarkLooks looksInAxesOf(LandmarkId like, LandmarkId of, const State& state) const;
  struct Page {
    LandmarkLooks looks;
    std::map<LandmarkId, int> partners;
    std::set<LandmarkId> company;  ///< seen in one frame with it
    double first_m = 0.0;
    double last_m = 0.0;
    std::optional<double> returned_m;
    bool asleep = false;
    bool estranged = false;
  };
  friend class MapFile;
  std::optional<LandmarkId> bestPartner(LandmarkId landmark) const;
  std::map<LandmarkId, Page> pages_;
  double way_m_ = 0.0;
};

}  // namespace colonnade
