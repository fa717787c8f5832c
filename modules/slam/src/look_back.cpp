// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "backwards.hpp"
#include "colonnade/slam/smoothed_drive.hpp"

namespace colonnade {
namespace {

/// Five seconds for a quarter of an hour past 15 landmarks, one minute at most.
constexpr double kMostWork = 5e7;
/// Whatever the landmarks: the robot itself, and what a history takes besides.
constexpr double kLandmarksAtLeast = 15.0;
/// What is less of a surprise by about two landmarks is the better explanation.
constexpr double kClearly = 50.0;

bool hasHidden(const DriveRecord& record, const RangeBearingOptions& options) {
  return std::any_of(record.readings.begin(), record.readings.end(), [&](const auto& reading) {
    return reading.measurement && !(options.use_ids && reading.identity >= 0);
  });
}

/// Every history is moved in each frame and corrected by each reading, in the square of its state.
bool isAffordable(const DriveRecord& record, const LandmarkMap& map, int histories) {
  const auto steps = static_cast<double>(record.scans.size() + record.readings.size());
  const double size = kLandmarksAtLeast + static_cast<double>(map.size());
  const double share = static_cast<double>(histories) / RangeBearingOptions{}.hypotheses;
  return share * steps * size * size <= kMostWork;
}

}  // namespace

std::optional<SmoothedDrive> smoothedDrive(const DriveRecord& record, DriveSoFar& so_far,
                                           const RangeBearingEstimator& estimator,
                                           const RangeBearingOptions& options,
                                           const FilterOptions& filter_options,
                                           const std::optional<Resumption>& from) {
  const Explanation forwards = explanationOf(record, so_far, estimator, from.has_value());
  auto smoothed = smoothedDrive(record, forwards, so_far, options, from);
  if (!smoothed || from || !options.look_back || !hasHidden(record, options) ||
      !isAffordable(record, forwards.map, options.hypotheses))
    return smoothed;
  const Explanation backwards = explainedBackwards(record, forwards, options, filter_options);
  auto other = smoothedDrive(record, backwards, so_far, options);
  // Without covariances the map is the filter's, which knows the landmarks of the way there alone.
  if (!other || other->covariance.size() == 0 || !(other->surprise < smoothed->surprise - kClearly))
    return smoothed;
  other->explained_backwards = true;
  return other;
}

}  // namespace colonnade
