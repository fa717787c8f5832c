// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/mapper.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "colonnade/slam/floor_directions.hpp"

namespace colonnade {
namespace {

/// Books what the update used, and counts what it did not. Returns the landmarks used, ascending.
std::vector<LandmarkId> book(const Observation& seen, const Association& association,
                             const std::vector<bool>& used, EkfSlam& filter,
                             LandmarkBook& landmarks) {
  std::map<std::size_t, LandmarkId> landmark_of_detection;
  std::vector<LandmarkId> together;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    const std::size_t d = association.detection_of_match[i];
    const LandmarkId id = association.matches[i].landmark;
    landmarks.observe(id, seen.detections[d], seen.stamp_s, filter);
    landmark_of_detection.emplace(d, id);
    together.push_back(id);
  }
  landmarks.observeTogether(together);
  for (const auto& [d, id] : landmark_of_detection) {
    const auto& partner = seen.detections[d].partner;
    if (!partner || *partner <= d) continue;
    if (const auto other = landmark_of_detection.find(*partner);
        other != landmark_of_detection.end())
      landmarks.observePair(id, other->second);
  }
  for (const auto& [reason, count] : association.refused)
    for (std::size_t i = 0; i < count; ++i) filter.health().refuse(reason);
  for (const std::string& reason : seen.lacking) filter.health().refuse(reason);
  for (const Detection& detection : seen.detections)
    if (!detection.accepted()) filter.health().refuse(detection.refusal);
  std::sort(together.begin(), together.end());
  return together;
}

/// Only landmarks beyond probation are compared: the initializer still watches the others.
LoopOptions confirmedOnly(LoopOptions loops, const InitializationOptions& initialization) {
  loops.min_observations = std::max(loops.min_observations, initialization.probation_sightings);
  return loops;
}

/// What was seen while the place is searched is kept so long, and mapped again.
constexpr std::size_t kMostFramesOfSearch = 3000;
/// Of the start in a fixed map, up to which the association finds the landmarks by itself.
constexpr double kKnownStart_m = 0.2;

}  // namespace

Mapper::Mapper(const MapperOptions& options)
    : options_(options),
      association_(options.association),
      estimate_{EkfSlam(options.filter),
                {},
                Initializer(options.initialization),
                AxisTracker(options.axes),
                HallwayTracker(options.hallways),
                LoopCloser(confirmedOnly(options.loops, options.initialization)),
                Upkeep(options.upkeep),
                Trail(options.trail)} {}

Mapper::Mapper(const MapperOptions& options, Resumption from) : Mapper(options) {
  if (from.anywhere) {
    search_ = std::make_shared<Search>(Search{PlaceSearch(std::move(from)), {}});
    return;
  }
  T_world_start_ = from.map.T_world_start;
  Estimate& e = estimate_;
  e.filter = EkfSlam(options.filter, std::move(from.map.state));
  e.filter.placeRobot(from.T_world_robot, from.covariance);
  if (from.localize) e.filter.fixMap();
  // A start the association cannot rely on: landmarks of now must first be found among those of
  // then.
  const Eigen::Matrix2d P_start = from.covariance.topLeftCorner<2, 2>();
  e.grows = !from.localize || P_start.trace() > 2.0 * kKnownStart_m * kKnownStart_m;
  e.landmarks = std::move(from.map.book);
  e.landmarks.drive(options.loops.sleep_after_m + 1e-3);
  e.axes = AxisTracker(options.axes, std::move(from.map.axes));
  e.hallways = HallwayTracker(options.hallways, std::move(from.map.hallways));
}

MapperReport Mapper::step(const Observation& seen) {
  const Pose2 T_world_before = estimate_.filter.pose();
  const Eigen::Matrix3d P_before = estimate_.filter.poseCovariance();
  MapperReport report = map(seen);
  if (search_) lookForPlace(seen, T_world_before, P_before, report);
  return report;
}

std::vector<PlaceMark> Mapper::recentMarks(double recent_m) const {
  const LandmarkBook& book = estimate_.landmarks;
  return placeMarks(
      estimate_.filter.state(),
      [&](const Block& block) {
        return block.evidence.observations >= options_.initialization.probation_sightings &&
               book.way() - book.seenOnWay(block.id).last_m < recent_m;
      },
      [](LandmarkId) { return std::nullopt; }, [&](LandmarkId id) { return book.looks(id); });
}

void Mapper::lookForPlace(const Observation& seen, const Pose2& T_world_before,
                          const Eigen::Matrix3d& P_before, MapperReport& report) {
  const std::shared_ptr<Search> search = search_;
  search->since.push_back({seen, T_world_before, P_before});
  if (search->since.size() > kMostFramesOfSearch) search->since.pop_front();
  auto here = recentMarks(search->places.options().recent_m);
  if (!search->places.isDue(here.size(), estimate_.landmarks.way())) return;
  auto from = search->places.look(std::move(here), estimate_.filter.state());
  if (!from) return;
  // What is kept begins with the drive, or, after a long one, later.
  const Search::Seen& first = search->since.front();
  Eigen::Matrix3d J_start, J_first;
  from->T_world_robot = compose(from->T_world_robot, first.T_world_before, &J_start, &J_first);
  from->covariance = (J_start * from->covariance * J_start.transpose() +
                      J_first * first.P_before * J_first.transpose())
                         .eval();
  *this = Mapper(options_, std::move(*from));
  report.events.push_back(search->places.found(seen.stamp_s, seen.index));
  for (const Search::Seen& again : search->since) {
    MapperReport mapped = map(again.observation);
    report.association = std::move(mapped.association);
    report.events.insert(report.events.end(), mapped.events.begin(), mapped.events.end());
  }
}

