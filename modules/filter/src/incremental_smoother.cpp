// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/incremental_smoother.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>

#include "colonnade/filter/gate.hpp"
#include "normal_equations.hpp"

namespace colonnade {
namespace {

constexpr int kMostSteps = 10;
constexpr int kMostGatings = 3;
/// Poses before the new ones that are looked at in every step, and terms elsewhere at each update.
constexpr std::size_t kRecent = 30, kSwept = 1500;
/// Of BayesTree::work(): beyond it the steps of an update are for the recent poses alone.
constexpr double kAffordable = 4e6;
/// A step that moves anything farther is checked, m and rad, and halved so often while it does not
/// help.
constexpr double kLarge = 0.1;
constexpr int kHalvings = 8;

/// The pose that is held stays within this.
constexpr double kHeldSigma = 1e-4;  ///< m and rad
/// Poses to either side of one to be held whose sightings count for it.
constexpr std::size_t kAround = 10;
constexpr std::size_t kFirstHold = 40;  ///< poses

LinearFactor holdOf(int pose, const Eigen::Vector3d& where) {
  Eigen::MatrixXd J_r(3, 4);
  J_r << Eigen::Matrix3d::Identity(), -where;
  return {{pose}, J_r / kHeldSigma};
}

}  // namespace

IncrementalSmoother::IncrementalSmoother(double gate_probability,
                                         const std::optional<Drive::Sensor>& sensor)
    : gate_probability_(gate_probability) {
  drive_.sensor = sensor;
  if (!sensor) return;
  sensor_ = tree_.addVariable(SensorErrors::kSize);
  number_.push_back(0);
  is_point_.push_back(false);
  Eigen::MatrixXd J_r(SensorErrors::kSize, SensorErrors::kSize + 1);
  const SensorErrors::Vector root = sensor->sigmas.vector().cwiseMax(kKnownSigma).cwiseInverse();
  J_r << root.asDiagonal().toDenseMatrix(), Eigen::VectorXd::Zero(SensorErrors::kSize);
  drive_.sensor->errors = {};
  tree_.addFactor({{*sensor_}, J_r});
}

void IncrementalSmoother::addPose(const Pose2& T_world_robot, const Drive::Motion& motion) {
  drive_.T_world_robot.push_back(T_world_robot);
  drive_.motions.push_back(motion);
  pose_bases_.push_back(T_world_robot.vector());
  pose_moved_.push_back(Eigen::Vector3d::Zero());
  poses_.push_back(tree_.addVariable(3));
  number_.push_back(poses_.size() - 1);
  is_point_.push_back(false);
  terms_.emplace_back();
  motions_.push_back(-1);
  if (poses_.size() == 1)
    hold_ = tree_.addFactor(holdOf(poses_[0], Eigen::Vector3d::Zero()));
  else
    set(motions_.back(), motionFactor(poses_.size() - 1));
}

std::size_t IncrementalSmoother::addPoint(const Eigen::Vector2d& p_world) {
  drive_.points_world.push_back(p_world);
  point_bases_.push_back(p_world);
  points_.push_back(tree_.addVariable(2));
  number_.push_back(points_.size() - 1);
  is_point_.push_back(true);
  Eigen::MatrixXd J_r = Eigen::MatrixXd::Zero(2, 3);
  J_r.leftCols<2>().diagonal().setConstant(1.0 / kLooseSigma_m);
  tree_.addFactor({{points_.back()}, J_r});
  return points_.size() - 1;
}

std::size_t IncrementalSmoother::addSighting(const Drive::Sighting& sighting) {
  drive_.sightings.push_back(sighting);
  Drive::Sighting& here = drive_.sightings.back();
  here.used = here.used && std::isfinite(distance2(drive_, here));
  removed_.push_back(false);
  sightings_.push_back(-1);
  if (here.used) set(sightings_.back(), sightingFactor(sightings_.size() - 1));
  terms_[sighting.pose].sightings.push_back(sightings_.size() - 1);
  return sightings_.size() - 1;
}

void IncrementalSmoother::removeSighting(std::size_t sighting) {
  removed_[sighting] = true;
  drive_.sightings[sighting].used = false;
  if (sightings_[sighting] >= 0) tree_.setFactor(sightings_[sighting], {});
}

void IncrementalSmoother::addDepth(const Drive::Depth& depth) {
  drive_.depths.push_back(depth);
  depths_.push_back(-1);
  terms_[depth.pose].depths.push_back(depths_.size() - 1);
  set(depths_.back(), depthFactor(depths_.size() - 1));
}

bool IncrementalSmoother::relineariseAt(std::size_t pose) {
  bool any = pose > 0 && relinearise(motions_[pose], motionFactor(pose));
  for (const std::size_t i : terms_[pose].sightings)
    if (drive_.sightings[i].used) any |= relinearise(sightings_[i], sightingFactor(i));
  for (const std::size_t i : terms_[pose].depths) any |= relinearise(depths_[i], depthFactor(i));
  return any;
}

bool IncrementalSmoother::gateAt(std::size_t pose) {
  bool any = false;
  for (const std::size_t i : terms_[pose].sightings) {
    Drive::Sighting& sighting = drive_.sightings[i];
    if (removed_[i]) continue;
    const double distance = distance2(drive_, sighting);
    const bool within =
        std::isfinite(distance) &&
        distance <=
            chiSquareQuantile(gate_probability_, static_cast<int>(sighting.measurement.z.size()));
    if (within == sighting.used) continue;
    sighting.used = within;
    any = true;
    set(sightings_[i], within ? sightingFactor(i) : LinearFactor{});
  }
  return any;
}

std::vector<std::size_t> IncrementalSmoother::sweep() {
  std::vector<std::size_t> poses;
  const std::size_t recent = updated_ > kRecent ? updated_ - kRecent : 0;
  for (std::size_t terms = 0; poses.size() < recent && terms < kSwept; ++swept_) {
    if (swept_ >= recent) swept_ = 0;
    poses.push_back(swept_);
    terms += 1 + terms_[swept_].sightings.size();
  }
  for (std::size_t k = recent; k < poses_.size(); ++k) poses.push_back(k);
  recent_ = poses_.size() - recent;
  updated_ = poses_.size();
  return poses;
}

/// The sensor, the last pose and the points it and those before it saw.
std::vector<int> IncrementalSmoother::likelyNext() const {
  std::vector<int> last;
  std::set<int> seen;
  for (std::size_t k = poses_.size(); k-- > 0 && k + kRecent > poses_.size();)
    for (const std::size_t i : terms_[k].sightings)
      if (const int point = points_[drive_.sightings[i].point]; seen.insert(point).second)
        last.push_back(point);
  std::reverse(last.begin(), last.end());
  if (sensor_) last.push_back(*sensor_);
  last.push_back(poses_.front());
  last.push_back(poses_.back());
  return last;
}

/// Which pose stays where it is changes nothing of what is known. But terms of a long drive that
/// are linearised at different times agree best where most of it hardly turns: not about the start,
/// past which little was read.
void IncrementalSmoother::holdAmongReadings() {
  if (poses_.size() < std::max(kFirstHold, 2 * held_since_)) return;
  held_since_ = poses_.size();
  std::size_t most = 0, best = held_;
  std::size_t around = 0;
  const auto count = [&](std::size_t k) {
    const auto& all = terms_[k].sightings;
    return static_cast<std::size_t>(
        std::count_if(all.begin(), all.end(), [&](std::size_t i) { return isUsed(i); }));
  };
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    around += count(k);
    if (k >= 2 * kAround + 1) around -= count(k - 2 * kAround - 1);
    if (k >= 2 * kAround && around > most) {
      most = around;
      best = k - kAround;
    }
  }
  if (best == held_) return;
  tree_.setFactor(hold_, {});
  held_ = best;
  bring(poses_[held_]);
  hold_ = tree_.addFactor(holdOf(poses_[held_], moved(poses_[held_])));
}

