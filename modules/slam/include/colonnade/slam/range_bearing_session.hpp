// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "colonnade/frames/frame_source.hpp"
#include "colonnade/motion/motion_estimator.hpp"
#include "colonnade/slam/place_search.hpp"
#include "colonnade/slam/range_bearing_estimator.hpp"
#include "colonnade/slam/session.hpp"
#include "colonnade/slam/smoothed_drive.hpp"

namespace colonnade {

/// The main loop for logs without images: frames of landmark readings in, an estimate out; shaped
/// like Session. The drive is smoothed while it goes on (RangeBearing.smooth_every) and at the end
/// (RangeBearing.smooth).
class RangeBearingSession {
 public:
  /// from: a map to go on from. Throws Error (kUsage) for options that contradict each other and
  /// for a map made from cameras.
  RangeBearingSession(const RangeBearingOptions& options, const FilterOptions& filter,
                      const MotionOptions& motion, std::optional<Resumption> from = std::nullopt);

  /// Called after each frame; false stops the run.
  using Observer = std::function<bool(const Frame&, const StepReport&, const RangeBearingSession&)>;
  void run(FrameSource& source, const Observer& observer);

  const RangeBearingOptions& options() const { return options_; }
  const EkfSlam& filter() const { return estimator_.filter(); }
  const RangeBearingEstimator& estimator() const { return estimator_; }
  /// The robot as it is known by now, better than the estimator has it where the drive so far is
  /// smoothed (RangeBearing.smooth_every). In the world of trajectory(), map() and savedMap().
  const DriveSoFar::Now& now() const { return so_far_.now(); }
  /// What the whole log says, once run() has come to its end; nothing with RangeBearing.smooth off
  /// or where smoothedDrive() has nothing.
  const std::optional<SmoothedDrive>& smoothed() const { return smoothed_; }
  /// Smoothed, once it is. Where the log's identities are believed and every landmark has one, they
  /// are the ids of the map; otherwise those of the filter, with new ones for what only the look
  /// back found.
  LandmarkMap map() const;
  /// Every frame as it was known at its moment, or, before its place was found, when that was.
  const Trajectory& trajectory() const { return trajectory_; }
  /// Why the drive was not smoothed though it should be, that the start may be wrong or the sensor
  /// off; a line each.
  std::vector<std::string> notes() const;
  /// As long as nobody knows where in the map that was loaded the robot is; then nullptr.
  const PlaceSearch* search() const { return search_ ? &*search_ : nullptr; }
  /// What a later run needs to go on: smoothed, once it is, up to 500 landmarks.
  SavedMap savedMap() const;
  /// What the sensor is always off by, where that is estimated; smoothed, once it is.
  std::optional<SensorEstimate> sensor() const {
    return smoothed_ ? smoothed_->sensor : filter().sensor();
  }
  std::size_t axisCount() const { return 0; }
  /// The decisions against the identities of the log, also where those are hidden from the filter.
  IdentityScore identityScore() const;

 private:
  struct Taken {
    double stamp_s;
    MotionIncrement motion;
    RangeBearingScan scan;
  };
  RangeBearingReport take(const Taken& frame);
  std::optional<int> identityOf(LandmarkId landmark) const;
  SavedMap smoothedMap() const;
  void lookForPlace(const Taken& frame, const RangeBearingReport& taken, std::size_t index,
                    std::vector<Event>& events);

  RangeBearingOptions options_;
  FilterOptions filter_options_;
  std::optional<Resumption> from_;
  std::optional<PlaceSearch> search_;
  std::vector<Taken> since_;  ///< while the place is searched
  Trajectory trajectory_;
  double way_m_ = 0.0;
  RangeBearingEstimator estimator_;
  MotionEstimator motion_;
  DriveRecord record_;
  DriveSoFar so_far_;
  std::optional<SmoothedDrive> smoothed_;
  std::vector<int> identities_;  ///< of all readings so far
};

}  // namespace colonnade
