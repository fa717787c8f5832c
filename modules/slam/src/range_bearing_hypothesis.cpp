// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "range_bearing_hypothesis.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

constexpr int kFewestStrikes = 5;
/// A robot that every landmark disagrees with is somewhere else: its pose gets this uncertain. With
/// three outliers in ten readings six refusals in a row come by chance once in a thousand readings,
/// twelve once in a million.
constexpr int kLostAfterRefusals = 12;
constexpr double kLostSigma_m = 0.5;
constexpr double kLostSigma = radians(30.0);

FilterOptions withGate(FilterOptions filter, const RangeBearingOptions& options) {
  filter.gate_probability = std::max(options.gate_probability, options.known_gate_probability);
  return filter;
}

Event event(const ReadingFrame& frame, const char* what, LandmarkId landmark, std::string reason) {
  return {frame.stamp_s, frame.index, what, landmark, std::move(reason)};
}

std::string described(int identity) {
  return identity < 0 ? "identity not known" : "identity " + std::to_string(identity);
}

}  // namespace

Eigen::Matrix3d lostCovariance() {
  return Eigen::Vector3d(kLostSigma_m, kLostSigma_m, kLostSigma).cwiseAbs2().asDiagonal();
}

RangeBearingHypothesis::RangeBearingHypothesis(const RangeBearingOptions& options,
                                               const FilterOptions& filter_options)
    : filter(withGate(filter_options, options)), options_(&options) {
  if (options.estimate_sensor) filter.addSensor(options.sensor_sigmas);
}

RangeBearingHypothesis::RangeBearingHypothesis(const RangeBearingOptions& options,
                                               const FilterOptions& filter_options,
                                               const Resumption& from)
    : filter(withGate(filter_options, options), from.map.state),
      options_(&options),
      grows_(!from.localize),
      T_filter_start_(from.map.T_world_start),
      identity_of_landmark_(from.map.identities) {
  for (const auto& [landmark, identity] : from.map.identities)
    landmark_of_identity_.emplace(identity, landmark);
  filter.placeRobot(from.T_world_robot, from.covariance);
  if (from.localize) filter.fixMap();
  if (options.estimate_sensor) filter.addSensor(options.sensor_sigmas);
}

std::optional<LandmarkId> RangeBearingHypothesis::landmarkOf(int identity) const {
  const auto found = landmark_of_identity_.find(identity);
  if (identity < 0 || found == landmark_of_identity_.end()) return std::nullopt;
  return found->second;
}

std::optional<int> RangeBearingHypothesis::identityOf(LandmarkId landmark) const {
  const auto found = identity_of_landmark_.find(landmark);
  return found == identity_of_landmark_.end() ? std::nullopt : std::optional(found->second);
}

void RangeBearingHypothesis::focus(const ReadingFrame& frame) {
  std::vector<LandmarkId> needed;
  std::vector<Measurement> open;
  for (const LandmarkReading& reading : frame.readings) {
    if (const auto bearer = landmarkOf(reading.identity))
      needed.push_back(*bearer);
    else
      open.push_back(reading.measurement);
  }
  filter.focus(needed, open);
}

std::vector<LandmarkId> RangeBearingHypothesis::allowed(int identity) const {
  const auto bearer = landmarkOf(identity);
  std::vector<LandmarkId> landmarks;
  for (const Block& block : filter.state().blocks) {
    if (!block.isLandmark() || std::find(used.begin(), used.end(), block.id) != used.end())
      continue;
    if (bearer ? block.id == *bearer : identity < 0 || !identityOf(block.id))
      landmarks.push_back(block.id);
  }
  return landmarks;
}

std::optional<LandmarkId> RangeBearingHypothesis::found(const LandmarkReading& reading,
                                                        const ReadingFrame& frame,
                                                        std::vector<Event>& events) {
  const auto id = filter.addLandmark(reading.measurement);
  if (!id) return std::nullopt;
  observe(*id, reading, frame);
  events.push_back(event(frame, "birth", *id, described(reading.identity)));
  return id;
}

std::vector<bool> RangeBearingHypothesis::update(std::span<const Match> matches,
                                                 double noise_scale) {
  const State& state = filter.state();
  std::vector<PointPair> anchors;
  std::vector<int> offsets;
  for (const Block& block : state.blocks) {
    if (!options_->world_with_map || !grows_ || block.block_kind != BlockKind::kPoint) continue;
    const Eigen::Vector2d p = state.values(block);
    anchors.push_back({p, p, static_cast<double>(block.evidence.observations)});
    offsets.push_back(block.offset);
  }
  auto used = filter.update(matches, noise_scale);
  for (std::size_t i = 0; i < anchors.size(); ++i) anchors[i].p_b = state.x.segment<2>(offsets[i]);
  if (const auto back = motionOfMap(anchors)) T_world_start = T_world_start * *back;
  return used;
}

void RangeBearingHypothesis::observe(LandmarkId landmark, const LandmarkReading& reading,
                                     const ReadingFrame& frame) {
  Evidence& evidence = filter.evidence(landmark);
  if (evidence.observations == 0) {
    evidence.first_stamp_s = frame.stamp_s;
    on_probation_.push_back(landmark);
  }
  evidence.last_stamp_s = frame.stamp_s;
  ++evidence.observations;
  used.push_back(landmark);
  strikes_.erase(landmark);
  refused_in_a_row_.clear();
  if (grows_ && reading.identity >= 0 &&
      landmark_of_identity_.emplace(reading.identity, landmark).second)
    identity_of_landmark_.emplace(landmark, reading.identity);
}

