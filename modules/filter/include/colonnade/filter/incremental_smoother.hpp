// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "colonnade/filter/bayes_tree.hpp"
#include "colonnade/filter/smoother.hpp"

namespace colonnade {

/// smooth() of a drive that goes on, without trials of other decisions, at a cost that hardly grows
/// with it: most of the drive stays eliminated (BayesTree), and a term is linearised again where it
/// is off from what its linearisation says (fluid relinearisation, iSAM2). Older terms are looked
/// at in turns. The first pose is given.
class IncrementalSmoother {
 public:
  IncrementalSmoother(double gate_probability, const std::optional<Drive::Sensor>& sensor);

  /// Poses, points and sightings are numbered as they are added. A sighting not used comes in when
  /// it is within the gate.
  void addPose(const Pose2& T_world_robot, const Drive::Motion& motion);
  std::size_t addPoint(const Eigen::Vector2d& p_world);
  std::size_t addSighting(const Drive::Sighting& sighting);
  /// It has no say any more.
  void removeSighting(std::size_t sighting);
  void addDepth(const Drive::Depth& depth);

  /// Steps of Gauss and Newton until no term is off by much. False: fewer than two poses, or no
  /// solution; then nothing it holds is of use.
  bool update();
  /// All of it as known by now, which takes as long as it is; sightings that were removed are not
  /// used.
  const Drive& drive();
  const Pose2& pose(std::size_t pose);  ///< alone
  std::size_t poses() const { return poses_.size(); }
  bool isUsed(std::size_t sighting) const { return drive_.sightings[sighting].used; }
  std::size_t unused() const;
  /// Of (x, y, phi) of the last pose in the axes of the world, given the first. After update().
  Eigen::Matrix3d lastPoseCovariance();

 private:
  using Moved = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, SensorErrors::kSize, 1>;
  /// What the terms of some poses depend on.
  std::vector<int> variablesOf(const std::vector<std::size_t>& poses) const;
  LinearFactor motionFactor(std::size_t pose) const;
  LinearFactor sightingFactor(std::size_t sighting) const;
  LinearFactor depthFactor(std::size_t depth) const;
  void set(int& factor, LinearFactor to);
  /// Whether it was off.
  bool relinearise(int factor, LinearFactor now);
  /// The terms of a pose: its motion, sightings and depths. Whether any was off, or a sighting came
  /// in or went out.
  bool relineariseAt(std::size_t pose);
  bool gateAt(std::size_t pose);
  /// Poses to look at this time: the new ones, some before them, and of the others as many as time
  /// allows, other ones each time.
  std::vector<std::size_t> sweep();
  bool step(const std::vector<std::size_t>& poses, const std::vector<int>& variables);
  std::vector<int> likelyNext() const;
  void holdAmongReadings();
  /// What is sought, as what it has moved by from where it started.
  Moved moved(int variable) const;
  void place(int variable, const Moved& moved);
  /// Where the tree has it, unless a step was cut short there.
  void bring(int variable);
  double costOf(const std::vector<std::size_t>& poses) const;

  double gate_probability_;
  Drive drive_;
  std::vector<bool> removed_;  ///< sightings
  BayesTree tree_;
  std::optional<int> sensor_;
  std::vector<int> poses_, points_;  ///< variables
  std::vector<Eigen::Vector3d> pose_bases_;
  std::vector<Eigen::Vector3d> pose_moved_;  ///< from there; turns are not wrapped
  std::vector<Eigen::Vector2d> point_bases_;
  std::vector<std::size_t> number_;                ///< of the pose or the point a variable is
  std::vector<bool> is_point_;                     ///< variables
  std::vector<int> motions_, sightings_, depths_;  ///< factors; -1: none
  struct Terms {
    std::vector<std::size_t> sightings, depths;
  };
  std::vector<Terms> terms_;    ///< of each pose, but for its motion
  std::size_t updated_ = 0;     ///< poses at the last update
  std::size_t swept_ = 0;       ///< the next pose to be looked at in turn
  std::size_t recent_ = 0;      ///< poses that are looked at in every step
  std::size_t held_ = 0;        ///< the pose that stays where it is
  std::size_t held_since_ = 0;  ///< poses by then
  int hold_ = -1;               ///< factor
  std::vector<int> behind_;     ///< not where the tree's solution is: a step was cut short
};

}  // namespace colonnade
