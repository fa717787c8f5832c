// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "colonnade/base/trajectory.hpp"
#include "colonnade/evaluation/covariance_csv.hpp"

namespace colonnade {

/// How the estimate is laid onto the truth before the absolute errors are taken: a rigid motion
/// that minimises the squared position errors, never a scale.
enum class Alignment {
  kNone,  ///< both already in one world
  kSe2,   ///< x, y and yaw; errors are taken in the plane
  kSe3    ///< all six (Horn 1987, Umeyama 1991); errors are taken in space
};
const char* name(Alignment alignment);
/// none, se2 or se3; throws Error (kUsage) otherwise.
Alignment alignmentOfName(const std::string& name);

struct EvaluationOptions {
  Alignment alignment = Alignment::kSe2;
  /// Truth is interpolated between two samples at most this far apart.
  double max_truth_gap_s = 0.1;
  /// A truth sample this near to a stamp is taken as it is, whatever the gaps beside it; a gap may
  /// also be longer by this, so that truth at 10 Hz is not lost to the rounding of its stamps.
  double same_stamp_s = 1e-3;
  /// Relative errors and path length do not reach over a longer time without a matched pose.
  double max_step_s = 1.0;
};

/// Relative pose errors over pieces of one length (Geiger 2012; Sturm 2012): root mean square over
/// every piece that starts at a matched pose and ends at the first one at least that far along the
/// true path. Percent and degrees a metre are of the true length of each piece.
struct DistanceError {
  double length_m = 0.0;
  std::size_t pieces = 0;
  double percent = 0.0;
  double deg_per_m = 0.0;
};

/// What a trajectory is worth. All optional numbers are absent where the data cannot tell them.
struct TrajectoryScore {
  Alignment alignment = Alignment::kSe2;
  /// Absolute trajectory error (Sturm 2012): root mean square of the aligned position errors.
  double ate_rmse_m = 0.0;
  double ate_max_m = 0.0;
  /// Of the rotation about the body's vertical axis, after alignment.
  double heading_rmse_deg = 0.0;
  std::vector<DistanceError> rpe;  ///< for 1, 2, 5 and 10 m; those with pieces only
  /// Relative error over one second, root mean square, metres and degrees.
  std::optional<double> rpe_1s_m;
  std::optional<double> rpe_1s_deg;
  /// Position error of the last matched pose when the first ones are laid on each other, percent of
  /// the path.
  std::optional<double> end_drift_percent;
  /// Mean of e' P^-1 e / 3 for the error e in (x, y, phi): 1 for an honest filter, above 1 when it
  /// is too sure of itself (Bar-Shalom 2001, section 5.4).
  std::optional<double> nees_mean;
  /// Share of poses whose e' P^-1 e lies below 7.815, the 95 % point of chi-squared with 3.
  std::optional<double> nees_share_within_95;
  std::size_t nees_poses = 0;
  double coverage = 0.0;  ///< share of the truth's time span that matched poses cover
  std::size_t matched = 0;
  std::size_t estimated = 0;
  double path_length_m = 0.0;  ///< of the truth along the matched poses
  /// Maps points of the estimate's world into the truth's.
  Eigen::Isometry3d T_truth_estimate = Eigen::Isometry3d::Identity();

  const DistanceError* rpeOver(double length_m) const;
};

/// Scores an estimate. Truth is interpolated at the estimate's stamps (linear, and along the
/// shortest rotation); stamps outside it or in a gap are not matched. With `covariances` (of x, y,
/// phi in the estimate's world, matched by stamp) the consistency is scored too: for it alone the
/// truth is moved so that its first matched pose is the estimate's, since the filter starts there
/// without doubt; poses whose covariance is not positive definite, such as that first one, are left
/// out. Throws Error when either trajectory is empty or no pose can be matched, naming both spans.
TrajectoryScore evaluateTrajectory(const Trajectory& estimate, const Trajectory& truth,
                                   const EvaluationOptions& options = {},
                                   const std::vector<StampedCovariance>& covariances = {});

}  // namespace colonnade