bool RangeBearingHypothesis::strike(LandmarkId landmark, const ReadingFrame& frame,
                                    std::vector<Event>& events) {
  refused_in_a_row_.push_back(landmark);
  const bool several = std::any_of(refused_in_a_row_.begin(), refused_in_a_row_.end(),
                                   [&](const LandmarkId id) { return id != landmark; });
  if (several && refused_in_a_row_.size() >= kLostAfterRefusals) {
    refused_in_a_row_.clear();
    filter.wakeAll();
    filter.predict({}, lostCovariance());
    events.push_back({frame.stamp_s, frame.index, "lost", std::nullopt,
                      "all readings in a row refused: the pose is in doubt"});
    return true;
  }
  if (!grows_) return false;
  const int strikes = ++strikes_[landmark];
  if (strikes < kFewestStrikes || strikes <= filter.evidence(landmark).observations) return false;
  events.push_back(event(frame, "purged", landmark, "refused more often than seen"));
  forget(landmark);
  return false;
}

void RangeBearingHypothesis::forget(LandmarkId landmark) {
  filter.remove(landmark);
  strikes_.erase(landmark);
  if (const auto identity = identityOf(landmark)) landmark_of_identity_.erase(*identity);
  identity_of_landmark_.erase(landmark);
}

void RangeBearingHypothesis::release(LandmarkId clone) {
  const bool needed = std::any_of(first_bearings_.begin(), first_bearings_.end(),
                                  [&](const auto& e) { return e.second.clone == clone; });
  if (needed) return;
  filter.remove(clone);
  if (clone_of_frame_ == clone) clone_of_frame_.reset();
}

std::optional<LandmarkId> RangeBearingHypothesis::triangulate(const LandmarkReading& reading,
                                                              const ReadingFrame& frame,
                                                              std::vector<Event>& events) {
  if (!options_->wait_for_parallax) {
    const LandmarkId clone = filter.addPoseClone();
    const auto id = filter.addLandmarkOnRay(clone, reading.measurement, options_->inverse_depth,
                                            options_->inverse_depth_sigma);
    filter.remove(clone);
    if (id) {
      observe(*id, reading, frame);
      events.push_back(event(frame, "birth", *id, described(reading.identity) + " on its ray"));
    }
    return id;
  }
  const auto first = first_bearings_.find(reading.identity);
  if (first == first_bearings_.end()) {
    if (!clone_of_frame_) clone_of_frame_ = filter.addPoseClone();
    first_bearings_[reading.identity] = {*clone_of_frame_, reading.measurement};
    return std::nullopt;
  }
  const FirstBearing view = first->second;
  const auto seen = filter.parallax(view.clone, view.measurement, reading.measurement);
  if (!seen || seen->baseline_m < options_->min_baseline_m ||
      std::abs(seen->angle) < options_->min_parallax)
    return std::nullopt;
  std::optional<LandmarkId> id;
  // Rays that do not meet in front of both views were not of one landmark: start again.
  if (seen->inverse_depth > 2.0 * seen->inverse_depth_sigma)
    id = filter.addLandmark(view.clone, view.measurement, reading.measurement);
  first_bearings_.erase(first);
  release(view.clone);
  if (id) {
    observe(*id, reading, frame);
    events.push_back(event(frame, "birth", *id, described(reading.identity) + " by parallax"));
  }
  return id;
}

void RangeBearingHypothesis::endFrame(const ReadingFrame& frame, std::vector<Event>& events) {
  used.clear();
  clone_of_frame_.reset();
  for (const LandmarkId id : filter.settleInverseDepths())
    events.push_back(event(frame, "settled", id, "inverse depth to x, y"));
  std::erase_if(on_probation_, [&](const LandmarkId id) {
    return !filter.knows(id) || identityOf(id) ||
           filter.evidence(id).observations >= options_->probation_sightings;
  });
  const auto isStale = [&](const LandmarkId id) {
    return frame.stamp_s - filter.evidence(id).last_stamp_s > options_->probation_s;
  };
  for (const LandmarkId id : on_probation_) {
    if (!isStale(id)) continue;
    events.push_back(event(frame, "purged", id, "too few sightings"));
    forget(id);
  }
}

SavedMap RangeBearingHypothesis::savedMap() const {
  SavedMap map;
  map.source = SavedMap::Source::kReadings;
  map.T_world_start = T_world_start * T_filter_start_;
  map.identities = identity_of_landmark_;
  EkfSlam all(filter.options(), filter.fullState());
  std::vector<LandmarkId> clones;
  for (const Block& block : all.state().blocks)
    if (!block.isLandmark()) clones.push_back(block.id);
  for (const LandmarkId id : clones) all.remove(id);
  all.placeRobot({}, Eigen::Matrix3d::Zero());
  map.state = all.state();
  moveWorld(map.state, T_world_start);
  map.state.x.head<3>().setZero();
  return map;
}

}  // namespace colonnade
