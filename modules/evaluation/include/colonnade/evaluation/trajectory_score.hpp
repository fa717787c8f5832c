// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "colonnade/base/trajectory.hpp"
#include "colonnade/evaluation/anchor.hpp"
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

/// Which part of the time estimate and truth have in common. Seconds; shares of a span of zero
/// length are 1.
struct SpanScore {
  double truth_starts_after_s = 0.0;  ///< the estimate; negative: before it
  double truth_ends_before_s = 0.0;   ///< the estimate; negative: after it
  double estimate_in_truth = 1.0;     ///< share of the estimate's span the truth's span covers
  double truth_in_estimate = 1.0;     ///< and the other way round
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
  /// Relative error over one second, root mean square, metres and degrees (Sturm 2012, equation 1).
  std::optional<double> rpe_1s_m;
  std::optional<double> rpe_1s_deg;
  /// The same as the benchmark's program computes it with a fixed delta of one second: it compares
  /// the motions backwards in time, which counts a turn with the length of the motion, takes the
  /// pose nearest to one second later, and never the last one. For comparison with published
  /// figures only.
  std::optional<double> rpe_1s_tum_m;
  /// Position error of the last matched pose when the first ones are laid on each other, percent of
  /// the path.
  std::optional<double> end_drift_percent;
  /// Mean of e' P^-1 e / 3 for the error e in (x, y, phi): 1 for an honest filter, above 1 when it
  /// is too sure of itself (Bar-Shalom 2001, section 5.4).
  std::optional<double> nees_mean;
  /// Share of poses whose e' P^-1 e lies below 7.815, the 95 % point of chi-squared with 3.
  std::optional<double> nees_share_within_95;
  std::size_t nees_poses = 0;
  std::size_t nees_left_out = 0;  ///< poses the anchor does not serve
  std::string nees_refused;       ///< why covariances gave no NEES; empty otherwise
  /// What NEES is judged in, in the world as it was at the start; absent without covariances.
  std::optional<Anchor> anchor;
  SpanScore span;
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
/// phi in the estimate's world, matched by stamp) the consistency is scored too, in the world as it
/// was at the start (StampedCovariance::T_world_origin). For it alone the
/// truth is moved so that its first matched pose is the estimate's (alignment none: it is taken as
/// it is). A filter starts without doubt; if the truth starts late it is in doubt there, so poses
/// the anchor does not serve are left out, and more of them than served ones refuse the NEES. Poses
/// whose covariance is not positive definite, such as the first of a run, do not count. Throws
/// Error when either trajectory is empty or no pose can be matched, naming both spans.
TrajectoryScore evaluateTrajectory(const Trajectory& estimate, const Trajectory& truth,
                                   const EvaluationOptions& options = {},
                                   const std::vector<StampedCovariance>& covariances = {});

/// What NEES of a map is judged in that lies in the world of `final`, the poses as they are known
/// at the end, or, where that does not have the anchored pose, as the world lies at the end.
std::optional<Anchor> anchorOfMap(const TrajectoryScore& score, const Trajectory& final,
                                  const std::vector<StampedCovariance>& covariances);

}  // namespace colonnade