std::vector<int> IncrementalSmoother::variablesOf(const std::vector<std::size_t>& poses) const {
  std::vector<int> variables;
  if (sensor_) variables.push_back(*sensor_);
  for (const std::size_t k : poses) {
    if (k > 0) variables.push_back(poses_[k - 1]);
    variables.push_back(poses_[k]);
    for (const std::size_t i : terms_[k].sightings)
      variables.push_back(points_[drive_.sightings[i].point]);
    for (const std::size_t i : terms_[k].depths)
      variables.push_back(points_[drive_.depths[i].point]);
  }
  std::sort(variables.begin(), variables.end());
  variables.erase(std::unique(variables.begin(), variables.end()), variables.end());
  return variables;
}

/// One of Gauss and Newton, shorter where the terms that are looked at say that a large one leads
/// uphill.
bool IncrementalSmoother::step(const std::vector<std::size_t>& poses,
                               const std::vector<int>& variables) {
  if (!tree_.update(likelyNext())) return false;
  std::vector<Moved> before, by;
  before.reserve(variables.size());
  by.reserve(variables.size());
  double largest = 0.0;
  for (const int v : variables) {
    before.push_back(moved(v));
    by.emplace_back(tree_.x(v) - before.back());
    largest = std::max(largest, by.back().lpNorm<Eigen::Infinity>());
  }
  const auto go = [&](double share) {
    for (std::size_t i = 0; i < variables.size(); ++i)
      place(variables[i], before[i] + share * by[i]);
  };
  behind_.clear();
  const double cost = largest > kLarge ? costOf(poses) : HUGE_VAL;
  go(1.0);
  if (!(largest > kLarge) || costOf(poses) <= cost) return true;
  for (double share = 0.5; share > std::exp2(-kHalvings); share *= 0.5) {
    go(share);
    if (!(costOf(poses) <= cost)) continue;
    behind_ = variables;
    return true;
  }
  go(1.0);
  return true;
}

