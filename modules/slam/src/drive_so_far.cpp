// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/drive_so_far.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "colonnade/base/rigid_fit.hpp"

namespace colonnade {
namespace {

/// How much larger variances are than the filter says between two times, at most.
constexpr double kDoubt = 4.0;
/// Poses agree where the robot and a point so far ahead of it do.
constexpr double kAhead_m = 1.0;
/// So many poses said say well enough where the world is.
constexpr std::size_t kWitnesses = 500;
/// Where smoothing failed it is begun anew once the drive is longer by this part of it.
constexpr std::size_t kPatience = 10;
/// What was taken back may be so much more than what counts before all is begun anew.
constexpr std::size_t kTakenBack = 2000;

/// In axes turned by T.
Eigen::Matrix3d turned(const Eigen::Matrix3d& covariance, const Pose2& T) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = T.rotation();
  return R * covariance * R.transpose();
}

}  // namespace

void DriveSoFar::followFilter(const RangeBearingEstimator& estimator) {
  const Pose2 T = now_.T_world_filter;
  now_ = {T * estimator.pose(), turned(estimator.poseCovariance(), T), T * estimator.worldOrigin(),
          T};
}

void DriveSoFar::follow(const RangeBearingEstimator& estimator,
                        const Eigen::Matrix3d& motion_covariance) {
  const bool first = !begun_;
  begun_ = true;
  const Pose2 T_filter_robot = estimator.pose();
  if (!first) said_.push_back(now_.T_world_robot);
  if (!is_smoothed_) {
    followFilter(estimator);
  } else {
    Eigen::Matrix3d J_before, J_motion;
    now_.T_world_robot = compose(now_.T_world_robot, T_filter_robot_.inverse() * T_filter_robot,
                                 &J_before, &J_motion);
    now_.T_world_filter = now_.T_world_robot * T_filter_robot.inverse();
    // By wheels alone less and less is known; what was read since says more, but errors that are
    // alike from frame to frame make the filter sure of it.
    const Eigen::Matrix3d by_wheels = J_before * now_.covariance * J_before.transpose() +
                                      J_motion * motion_covariance * J_motion.transpose();
    const Eigen::Matrix3d by_filter =
        kDoubt * share_ * turned(estimator.poseCovariance(), now_.T_world_filter);
    now_.covariance = by_filter.determinant() < by_wheels.determinant() ? by_filter : by_wheels;
  }
  T_filter_robot_ = T_filter_robot;
  if (first) T_origin_first_ = now_.T_world_origin.inverse() * T_filter_robot;
}

void DriveSoFar::catchUp(const DriveRecord& record, const RangeBearingEstimator& estimator,
                         const RangeBearingOptions& options) {
  if (!options.smooth || options.smooth_every == 0) return;
  const std::size_t frames = record.stamps_s.size();
  const auto every = static_cast<std::size_t>(options.smooth_every);
  if (frames < std::max({next_frames_, every, std::size_t{2}})) return;
  next_frames_ = frames + every;
  followHistory(estimator.decisions());
  if (smoother_ && released_ > sighted_.size() + kTakenBack) stop();
  if (!smoother_ && std::none_of(decided_.begin(), decided_.end(),
                                 [](const auto& landmark) { return landmark.has_value(); }))
    return;
  if (!smoother_) start(options);
  addFrames(record);
  addReadings(record, estimator, options);
  const auto sighted = static_cast<std::size_t>(
      std::count_if(sighted_.begin(), sighted_.end(), [](const auto& s) { return s.has_value(); }));
  is_smoothed_ = sighted > 0 && smoother_->update() && 2 * smoother_->unused() < sighted;
  if (is_smoothed_) return takeResult(estimator, options);
  stop();
  followFilter(estimator);
  next_frames_ = std::max(next_frames_, frames + frames / kPatience);
}

void DriveSoFar::start(const RangeBearingOptions& options) {
  std::optional<Drive::Sensor> sensor;
  if (options.estimate_sensor) sensor = Drive::Sensor{{}, options.sensor_sigmas};
  smoother_.emplace(options.known_gate_probability, sensor);
}

void DriveSoFar::stop() {
  smoother_.reset();
  points_.clear();
  sighted_.clear();
  open_.clear();
  released_ = 0;
}

void DriveSoFar::release(std::size_t reading) {
  smoother_->removeSighting(sighted_[reading]->sighting);
  sighted_[reading].reset();
  open_.push_back(reading);
  ++released_;
}

void DriveSoFar::followHistory(const std::vector<std::optional<LandmarkId>>& decisions) {
  const auto same = static_cast<std::size_t>(
      std::mismatch(decided_.begin(), decided_.end(), decisions.begin()).first - decided_.begin());
  decided_ = decisions;
  if (!smoother_) return;
  for (std::size_t i = same; i < sighted_.size(); ++i)
    if (sighted_[i]) release(i);
  forget([&](LandmarkId, const Founded& point) { return point.reading >= same; });
}

void DriveSoFar::addFrames(const DriveRecord& record) {
  const Pose2 T_drive_world = T_world_drive_.inverse();
  for (std::size_t k = smoother_->poses(); k < record.motions.size(); ++k)
    smoother_->addPose(T_drive_world * (k < said_.size() ? said_[k] : now_.T_world_robot),
                       record.motions[k]);
}

bool DriveSoFar::foundPoint(LandmarkId landmark, std::size_t reading, const DriveRecord& record,
                            const RangeBearingEstimator& estimator,
                            const RangeBearingOptions& options) {
  const auto place = estimator.placeOf(landmark);
  if (!place) return false;
  const Pose2 T_drive_filter = T_world_drive_.inverse() * now_.T_world_filter;
  const std::size_t point = smoother_->addPoint(transform(T_drive_filter, *place));
  points_[landmark] = {point, reading};
  const auto& [frame, identity, measurement] = record.readings[reading];
  if (options.bearing_only && !options.wait_for_parallax)
    smoother_->addDepth({frame, point, measurement->p_robot_camera, options.inverse_depth,
                         options.inverse_depth_sigma});
  return true;
}

