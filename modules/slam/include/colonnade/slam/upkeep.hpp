// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/options.hpp"
#include "colonnade/filter/ekf_slam.hpp"
#include "colonnade/slam/landmark_book.hpp"
#include "colonnade/slam/observation.hpp"
#include "colonnade/slam/twins.hpp"

namespace colonnade {

struct UpkeepOptions {
  static constexpr const char* kSection = "Upkeep";
  bool remove_gone = true;
  double look_distance_m = 0.15;
  double look_turn = radians(5.0);
  double false_sighting = 0.1;
  double most_evidence = 4.0;
  double gone_evidence = -3.0;
  bool merge_twins = true;
  double merge_distance_m = 0.15;
  double merge_probability = 0.9;

  void visit(OptionVisitor& v) {
    v.flag("remove_gone", remove_gone, "delete landmarks that should be seen and are not");
    v.number("look_distance_m", look_distance_m, {0.01, 10},
             "way after which a further look counts as one of its own");
    v.angle("look_turn_deg", look_turn, {0.5, 180}, "turn after which it does");
    v.number("false_sighting", false_sighting, {0.001, 0.5},
             "probability to take something else for a landmark that is gone");
    v.number("most_evidence", most_evidence, {0.1, 100}, "for a landmark, as log-odds");
    v.number("gone_evidence", gone_evidence, {-100, -0.1}, "below it a landmark is deleted");
    v.flag("merge_twins", merge_twins, "merge landmarks that are one");
    v.number("merge_distance_m", merge_distance_m, {0.01, 1}, "farthest twins");
    v.number("merge_probability", merge_probability, {0.1, 0.9999},
             "share of right twins the chi-square test lets through");
  }
};

/// Keeps the map true while the robot drives (thesis 2012, table 3.1: landmark deletion).
///
/// Existence: a landmark that stands in view, within the distances it was seen from, with nothing
/// in front of it, and is not seen, loses log-odds; each look from a new place counts once, and a
/// landmark that is often missed loses little by one more miss. A look that misses most of what it
/// should show says something about the light, not about landmarks, and does not count.
class Upkeep {
 public:
  explicit Upkeep(const UpkeepOptions& options) : options_(options) {}

  /// One frame, after the update, with the landmarks matched in it. Returns those that are gone:
  /// the caller removes them.
  std::vector<LandmarkId> findGone(const Observation& seen, const std::vector<LandmarkId>& matched,
                                   const EkfSlam& filter, const LandmarkBook& book);
  /// After a look: pairs that pass the chi-square test on their difference with all correlations,
  /// look alike and were never seen together.
  std::vector<Twins> findTwins(const EkfSlam& filter, const LandmarkBook& book) const;
  bool lookEnded() const { return look_ended_; }
  void forget(LandmarkId landmark) { records_.erase(landmark); }
  /// Looks at these are evidence for the robot's place among them from now on.
  void watch(std::set<LandmarkId> landmarks) {
    watched_ = std::move(landmarks);
    tally_ = {};
  }
  /// Of the watched landmarks: looks that should have shown one, and those that did. `doubt` is
  /// the cumulative sum of the log-likelihood ratio of their hits and misses, that the robot is
  /// elsewhere over that it is here, never below zero: high after a run of misses, however much
  /// was seen before (E. S. Page, Continuous inspection schemes, Biometrika 41, 1954). A look at
  /// nothing but absence adds nothing.
  struct Tally {
    int expected = 0;
    int seen = 0;
    double doubt = 0.0;
  };
  const Tally& tally() const { return tally_; }

 private:
  struct Record {
    double evidence = 1.0;
    int looks = 0;
    int hits = 0;
    double nearest_m = 1e9;  ///< it was seen from
    double farthest_m = 0.0;
    int frames_expected = 0;  ///< in the present look
    bool hit = false;

    /// Of looks that show it, as far as known: a Beta(2, 1) prior.
    double share() const;
  };
  double weigh(const Record& watched);
  void endLook(std::vector<LandmarkId>& gone);

  UpkeepOptions options_;
  std::map<LandmarkId, Record> records_;
  std::optional<Pose2> T_world_look_;
  int frames_ = 0;
  bool look_ended_ = false;
  std::set<LandmarkId> watched_;
  Tally tally_;
};

/// Whether nothing known stands before this point of the world, and it is well in view; false where
/// depth does not tell.
bool isInView(const Eigen::Vector2d& p_world, const Pose2& T_world_robot, const Sight& sight);

}  // namespace colonnade
