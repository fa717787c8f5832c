// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "backwards.hpp"
#include "colonnade/slam/smoothed_drive.hpp"

namespace colonnade {
namespace {

/// Readings times landmarks squared: what an estimator takes grows with that. Some seconds.
constexpr double kMostWork = 2e7;
/// What is less of a surprise by about two landmarks is the better explanation.
constexpr double kClearly = 50.0;

bool hasHidden(const DriveRecord& record, const RangeBearingOptions& options) {
  return std::any_of(record.readings.begin(), record.readings.end(), [&](const auto& reading) {
    return reading.measurement && !(options.use_ids && reading.identity >= 0);
  });
}

bool isAffordable(const DriveRecord& record, const LandmarkMap& map) {
  const auto landmarks = static_cast<double>(map.size());
  return static_cast<double>(record.readings.size()) * landmarks * landmarks <= kMostWork;
}

}  // namespace

std::optional<SmoothedDrive> smoothedDrive(const DriveRecord& record, DriveSoFar& so_far,
                                           const RangeBearingEstimator& estimator,
                                           const RangeBearingOptions& options,
                                           const FilterOptions& filter_options,
                                           const std::optional<Resumption>& from) {
  if (record.stamps_s.empty()) return std::nullopt;
  const Explanation forwards = explanationOf(record, so_far, estimator, from.has_value());
  auto smoothed = smoothedDrive(record, forwards, so_far, options, from);
  if (!smoothed || from || !options.look_back || !hasHidden(record, options) ||
      !isAffordable(record, forwards.map))
    return smoothed;
  const Explanation backwards = explainedBackwards(record, forwards, options, filter_options);
  auto other = smoothedDrive(record, backwards, so_far, options);
  if (!other || !(other->surprise < smoothed->surprise - kClearly)) return smoothed;
  other->explained_backwards = true;
  return other;
}

}  // namespace colonnade