/// Readings of believed identities are of their bearer, the others of what they were taken for.
void DriveSoFar::addReadings(const DriveRecord& record, const RangeBearingEstimator& estimator,
                             const RangeBearingOptions& options) {
  forget([&](LandmarkId landmark, const Founded&) { return !estimator.filter().knows(landmark); });
  for (std::size_t i = sighted_.size(); i < record.readings.size(); ++i)
    if (record.readings[i].measurement) open_.push_back(i);
  sighted_.resize(record.readings.size());
  std::sort(open_.begin(), open_.end());
  for (const std::size_t i : open_)
    if (decided_[i] && !points_.contains(*decided_[i]))
      foundPoint(*decided_[i], i, record, estimator, options);
  std::map<int, LandmarkId> bearers;
  for (const auto& [landmark, point] : points_)
    if (const auto identity = estimator.identityOf(landmark)) bearers[*identity] = landmark;
  for (const std::size_t i : open_) {
    const auto& [frame, identity, measurement] = record.readings[i];
    std::optional<LandmarkId> landmark = decided_[i];
    const auto bearer = bearers.find(identity);
    if (options.use_ids && identity >= 0 && bearer != bearers.end()) landmark = bearer->second;
    const auto point = landmark ? points_.find(*landmark) : points_.end();
    if (point == points_.end()) continue;
    sighted_[i] = Sighted{
        smoother_->addSighting({frame, point->second.point, *measurement, decided_[i].has_value()}),
        point->second.point};
  }
  std::erase_if(open_, [&](std::size_t i) { return sighted_[i].has_value(); });
}

void DriveSoFar::forget(const std::function<bool(LandmarkId, const Founded&)>& which) {
  std::set<std::size_t> gone;
  for (const auto& [landmark, founded] : points_)
    if (which(landmark, founded)) gone.insert(founded.point);
  if (gone.empty()) return;
  for (std::size_t i = 0; i < sighted_.size(); ++i)
    if (sighted_[i] && gone.contains(sighted_[i]->point)) release(i);
  std::erase_if(points_, [&](const auto& point) { return gone.contains(point.second.point); });
}

void DriveSoFar::takeResult(const RangeBearingEstimator& estimator,
                            const RangeBearingOptions& options) {
  const Pose2 T_drive_first = smoother_->pose(0);
  T_world_drive_ = options.world_with_map
                       ? asSaid([&](std::size_t k) { return smoother_->pose(k); })
                       : said_.front() * T_drive_first.inverse();
  const Eigen::Matrix3d covariance = smoother_->lastPoseCovariance();
  now_.T_world_robot = T_world_drive_ * smoother_->pose(smoother_->poses() - 1);
  now_.covariance = turned(covariance, T_world_drive_);
  now_.T_world_filter = now_.T_world_robot * T_filter_robot_.inverse();
  now_.T_world_origin = T_world_drive_ * T_drive_first * T_origin_first_.inverse();
  // With bearings alone the filter does not know how sure it is.
  const double share =
      std::cbrt(covariance.determinant() / estimator.poseCovariance().determinant());
  share_ = options.bearing_only || !std::isfinite(share) ? HUGE_VAL : share;
}

std::vector<Pose2> DriveSoFar::poses() {
  std::vector<Pose2> poses = said_;
  poses.push_back(now_.T_world_robot);
  if (!smoother_) return poses;
  const auto& smoothed = smoother_->drive().T_world_robot;
  for (std::size_t k = 0; k < smoothed.size(); ++k) poses[k] = T_world_drive_ * smoothed[k];
  return poses;
}

std::map<LandmarkId, Eigen::Vector2d> DriveSoFar::places() {
  std::map<LandmarkId, Eigen::Vector2d> places;
  if (!smoother_) return places;
  const auto& points_world = smoother_->drive().points_world;
  std::vector<bool> has_readings(points_world.size(), false);
  for (std::size_t i = 0; i < sighted_.size(); ++i)
    if (isUsed(i).value_or(false)) has_readings[sighted_[i]->point] = true;
  for (const auto& [landmark, founded] : points_)
    if (has_readings[founded.point])
      places[landmark] = transform(T_world_drive_, points_world[founded.point]);
  return places;
}

std::optional<bool> DriveSoFar::isUsed(std::size_t reading) const {
  if (reading >= sighted_.size() || !sighted_[reading]) return std::nullopt;
  return smoother_->isUsed(sighted_[reading]->sighting);
}

std::optional<SensorErrors> DriveSoFar::sensorErrors() {
  if (!smoother_ || !smoother_->drive().sensor) return std::nullopt;
  return smoother_->drive().sensor->errors;
}

Pose2 DriveSoFar::asSaid(const std::function<Pose2(std::size_t)>& T_drive_robot) const {
  if (said_.empty()) return {};
  std::vector<PointPair> pairs;
  const Eigen::Vector2d ahead(kAhead_m, 0.0);
  const std::size_t stride = 1 + said_.size() / kWitnesses;
  for (std::size_t k = (said_.size() - 1) % stride; k < said_.size(); k += stride) {
    const Pose2 known = T_drive_robot(k);
    pairs.push_back({said_[k].translation(), known.translation()});
    pairs.push_back({transform(said_[k], ahead), transform(known, ahead)});
  }
  return rigidFit(pairs);
}

}  // namespace colonnade
