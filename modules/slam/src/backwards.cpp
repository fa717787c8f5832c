// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "backwards.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "colonnade/slam/identity_score.hpp"

namespace colonnade {
namespace {

/// The places of what stands in a list frame by frame, where the frames follow each other the other
/// way round.
std::vector<std::size_t> placesInReverse(const std::vector<RangeBearingScan>& scans) {
  std::vector<std::size_t> places;
  std::size_t end = 0;
  for (const RangeBearingScan& scan : scans) end += scan.readings.size();
  for (std::size_t k = scans.size(); k-- > 0;) {
    const std::size_t size = scans[k].readings.size();
    end -= size;
    for (std::size_t i = 0; i < size; ++i) places.push_back(end + i);
  }
  return places;
}

/// Puts each entry where it belongs.
template <typename T>
void rearrange(std::vector<T>& entries, const std::vector<std::size_t>& places) {
  std::vector<T> arranged(entries.size());
  for (std::size_t i = 0; i < places.size(); ++i) arranged[places[i]] = entries[i];
  entries = std::move(arranged);
}

/// One to one.
std::map<LandmarkId, LandmarkId> namesLike(const Explanation& forwards,
                                           const Explanation& backwards) {
  std::vector<std::pair<int, LandmarkId>> shared;
  std::int32_t last = -1;
  for (const LandmarkRecord& landmark : forwards.map) last = std::max(last, number(landmark.id));
  for (std::size_t i = 0; i < backwards.decisions.size(); ++i) {
    const auto &here = backwards.decisions[i], &there = forwards.decisions[i];
    if (there) last = std::max(last, number(*there));
    if (here && there) shared.emplace_back(number(*here), *there);
  }
  const auto bearers = bearersOf(shared);
  std::map<LandmarkId, LandmarkId> names;
  for (const LandmarkRecord& landmark : backwards.map) {
    const auto bearer = bearers.find(number(landmark.id));
    names[landmark.id] = bearer != bearers.end() ? bearer->second : LandmarkId{++last};
  }
  return names;
}

void rename(Explanation& explanation, const std::map<LandmarkId, LandmarkId>& names) {
  for (auto& landmark : explanation.decisions) {
    const auto name = landmark ? names.find(*landmark) : names.end();
    landmark = name == names.end() ? std::nullopt : std::optional(name->second);
  }
  std::map<LandmarkId, int> identities;
  for (const auto& [landmark, identity] : explanation.identities)
    identities.emplace(names.at(landmark), identity);
  explanation.identities = std::move(identities);
  for (LandmarkRecord& landmark : explanation.map) landmark.id = names.at(landmark.id);
  std::sort(explanation.map.begin(), explanation.map.end(),
            [](const auto& a, const auto& b) { return a.id < b.id; });
}

}  // namespace

/// There and back is no motion, whatever the errors: that gives the derivative of the way back.
MotionIncrement reversed(const Drive::Motion& motion) {
  MotionIncrement back;
  back.T_previous_robot = motion.T_previous_robot.inverse();
  Eigen::Matrix3d J_there, J_back;
  compose(motion.T_previous_robot, back.T_previous_robot, &J_there, &J_back);
  const Eigen::Matrix3d J = -J_back.inverse() * J_there;
  back.covariance = J * motion.covariance * J.transpose();
  back.source = MotionSource::kOdometry;
  return back;
}

Explanation explainedBackwards(const DriveRecord& record, const Explanation& forwards,
                               const RangeBearingOptions& as_told,
                               const FilterOptions& filter_options) {
  RangeBearingOptions options = as_told;
  if (options.smooth_every == 0) options.smooth_every = RangeBearingOptions{}.smooth_every;
  RangeBearingEstimator estimator(options, filter_options);
  DriveRecord back;
  DriveSoFar so_far;
  for (std::size_t k = record.scans.size(); k-- > 0;) {
    const MotionIncrement motion =
        k + 1 < record.scans.size() ? reversed(record.motions[k + 1]) : MotionIncrement{};
    const double stamp_s = -record.stamps_s[k];
    const RangeBearingReport report = estimator.step(stamp_s, motion, record.scans[k]);
    back.add(stamp_s, record.scans[k], report);
    so_far.follow(estimator, report.motion_covariance);
    so_far.catchUp(back, estimator, options);
  }
  Explanation result = explanationOf(back, so_far, estimator, false);
  std::reverse(result.T_world_robot.begin(), result.T_world_robot.end());
  const std::vector<std::size_t> places = placesInReverse(record.scans);
  rearrange(result.decisions, places);
  rearrange(result.used, places);
  const Pose2 T = forwards.T_world_robot.front() * result.T_world_robot.front().inverse();
  for (Pose2& pose : result.T_world_robot) pose = T * pose;
  result.map = moved(std::move(result.map), T);
  for (LandmarkRecord& landmark : result.map) {
    landmark.first_stamp_s = -std::exchange(landmark.last_stamp_s, -landmark.first_stamp_s);
  }
  rename(result, namesLike(forwards, result));
  return result;
}

}  // namespace colonnade