MapperReport Mapper::map(const Observation& seen) {
  const bool verifies = !seen.sight.rays.empty() && options_.loops.verify_m > 0.0;
  if (verifies && !snapshot_) awaitReturn();
  const int closings = estimate_.closings;
  MapperReport report = advance(seen);
  if (before_return_) before_return_->since.push_back(seen);
  if (snapshot_) {
    snapshot_->since.push_back(seen);
    verify(seen, report.events);
  } else if (before_return_ && estimate_.closings > closings) {
    snapshot_ = std::exchange(before_return_, std::nullopt);
    snapshot_->way_m = estimate_.landmarks.way();  // from here on it is verified
  } else if (const auto loop = estimate_.loops.step(estimate_.filter, estimate_.landmarks)) {
    close(*loop, seen, report.events);
  }
  return report;
}

MapperReport Mapper::advance(const Observation& seen) {
  auto& [filter, landmarks, initializer, axes, hallways, loops, upkeep, trail, former_stamp_s,
         closings, grows] = estimate_;
  MapperReport report;
  Frame frame;  // only its instant
  frame.index = seen.index;
  frame.stamp_s = seen.stamp_s;

  filter.predict(seen.motion.T_previous_robot, seen.motion.covariance);
  landmarks.drive(std::hypot(seen.motion.T_previous_robot.x, seen.motion.T_previous_robot.y));
  const double noise_scale =
      correlatedNoiseScale(seen.stamp_s - former_stamp_s, filter.options().error_correlation_s);
  former_stamp_s = seen.stamp_s;
  const bool has_depth = !seen.walls.empty() || !seen.sight.rays.empty();
  axes.step(frame, has_depth ? seen.walls : floorEdgeDirections(seen.detections), noise_scale,
            filter, report.events);
  // Who sleeps is woken by landmarks founded beside it. Where none are, the joint test of the
  // association alone has to keep neighbours apart.
  if (grows) loops.updateSleep(filter, landmarks);
  report.association = association_.match(seen.detections, filter, landmarks);
  const auto used = filter.update(report.association.matches, noise_scale);
  const auto matched = book(seen, report.association, used, filter, landmarks);
  if (grows)
    initializer.step(frame, seen.detections, report.association, filter, landmarks, report.events);
  for (const LandmarkId id : filter.settleInverseDepths())
    report.events.push_back({seen.stamp_s, seen.index, "settled", id, "inverse depth to x, y"});
  keepUp(seen, matched, report.events);
  hallways.step(seen, matched, filter, report.events);
  trail.step(seen.stamp_s, filter);
  if (const int places = loops.stepReturn(filter, landmarks, trail); places > 0) {
    ++closings;
    report.events.push_back({seen.stamp_s, seen.index, "loop closing", std::nullopt,
                             std::to_string(places) + " places recognised by the association"});
  }
  return report;
}

void Mapper::keepUp(const Observation& seen, const std::vector<LandmarkId>& matched,
                    std::vector<Event>& events) {
  auto& e = estimate_;
  const auto isYoung = [&](LandmarkId id) {
    return e.filter.evidence(id).observations < options_.initialization.probation_sightings;
  };
  for (const LandmarkId id : e.upkeep.findGone(seen, matched, e.filter, e.landmarks)) {
    if (isYoung(id)) continue;
    e.filter.remove(id);
    e.landmarks.forget(id);
    e.upkeep.forget(id);
    events.push_back({seen.stamp_s, seen.index, "gone", id, "in view and not seen"});
  }
  if (!e.upkeep.lookEnded()) return;
  if (options_.upkeep.merge_twins)
    fuseAll(e.loops.foundTwice(e.filter, e.landmarks), {}, seen, events);
  for (const Twins& twins : e.upkeep.findTwins(e.filter, e.landmarks))
    if (!isYoung(twins.kept) && !isYoung(twins.twin)) fuseAll({&twins, 1}, {}, seen, events);
}

bool Mapper::fuseAll(std::span<const Twins> twins, const TwinNoise& noise, const Observation& seen,
                     std::vector<Event>& events) {
  auto& e = estimate_;
  if (twins.empty() || !fuse(twins, noise, e.filter, e.landmarks)) return false;
  for (const Twins& pair : twins) {
    e.hallways.merge(pair.kept, pair.twin);
    e.upkeep.forget(pair.twin);
    events.push_back({seen.stamp_s, seen.index, "fused", pair.kept,
                      "with " + std::to_string(number(pair.twin))});
  }
  return true;
}

LandmarkMap Mapper::map() const {
  LandmarkMap map = estimate_.filter.landmarkMap();
  std::erase_if(map, [&](const auto& record) { return estimate_.landmarks.isJoint(record.id); });
  estimate_.landmarks.fillPairs(map);
  estimate_.hallways.fill(map);
  return map;
}

SavedMap Mapper::savedMap() const {
  SavedMap map;
  EkfSlam filter = estimate_.filter;
  std::vector<LandmarkId> clones;
  for (const Block& block : filter.state().blocks)
    if (block.block_kind == BlockKind::kPoseClone || block.evidence.hypothesis)
      clones.push_back(block.id);
  for (const LandmarkId id : clones) filter.remove(id);
  filter.placeRobot({}, Eigen::Matrix3d::Zero());
  map.state = filter.state();
  map.T_world_start = T_world_start_;
  map.book = estimate_.landmarks;
  map.axes = estimate_.axes.axes();
  map.hallways = estimate_.hallways.hallways();
  return map;
}

}  // namespace colonnade
