// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "depth_slope_corners.hpp"

#include <algorithm>
#include <cmath>

#include "depth_slope_jump.hpp"
#include "depth_slope_round.hpp"
#include "slice_surfaces.hpp"
#include "surface_ends.hpp"

namespace colonnade {
namespace {

class Finder {
 public:
  Finder(const InverseColumns& columns, double focal_px, const DepthSlopeOptions& options)
      : surfaces_(columns, focal_px, options),
        ends_(surfaces_),
        all_(surfaces_.all()),
        round_(all_.size(), false) {
    markRound();
  }

  std::vector<SliceCorner> corners() const {
    std::vector<SliceCorner> found;
    for (std::size_t i = 0; i + 1 < all_.size(); ++i) {
      auto corner = between(i, i + 1);
      if (!corner) continue;
      const double range_m = corner->p_slice().norm();
      if (range_m < surfaces_.options().min_range_m || range_m > surfaces_.options().max_range_m)
        continue;
      found.push_back(std::move(*corner));
    }
    return found;
  }

 private:
  /// The surfaces left and right meet in a corner where both are seen to end.
  std::optional<SliceCorner> meeting(const InverseLine& left, const InverseLine& right) const {
    auto corner = intersection(left, right, surfaces_.noise().shared);
    if (!corner || !(corner->q > 0.0)) return std::nullopt;
    const double tolerance = surfaces_.options().reach_px / surfaces_.focal_px() +
                             2.0 * std::sqrt(corner->covariance(0, 0));
    if (corner->s < surfaces_.sAt(left.last - 1) - tolerance ||
        corner->s > surfaces_.sAt(right.first) + tolerance)
      return std::nullopt;
    const Eigen::Vector2d gap = surfaces_.endOf(left, true) - surfaces_.endOf(right, false);
    if (gap.norm() > surfaces_.options().max_gap_m + 2.0 * tolerance / corner->q)
      return std::nullopt;
    return corner;
  }

  bool areConnected(std::size_t i) const {
    return meeting(ends_.beside(all_[i], true), ends_.beside(all_[i + 1], false)).has_value();
  }

  /// Whether columns beyond the corner show the surface that should have ended there instead of the
  /// other one, as where a cabinet stands a hand's breadth before a wall: then the planes cross
  /// where nothing is. Only of corners that point away from the camera; columns that cover both
  /// sides of a true one err the other way.
  bool goesOnPast(const SliceCorner& corner, const InverseLine& ending,
                  const InverseLine& other) const {
    constexpr double kFarthest_px = 12.0;
    constexpr double kGap_m = 0.025, kSigmas = 5.0;
    const bool to_right = ending.first < other.first;
    const double sigma_s = std::sqrt(corner.covariance(0, 0));
    for (std::size_t i = std::min(ending.first, other.first); i < std::max(ending.last, other.last);
         ++i) {
      const double beyond = (to_right ? 1.0 : -1.0) * (surfaces_.sAt(i) - corner.s);
      if (beyond < sigma_s) continue;
      if (beyond > kFarthest_px / surfaces_.focal_px() || !(other.at(surfaces_.sAt(i)) > 0.0))
        continue;
      const double variance = surfaces_.noise().scale * surfaces_.columns()[i].variance +
                              surfaces_.noise().shared * other.variance(surfaces_.sAt(i));
      // How far towards the surface that should have ended.
      const double way = ending.at(surfaces_.sAt(i)) > other.at(surfaces_.sAt(i)) ? 1.0 : -1.0;
      const double off = way * (surfaces_.columns()[i].q - other.at(surfaces_.sAt(i)));
      if (off > kSigmas * std::sqrt(variance) &&
          std::abs(1.0 / surfaces_.columns()[i].q - 1.0 / other.at(surfaces_.sAt(i))) > kGap_m)
        return true;
    }
    return false;
  }

  bool isConvex(const InverseLine& left, const InverseLine& right) const {
    return right.b < left.b;  // inverse depth has its peak at the corner
  }

