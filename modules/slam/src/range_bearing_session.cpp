// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/range_bearing_session.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "stopwatch.hpp"

namespace colonnade {

RangeBearingSession::RangeBearingSession(const RangeBearingOptions& options,
                                         const FilterOptions& filter, const MotionOptions& motion,
                                         std::optional<Resumption> from)
    : options_(options),
      from_(std::move(from)),
      estimator_(from_ ? RangeBearingEstimator(options, filter, *from_)
                       : RangeBearingEstimator(options, filter)),
      motion_(motion, std::make_shared<CameraTracker>(motion)) {}

void RangeBearingSession::run(FrameSource& source, const Observer& observer) {
  smoothed_.reset();
  Stopwatch watch;
  while (const auto frame = source.next()) {
    StepReport report;
    report.times_ms.read = watch.lap();
    report.motion = motion_.increment(*frame);
    report.times_ms.motion = watch.lap();
    const RangeBearingScan scan = frame->range_bearing.value_or(RangeBearingScan{});
    for (const RangeBearing& reading : scan.readings) identities_.push_back(reading.id);
    const RangeBearingReport seen = estimator_.step(frame->stamp_s, report.motion, scan);
    report.events = seen.events;
    if (options_.smooth) record_.add(frame->stamp_s, scan, seen, estimator_.pose());
    report.times_ms.filter = watch.lap();
    if (!observer(*frame, report, *this)) return;
    watch.lap();  // what the observer does is no stage of the session
  }
  if (options_.smooth) smoothed_ = record_.smoothed(estimator_, options_, from_);
}

LandmarkMap RangeBearingSession::map() const {
  LandmarkMap map = smoothed_ ? smoothed_->map : estimator_.map();
  LandmarkMap named = map;
  for (LandmarkRecord& landmark : named) {
    const auto identity = estimator_.identityOf(landmark.id);
    if (!identity) return map;
    landmark.id = LandmarkId{*identity};
  }
  std::sort(named.begin(), named.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return named;
}

SavedMap RangeBearingSession::savedMap() const {
  SavedMap map = estimator_.savedMap();
  if (!smoothed_ || smoothed_->covariance.size() == 0) return map;
  State state;
  for (const LandmarkRecord& landmark : smoothed_->map) {
    const Block* block = map.state.find(landmark.id);
    state.blocks.push_back({landmark.id, BlockKind::kPoint, landmark.kind,
                            static_cast<int>(3 + 2 * state.blocks.size()), block->evidence});
  }
  const Eigen::Index size = smoothed_->covariance.rows();
  state.x.setZero(3 + size);
  state.P.setZero(3 + size, 3 + size);
  state.P.bottomRightCorner(size, size) = smoothed_->covariance;
  for (Eigen::Index i = 0; i < size; i += 2)
    state.x.segment<2>(3 + i) = smoothed_->map[static_cast<std::size_t>(i / 2)].p_world;
  std::erase_if(map.identities, [&](const auto& named) { return !state.find(named.first); });
  map.state = std::move(state);
  return map;
}

IdentityScore RangeBearingSession::identityScore() const {
  return scoreIdentities(estimator_.decisions(), identities_);
}

}  // namespace colonnade
