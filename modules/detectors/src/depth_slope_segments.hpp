// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "colonnade/detectors/depth_profile.hpp"

namespace colonnade {

/// A measured column of the slice as inverse depth q (1/m) over slope s = x / z. An upright plane
/// is a straight line there, q = a + b s, and the noise of structured light nearly the same at all
/// distances, because inverse depth is disparity.
struct InverseColumn {
  double s = 0.0;
  double q = 0.0;
  double variance = 0.0;  ///< of q
  int index = 0;          ///< in the profile
  int pixels = 0;         ///< that q is the mean of
};
using InverseColumns = std::vector<InverseColumn>;

/// The valid columns, left to right, of the whole slice or of one of its bands.
InverseColumns inverseColumns(const DepthProfile& profile, int band = -1);

/// A straight line through columns [first, last), weighted by their variances.
struct InverseLine {
  std::size_t first = 0;
  std::size_t last = 0;
  double middle = 0.0;                                   ///< weighted mean of s
  double q_middle = 0.0;                                 ///< there
  double b = 0.0;                                        ///< dq / ds
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of (q_middle, b), columns independent
  double cost = 0.0;                                     ///< sum of squares over variance

  std::size_t columns() const { return last - first; }
  double at(double s) const { return q_middle + b * (s - middle); }
  double variance(double s) const {
    const Eigen::Vector2d j(1.0, s - middle);
    return j.dot(covariance * j);
  }
  /// The point (x, z) where the ray of slope s meets the plane.
  Eigen::Vector2d point(double s) const { return Eigen::Vector2d(s, 1.0) / at(s); }
  /// Unit normal in (x, z): from z (a + b s) = 1 follows b x + a z = 1.
  Eigen::Vector2d normal() const { return Eigen::Vector2d(b, q_middle - b * middle).normalized(); }
};

/// Fits lines to ranges of columns in O(1) each, from sums that are made once.
class InverseLineFits {
 public:
  explicit InverseLineFits(const InverseColumns& columns);
  InverseLine fit(std::size_t first, std::size_t last) const;
  double cost(std::size_t first, std::size_t last) const;
  /// Sums over columns, weighted by 1 / variance.
  struct Sums {
    double w = 0.0, s = 0.0, q = 0.0, ss = 0.0, sq = 0.0, qq = 0.0;
  };
  const Sums& sumsBefore(std::size_t column) const { return sums_[column]; }
  /// Of all columns: what their variances must be multiplied by, known before a line is fitted.
  void assumeScale(double scale) { scale_ = scale; }

 private:
  Sums between(std::size_t first, std::size_t last) const;
  std::vector<Sums> sums_;
  double scale_ = 1.0;
};

/// What the columns scatter about the lines that were fitted to them.
struct ColumnNoise {
  double scale = 1.0;   ///< of their variances
  double shared = 2.2;  ///< columns that have one error in common: 1 + 2 * sum of autocorrelation
};
/// Both from the residuals of all pieces together, the more the fewer columns they have.
ColumnNoise columnNoise(const InverseColumns& columns, const std::vector<InverseLine>& pieces);

/// The surfaces of a slice: the piecewise straight line of least cost, where each piece costs
/// `piece_cost` and a column that belongs to none `stray_cost`, both in units of chi-squared.
/// Optimal partitioning with pruning (Killick, Fearnhead and Eckley, "Optimal detection of
/// changepoints with a linear computational cost", JASA 2012), O(columns) on average.
std::vector<InverseLine> straightPieces(const InverseColumns& columns, double piece_cost,
                                        double stray_cost);

}  // namespace colonnade