  /// Runs of connected surfaces that turn away together are round if a circle explains them for
  /// less than so many pieces do.
  void markRound() {
    for (std::size_t i = 0; i < all_.size();) {
      std::size_t j = i;
      double cost = all_[i].line.cost + kPieceCost;
      while (j + 1 < all_.size() && isConvex(all_[j].line, all_[j + 1].line) && areConnected(j)) {
        ++j;
        const double strays = static_cast<double>(all_[j].line.first - all_[j - 1].line.last);
        cost += all_[j].line.cost + kPieceCost + kStrayCost * strays;
      }
      if (j > i) {
        const auto circle = fitCircle(surfaces_.columns(), all_[i].line.first, all_[j].line.last);
        if (circle.radius_m > 0.0 && circle.cost + 1.5 * kPieceCost < cost)
          for (std::size_t k = i; k <= j; ++k) round_[k] = true;
      }
      i = j + 1;
    }
  }

  std::optional<SliceCorner> between(std::size_t i, std::size_t j) const {
    const InverseLine& j_line = all_[j].line;
    InverseLine left = ends_.withRelief(ends_.beside(all_[i], true), true, j_line.first);
    InverseLine right = ends_.withRelief(ends_.beside(all_[j], false), false, left.last);
    std::optional<SliceCorner> corner = meeting(left, right);
    if (corner && !isConvex(left, right)) {
      const InverseLine pure_left = ends_.withoutMixed(left, true, corner->s);
      const InverseLine pure_right = ends_.withoutMixed(right, false, corner->s);
      if (const auto purer = meeting(pure_left, pure_right)) {
        left = pure_left;
        right = pure_right;
        corner = purer;
      }
    }
    if (corner && isConvex(left, right))
      corner = meeting(ends_.withHiddenRelief(left, corner->s),
                       ends_.withHiddenRelief(right, corner->s));
    bool round = false;
    if (corner) {
      corner->turn = angleBetween(left, right);
      if (corner->turn < surfaces_.options().min_turn) return std::nullopt;
      if (!isConvex(left, right) && !surfaces_.options().concave) return std::nullopt;
      round = round_[i] && round_[j];
      if (!isConvex(left, right) &&
          (goesOnPast(*corner, left, right) || goesOnPast(*corner, right, left)))
        corner->refusal = "a gap between the surfaces";
    } else if (surfaces_.options().occlusions) {
      corner = jumpBetween(surfaces_, left, right);
      if (!corner) return std::nullopt;
      round = round_[corner->far_on_right ? i : j];
    }
    if (!corner) return std::nullopt;
    if (round) corner->refusal = "the outline of something round";
    corner->left = left;
    corner->right = right;
    corner->noise_scale = surfaces_.noise().scale;
    corner->noise_shared = surfaces_.noise().shared;
    return corner;
  }

  SliceSurfaces surfaces_;
  SurfaceEnds ends_;
  const std::vector<SliceSurface>& all_;
  std::vector<bool> round_;  ///< each of them: part of something round
};

}  // namespace

std::optional<SliceCorner> intersection(const InverseLine& left, const InverseLine& right,
                                        double shared_columns) {
  const double bend = left.b - right.b;
  if (std::abs(bend) < 1e-9) return std::nullopt;
  SliceCorner corner;
  corner.s = (right.at(0.0) - left.at(0.0)) / bend;
  corner.q = left.at(corner.s);
  // ds = (e_right - e_left) / bend, dq = e_left + b_left ds, with e the errors of q there.
  const double in_left = -1.0 / bend, in_right = 1.0 / bend;
  const Eigen::Vector2d j_left(in_left, 1.0 + left.b * in_left);
  const Eigen::Vector2d j_right(in_right, left.b * in_right);
  corner.covariance = shared_columns * (left.variance(corner.s) * j_left * j_left.transpose() +
                                        right.variance(corner.s) * j_right * j_right.transpose());
  return corner;
}

std::vector<SliceCorner> findCorners(const DepthProfile& profile, const InverseColumns& columns,
                                     const DepthSlopeOptions& options) {
  return Finder(columns, profile.focal_px, options).corners();
}

}  // namespace colonnade
