// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "colonnade/filter/ekf_slam.hpp"
#include "colonnade/slam/constellation.hpp"
#include "colonnade/slam/landmark_book.hpp"
#include "colonnade/slam/loop_options.hpp"
#include "colonnade/slam/trail.hpp"

namespace colonnade {

/// Lets landmarks fall asleep that the way has made uncertain, and finds the constellation of
/// recent ones that is a sleeping one. A closing is found when the same displacement stood the
/// tests several times in a row.
class LoopCloser {
 public:
  explicit LoopCloser(const LoopOptions& options) : options_(options) {}

  /// One frame, before the association: who sleeps.
  void updateSleep(const EkfSlam& filter, LandmarkBook& book);
  /// One frame, after the update: a constellation to close the loop with, if there is one.
  std::optional<LoopCandidate> step(const EkfSlam& filter, const LandmarkBook& book);
  /// Landmarks of long ago that have been founded a second time meanwhile, since they slept for a
  /// neighbour's sake or were not recognised: how they stand to each other tells which is which,
  /// where the robot is sure enough of its place and only one way fits.
  std::vector<Twins> foundTwice(const EkfSlam& filter, const LandmarkBook& book) const;
  /// One frame, after the association's matches are booked: whether the robot came back over new
  /// ground to a place that the association itself knows again, because the way was short or well
  /// measured. Says so once per return; the number of places recognised, else 0.
  int stepReturn(const EkfSlam& filter, const LandmarkBook& book, const Trail& trail);
  /// Whether the next frames may be such a return: not where the robot has long been before.
  bool mayReturn(const LandmarkBook& book) const;
  /// The last search, for reports: empty refusal and no twins when there was none.
  const LoopCandidate& last() const { return last_; }
  /// A closing with this displacement turned out wrong: it is not tried again.
  void forbid(const Eigen::Vector2d& shift) { forbidden_.push_back(shift); }

  const LoopOptions& options() const { return options_; }

 private:
  /// A part of the building seen often enough to be told from others by where it stands; joints of
  /// the floor repeat too regularly.
  bool isComparable(const Block& block, const LandmarkBook& book) const;

  LoopOptions options_;
  LoopCandidate last_;
  std::vector<Eigen::Vector2d> forbidden_;
  double sleep_checked_m_ = -1e9;
  double searched_m_ = -1e9;
  int confirmed_ = 0;
  Eigen::Vector2d confirmed_shift_ = Eigen::Vector2d::Zero();
  double new_ground_m_ = 0.0;  ///< way at which the robot last was where it had not been before
  bool returned_ = false;
};

/// The larger standard deviation of a landmark's place (lines, far bearings: of its anchor) as seen
/// from the robot, metres.
double relativeSigma(LandmarkId landmark, const EkfSlam& filter);

}  // namespace colonnade
