// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/range_bearing_session.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "colonnade/filter/covariance.hpp"
#include "sensor_note.hpp"
#include "stopwatch.hpp"

namespace colonnade {
namespace {

Evidence evidenceOf(const LandmarkRecord& landmark) {
  Evidence evidence;
  evidence.observations = landmark.observations;
  evidence.first_stamp_s = landmark.first_stamp_s;
  evidence.last_stamp_s = landmark.last_stamp_s;
  return evidence;
}

}  // namespace

RangeBearingSession::RangeBearingSession(const RangeBearingOptions& options,
                                         const FilterOptions& filter, const MotionOptions& motion,
                                         std::optional<Resumption> from)
    : options_(options),
      filter_options_(filter),
      from_(std::move(from)),
      estimator_(from_ && !from_->anywhere ? RangeBearingEstimator(options, filter, *from_)
                                           : RangeBearingEstimator(options, filter)),
      motion_(motion, std::make_shared<CameraTracker>(motion)) {
  if (from_ && from_->anywhere) search_.emplace(*from_);
}

void RangeBearingSession::run(FrameSource& source, const Observer& observer) {
  smoothed_.reset();
  Stopwatch watch;
  while (const auto frame = source.next()) {
    StepReport report;
    report.times_ms.read = watch.lap();
    report.motion = motion_.increment(*frame);
    report.times_ms.motion = watch.lap();
    const Taken taken{frame->stamp_s, report.motion,
                      frame->range_bearing.value_or(RangeBearingScan{})};
    for (const RangeBearing& reading : taken.scan.readings) identities_.push_back(reading.id);
    const RangeBearingReport seen = take(taken);
    report.events = seen.events;
    if (search_) lookForPlace(taken, seen, frame->index, report.events);
    report.times_ms.filter = watch.lap();
    if (!observer(*frame, report, *this)) return;
    watch.lap();  // what the observer does is no stage of the session
  }
  if (options_.smooth)
    smoothed_ = smoothedDrive(record_, so_far_, estimator_, options_, filter_options_,
                              search_ ? std::nullopt : from_);
}

RangeBearingReport RangeBearingSession::take(const Taken& frame) {
  RangeBearingReport report = estimator_.step(frame.stamp_s, frame.motion, frame.scan);
  if (options_.smooth) record_.add(frame.stamp_s, frame.scan, report);
  so_far_.follow(estimator_, report.motion_covariance);
  if (!from_) so_far_.catchUp(record_, estimator_, options_);
  trajectory_.push_back({frame.stamp_s, now().T_world_robot.toIsometry3()});
  return report;
}

void RangeBearingSession::lookForPlace(const Taken& frame, const RangeBearingReport& taken,
                                       std::size_t index, std::vector<Event>& events) {
  since_.push_back(frame);
  // A motion the filter did not take is none the second time, either (wait_for_landmark).
  if (taken.motion_covariance == Eigen::Matrix3d::Zero()) since_.back().motion = {};
  way_m_ += frame.motion.T_previous_robot.translation().norm();
  const auto& blocks = estimator_.filter().state().blocks;
  const auto landmarks = std::count_if(blocks.begin(), blocks.end(),
                                       [](const Block& block) { return block.isLandmark(); });
  if (!search_->isDue(static_cast<std::size_t>(landmarks), way_m_)) return;
  const State own = estimator_.filter().fullState();
  const auto here = placeMarks(
      own,
      [&](const Block& block) {
        return estimator_.identityOf(block.id) ||
               block.evidence.observations >= options_.probation_sightings;
      },
      [&](LandmarkId id) { return estimator_.identityOf(id); }, [](LandmarkId) { return nullptr; });
  auto from = search_->look(here, own);
  if (!from) return;
  from_ = std::move(from);
  events.push_back(search_->found(frame.stamp_s, index));
  search_.reset();
  estimator_ = RangeBearingEstimator(options_, filter_options_, *from_);
  record_ = {};
  so_far_ = {};
  trajectory_.clear();
  for (const Taken& again : std::exchange(since_, {})) {
    const RangeBearingReport report = take(again);
    events.insert(events.end(), report.events.begin(), report.events.end());
  }
}

LandmarkMap RangeBearingSession::map() const {
  LandmarkMap map = smoothed_ ? smoothed_->map : moved(estimator_.map(), now().T_world_filter);
  LandmarkMap named = map;
  for (LandmarkRecord& landmark : named) {
    const auto identity = identityOf(landmark.id);
    if (!identity) return map;
    landmark.id = LandmarkId{*identity};
  }
  std::sort(named.begin(), named.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return named;
}

std::optional<int> RangeBearingSession::identityOf(LandmarkId landmark) const {
  if (!smoothed_) return estimator_.identityOf(landmark);
  const auto identity = smoothed_->identities.find(landmark);
  return identity == smoothed_->identities.end() ? std::nullopt : std::optional(identity->second);
}

SavedMap RangeBearingSession::savedMap() const {
  if (smoothed_ && smoothed_->covariance.size() > 0) return smoothedMap();
  SavedMap map = estimator_.savedMap();
  const Pose2 T = smoothed_ ? smoothed_->T_world_filter : now().T_world_filter;
  moveWorld(map.state, T);
  map.T_world_start = T * map.T_world_start;
  if (!smoothed_) return map;
  for (const auto& [landmark, into] : smoothed_->merged) removeBlock(map.state, landmark);
  for (const LandmarkRecord& landmark : smoothed_->map)
    map.state.find(landmark.id)->evidence = evidenceOf(landmark);
  return map;
}

SavedMap RangeBearingSession::smoothedMap() const {
  SavedMap map;
  map.source = SavedMap::Source::kReadings;
  map.T_world_start = from_ && !search_ ? from_->map.T_world_start
                                        : planarPart(smoothed_->trajectory.front().T_world_body);
  const Eigen::Index size = smoothed_->covariance.rows();
  map.state.x.setZero(3 + size);
  map.state.P.setZero(3 + size, 3 + size);
  map.state.P.bottomRightCorner(size, size) = smoothed_->covariance;
  int offset = 3;
  for (const LandmarkRecord& landmark : smoothed_->map) {
    map.state.blocks.push_back(
        {landmark.id, BlockKind::kPoint, landmark.kind, offset, evidenceOf(landmark)});
    map.state.x.segment<2>(offset) = landmark.p_world;
    offset += 2;
    if (const auto identity = identityOf(landmark.id)) map.identities[landmark.id] = *identity;
  }
  return map;
}

std::vector<std::string> RangeBearingSession::notes() const {
  std::vector<std::string> notes;
  if (smoothed_ && smoothed_->suspected)
    if (auto note = sensorNote(*smoothed_->suspected, from_ && !search_); !note.empty())
      notes.push_back(std::move(note));
  if (!from_ || search_) return notes;
  const auto decisions = estimator_.decisions();
  const auto known = std::count_if(decisions.begin(), decisions.end(),
                                   [](const auto& landmark) { return landmark.has_value(); });
  const auto readings = static_cast<std::ptrdiff_t>(decisions.size());
  if (2 * known < readings)
    notes.push_back(std::to_string(readings - known) + " of " + std::to_string(readings) +
                    " readings are of no landmark of the map: is the start right? Give --start "
                    "x,y,heading or --start anywhere");
  if (options_.smooth && !smoothed_)
    notes.emplace_back(
        "not smoothed: too few readings fit, or the map is too large or too unsure to count");
  return notes;
}

IdentityScore RangeBearingSession::identityScore() const {
  return scoreIdentities(smoothed_ ? smoothed_->decisions : estimator_.decisions(), identities_);
}

}  // namespace colonnade
