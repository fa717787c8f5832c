// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/range_bearing_session.hpp"

#include <algorithm>
#include <memory>

#include "stopwatch.hpp"

namespace colonnade {

RangeBearingSession::RangeBearingSession(const RangeBearingOptions& options,
                                         const FilterOptions& filter, const MotionOptions& motion)
    : options_(options),
      estimator_(options, filter),
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
  if (options_.smooth) smoothed_ = record_.smoothed(estimator_, options_);
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

IdentityScore RangeBearingSession::identityScore() const {
  return scoreIdentities(estimator_.decisions(), identities_);
}

}  // namespace colonnade
