// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "colonnade/filter/ekf_slam.hpp"
#include "colonnade/slam/association.hpp"
#include "colonnade/slam/axis_tracker.hpp"
#include "colonnade/slam/event.hpp"
#include "colonnade/slam/hallway.hpp"
#include "colonnade/slam/initializer.hpp"
#include "colonnade/slam/landmark_book.hpp"
#include "colonnade/slam/loop_closer.hpp"
#include "colonnade/slam/observation.hpp"
#include "colonnade/slam/place_search.hpp"
#include "colonnade/slam/resumption.hpp"
#include "colonnade/slam/trail.hpp"
#include "colonnade/slam/twins.hpp"
#include "colonnade/slam/upkeep.hpp"

namespace colonnade {

/// The options of everything after the detectors.
struct MapperOptions {
  FilterOptions filter;
  AssociationOptions association;
  InitializationOptions initialization;
  AxisOptions axes;
  HallwayOptions hallways;
  LoopOptions loops;
  UpkeepOptions upkeep;
  TrailOptions trail;

  template <class Take>
  void each(Take&& take) {
    take(filter);
    take(association);
    take(initialization);
    take(axes);
    take(hallways);
    take(loops);
    take(upkeep);
    take(trail);
  }
};

/// What one frame did to the map.
struct MapperReport {
  Association association;
  std::vector<Event> events;
};

/// From what was seen to a map: the second half of the main loop, without images.
class Mapper {
 public:
  explicit Mapper(const MapperOptions& options);
  /// From anywhere: maps on its own, in a world that starts with the robot, until the place in the
  /// map is found; then all that was seen is mapped again from where the start turned out to be.
  Mapper(const MapperOptions& options, Resumption from);

  MapperReport step(const Observation& seen);

  /// As long as nobody knows where in the map that was loaded the robot is; then nullptr.
  const PlaceSearch* search() const { return search_ ? &search_->places : nullptr; }
  const EkfSlam& filter() const { return estimate_.filter; }
  /// Landmarks with what the book and the hallways know of them.
  LandmarkMap map() const;
  /// What a later run needs to go on.
  SavedMap savedMap() const;
  std::size_t axisCount() const { return estimate_.axes.axes().size(); }
  const std::vector<Hallway>& hallways() const { return estimate_.hallways.hallways(); }
  /// Where the robot was at every frame, as known now.
  std::vector<Trail::StampedPose2> trajectory() const {
    return estimate_.trail.poses(estimate_.filter);
  }
  int loopClosings() const { return estimate_.closings; }
  const LoopCandidate& lastSearch() const { return estimate_.loops.last(); }

 private:
  /// All that changes from frame to frame; a copy of it is a snapshot, but for bearings that are no
  /// landmark yet.
  struct Estimate {
    EkfSlam filter;
    LandmarkBook landmarks;
    Initializer initializer;
    AxisTracker axes;
    HallwayTracker hallways;
    LoopCloser loops;
    Upkeep upkeep;
    Trail trail;
    double former_stamp_s = std::numeric_limits<double>::infinity();
    int closings = 0;
    bool grows = true;  ///< new landmarks are founded
  };
  /// As it stood before a loop was closed, with what was seen since.
  struct Snapshot {
    Estimate estimate;
    double way_m = 0.0;  ///< of the closing; before a return: of the copy, or of the first meeting
    std::set<LandmarkId> old;              ///< landmarks the closing brings back
    std::optional<Eigen::Vector2d> shift;  ///< of the constellation; the association has none
    std::vector<Observation> since = {};
    bool met = false;  ///< an old landmark, since the copy
  };

  /// Until the place is found.
  struct Search {
    struct Seen {
      Observation observation;
      Pose2 T_world_before;      ///< the robot, before its motion
      Eigen::Matrix3d P_before;  ///< and its covariance
    };
    PlaceSearch places;
    std::deque<Seen> since;
  };

  MapperReport map(const Observation& seen);
  void lookForPlace(const Observation& seen, const Pose2& T_world_before,
                    const Eigen::Matrix3d& P_before, MapperReport& report);
  std::vector<PlaceMark> recentMarks(double recent_m) const;
  MapperReport advance(const Observation& seen);
  void keepUp(const Observation& seen, const std::vector<LandmarkId>& matched,
              std::vector<Event>& events);
  /// Makes twins one in all that knows of them; false, and nothing changed, when the filter cannot.
  bool fuseAll(std::span<const Twins> twins, const TwinNoise& noise, const Observation& seen,
               std::vector<Event>& events);
  void close(const LoopCandidate& loop, const Observation& seen, std::vector<Event>& events);
  void settleInMap();
  void awaitReturn();
  void verify(const Observation& seen, std::vector<Event>& events);
  void undo(const Observation& seen, std::vector<Event>& events);
  /// Takes what unfinished bearings hold in the state out of it.
  static void dropBearings(Estimate& estimate);

  MapperOptions options_;
  Pose2 T_world_start_;  ///< of the drive that began the map
  Associator association_;
  Estimate estimate_;
  std::shared_ptr<Search> search_;
  std::optional<Snapshot> snapshot_;       ///< of the last closing, until it is verified
  std::optional<Snapshot> before_return_;  ///< near old landmarks, from before any was met again
};

}  // namespace colonnade