bool IncrementalSmoother::update() {
  if (poses_.size() < 2) return false;
  holdAmongReadings();
  const std::vector<std::size_t> poses = sweep();
  const std::vector<int> variables = variablesOf(poses);
  for (const int v : variables) bring(v);
  std::size_t first = 0;
  const auto anyOf = [&](bool (IncrementalSmoother::*changed)(std::size_t)) {
    bool any = false;
    for (std::size_t i = first; i < poses.size(); ++i) any |= (this->*changed)(poses[i]);
    return any;
  };
  anyOf(&IncrementalSmoother::relineariseAt);
  double work = 0.0;
  for (int gating = 0; gating < kMostGatings; ++gating) {
    bool off = true;
    for (int i = 0; i < kMostSteps && off; ++i) {
      if (!step(poses, variables)) return false;
      work += tree_.work();
      if (work > kAffordable) first = poses.size() - recent_;
      off = anyOf(&IncrementalSmoother::relineariseAt) || !behind_.empty();
    }
    if (gating + 1 < kMostGatings && !anyOf(&IncrementalSmoother::gateAt)) break;
  }
  return true;
}

double IncrementalSmoother::costOf(const std::vector<std::size_t>& poses) const {
  double cost = 0.0;
  for (const std::size_t k : poses) {
    if (k > 0) cost += motionDistance2(drive_, k);
    for (const std::size_t i : terms_[k].sightings)
      if (const Drive::Sighting& sighting = drive_.sightings[i]; sighting.used)
        cost += huberLoss(distance2(drive_, sighting), sighting.measurement.z.size());
    for (const std::size_t i : terms_[k].depths) {
      const DepthTerm term = depthTerm(drive_, drive_.depths[i]);
      cost += term.residual * term.information * term.residual;
    }
  }
  return cost;
}

const Pose2& IncrementalSmoother::pose(std::size_t pose) {
  bring(poses_[pose]);
  return drive_.T_world_robot[pose];
}

const Drive& IncrementalSmoother::drive() {
  for (int v = 0; v < static_cast<int>(number_.size()); ++v) bring(v);
  return drive_;
}

Eigen::Matrix3d IncrementalSmoother::lastPoseCovariance() {
  const Eigen::MatrixXd P = tree_.covarianceOfLast();
  // Of xi: the first pose is given when everything turns with it.
  const Eigen::Matrix3d first = liftOf(pose(0)).inverse();
  const Eigen::Matrix3d lift = liftOf(drive_.T_world_robot.back());
  Eigen::Matrix<double, 3, 6> J;
  J << -lift * first, Eigen::Matrix3d::Identity();
  return J * P * J.transpose();
}

std::size_t IncrementalSmoother::unused() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < sightings_.size(); ++i)
    count += !removed_[i] && !drive_.sightings[i].used;
  return count;
}

}  // namespace colonnade
