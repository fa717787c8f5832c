// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "depth_slope_corners.hpp"

#include <algorithm>
#include <cmath>

#include "depth_slope_round.hpp"

namespace colonnade {
namespace {

constexpr double kPieceCost = 25.0;     ///< chi-squared: a bend must be worth it
constexpr double kStrayCost = 9.0;      ///< three sigma
constexpr double kSharedColumns = 2.2;  ///< neighbouring columns share their error

/// A lip of a frame or skirting board shows where a column covers no more of its surface.
constexpr double kResolved_m = 0.015;

double angleBetween(const InverseLine& a, const InverseLine& b) {
  return std::acos(std::clamp(a.normal().dot(b.normal()), -1.0, 1.0));
}

class Finder {
 public:
  Finder(const InverseColumns& columns, double focal_px, const DepthSlopeOptions& options)
      : columns_(columns), focal_px_(focal_px), options_(options), fits_(columns) {
    for (const auto& piece : straightPieces(columns, kPieceCost, kStrayCost))
      if (isStrong(piece)) addSurface(piece);
    markRound();
  }

  std::vector<SliceCorner> corners() const {
    std::vector<SliceCorner> found;
    for (std::size_t i = 0; i + 1 < surfaces_.size(); ++i) {
      auto corner = between(i, i + 1);
      if (!corner) continue;
      const double range_m = corner->p_slice().norm();
      if (range_m < options_.min_range_m || range_m > options_.max_range_m) continue;
      found.push_back(std::move(*corner));
    }
    return found;
  }

 private:
  struct Surface {
    InverseLine line;
    bool round = false;
  };

  double sAt(std::size_t column) const { return columns_[column].s; }
  Eigen::Vector2d endOf(const InverseLine& line, bool right) const {
    return line.point(sAt(right ? line.last - 1 : line.first));
  }

  /// Outlines fray over a few pixels and would be surfaces of their own.
  bool isStrong(const InverseLine& piece) const {
    constexpr double kPerFocal = 1.0 / 97.0;  // 6 columns of a camera with f = 580 px
    const double least = std::max(4.0, options_.min_columns * focal_px_ * kPerFocal / 6.0);
    return static_cast<double>(piece.columns()) >= least && piece.at(sAt(piece.first)) > 0.0 &&
           piece.at(sAt(piece.last - 1)) > 0.0 &&
           (endOf(piece, true) - endOf(piece, false)).norm() >= options_.min_face_m;
  }

  /// Lens and pattern bend long walls a little: pieces that go on straight are one surface.
  void addSurface(const InverseLine& piece) {
    if (!surfaces_.empty()) {
      InverseLine& before = surfaces_.back().line;
      const double s = 0.5 * (sAt(before.last - 1) + sAt(piece.first));
      const double step_m = std::abs(1.0 / before.at(s) - 1.0 / piece.at(s));
      if (angleBetween(before, piece) < options_.min_turn / 3.0 && step_m < reliefAt(s, before)) {
        before = fits_.fit(before.first, piece.last);
        return;
      }
    }
    surfaces_.push_back({piece});
  }

  double columnSigma(double s, const InverseLine& line) const {
    const double z = 1.0 / std::max(line.at(s), 1e-3);
    return std::sqrt(columns_[line.first].variance) * z * z;
  }
  double jumpAt(double s, const InverseLine& line) const {
    return options_.min_jump_m + 4.0 * columnSigma(s, line);
  }
  double reliefAt(double s, const InverseLine& line) const {
    return 0.005 + 2.0 * columnSigma(s, line);
  }

  /// A frame or lip too narrow to be a surface of its own stands out from the end of a surface by
  /// `relief_m` at most: the corner is on it, so the surface is moved there, parallel to itself.
  InverseLine withRelief(InverseLine line, bool right, std::size_t limit) const {
    const double d = 1.0 / std::hypot(line.b, line.at(0.0));  // distance of the plane
    double sum = 0.0, at = 0.0;
    int count = 0;
    std::size_t last = line.last;
    const auto take = [&](std::size_t i) {
      const double factor = columns_[i].q / line.at(sAt(i));
      const double out_m = d * (1.0 - 1.0 / factor);
      const double noise_m = 3.0 * std::sqrt(columns_[i].variance) / columns_[i].q * d;
      if (out_m < noise_m || out_m > options_.relief_m + noise_m) return false;
      sum += factor;
      at += sAt(i);
      ++count;
      last = i;
      return true;
    };
    if (right)
      for (std::size_t i = line.last; i < limit && take(i); ++i) continue;
    else
      for (std::size_t i = line.first; i-- > limit && take(i);) continue;
    if (count < 2) return line;
    const double factor = sum / count;
    line.q_middle *= factor;
    line.b *= factor;
    line.covariance *= factor * factor;
    line.covariance(0, 0) += columns_[last].variance / count;
    if (right)
      line.last = last + 1;
    else
      line.first = last;
    return line;
  }

  /// The part of a surface within the window beside its right or left end.
  InverseLine beside(const InverseLine& line, bool right) const {
    const Eigen::Vector2d end = endOf(line, right);
    std::size_t first = line.first, last = line.last;
    constexpr std::size_t kLeast = 4;
    const auto outside = [&](std::size_t i) {
      return (line.point(sAt(i)) - end).norm() > options_.window_m;
    };
    while (right && last - first > kLeast && outside(first)) ++first;
    while (!right && last - first > kLeast && outside(last - 1)) --last;
    return fits_.fit(first, last);
  }

  /// Metres of a surface that one column sees at s, beyond what shows every lip.
  double unresolved(const InverseLine& line, double s) const {
    const double q = line.at(s);
    const Eigen::Vector2d step =
        Eigen::Vector2d(1.0, 0.0) / q - Eigen::Vector2d(s, 1.0) * (line.b / (q * q));  // dp / ds
    return std::max(0.0, step.norm() / focal_px_ - kResolved_m);
  }

  /// A lip that the columns do not resolve may stand out from the end of a surface at s.
  InverseLine withHiddenRelief(InverseLine line, double s) const {
    constexpr double kOfColumn = 0.3;
    const double sigma_m = std::min(kOfColumn * unresolved(line, s), 0.25 * options_.relief_m);
    const double sigma_q = sigma_m * line.q_middle * std::hypot(line.b, line.at(0.0));
    line.covariance(0, 0) += sigma_q * sigma_q / kSharedColumns;
    return line;
  }

  /// The surfaces left and right meet in a corner where both are seen to end.
  std::optional<SliceCorner> meeting(const InverseLine& left, const InverseLine& right) const {
    auto corner = intersection(left, right, kSharedColumns);
    if (!corner || !(corner->q > 0.0)) return std::nullopt;
    const double tolerance =
        options_.reach_px / focal_px_ + 2.0 * std::sqrt(corner->covariance(0, 0));
    if (corner->s < sAt(left.last - 1) - tolerance || corner->s > sAt(right.first) + tolerance)
      return std::nullopt;
    const Eigen::Vector2d gap = endOf(left, true) - endOf(right, false);
    if (gap.norm() > options_.max_gap_m + 2.0 * tolerance / corner->q) return std::nullopt;
    return corner;
  }

  bool areConnected(std::size_t i) const {
    const auto& left = surfaces_[i].line;
    const auto& right = surfaces_[i + 1].line;
    return meeting(beside(left, true), beside(right, false)).has_value();
  }

  bool isConvex(const InverseLine& left, const InverseLine& right) const {
    return right.b < left.b;  // inverse depth has its peak at the corner
  }

  /// Runs of connected surfaces that turn away together are round if a circle explains them for
  /// less than so many pieces do.
  void markRound() {
    for (std::size_t i = 0; i < surfaces_.size();) {
      std::size_t j = i;
      double cost = surfaces_[i].line.cost + kPieceCost;
      while (j + 1 < surfaces_.size() && isConvex(surfaces_[j].line, surfaces_[j + 1].line) &&
             areConnected(j)) {
        ++j;
        const double strays =
            static_cast<double>(surfaces_[j].line.first - surfaces_[j - 1].line.last);
        cost += surfaces_[j].line.cost + kPieceCost + kStrayCost * strays;
      }
      if (j > i) {
        const auto circle = fitCircle(columns_, surfaces_[i].line.first, surfaces_[j].line.last);
        if (circle.radius_m > 0.0 && circle.cost + 1.5 * kPieceCost < cost)
          for (std::size_t k = i; k <= j; ++k) surfaces_[k].round = true;
      }
      i = j + 1;
    }
  }

  std::optional<SliceCorner> between(std::size_t i, std::size_t j) const {
    const InverseLine& i_line = surfaces_[i].line;
    const InverseLine& j_line = surfaces_[j].line;
    const InverseLine left = withRelief(beside(i_line, true), true, j_line.first);
    const InverseLine right = withRelief(beside(j_line, false), false, left.last);
    std::optional<SliceCorner> corner = meeting(left, right);
    if (corner && isConvex(left, right))
      corner = meeting(withHiddenRelief(left, corner->s), withHiddenRelief(right, corner->s));
    bool round = false;
    if (corner) {
      corner->turn = angleBetween(left, right);
      if (corner->turn < options_.min_turn) return std::nullopt;
      if (!isConvex(left, right) && !options_.concave) return std::nullopt;
      round = surfaces_[i].round && surfaces_[j].round;
    } else if (options_.occlusions) {
      corner = jump(left, right);
      if (!corner) return std::nullopt;
      round = surfaces_[corner->far_on_right ? i : j].round;
    }
    if (!corner) return std::nullopt;
    if (round) corner->refusal = "the outline of something round";
    corner->left = left;
    corner->right = right;
    return corner;
  }

  /// Sensors round surfaces off towards their outline; it is where depth has gone half of the way
  /// to what lies behind, a few pixels farther on at most.
  double outlineEnd(const InverseLine& near, const InverseLine& far, bool right,
                    std::size_t limit) const {
    constexpr double kReach = 12.0 / 580.0;
    constexpr double kRounded_m = 0.1;
    const double end = sAt(right ? near.last - 1 : near.first);
    double s = end;
    const auto take = [&](std::size_t i) {
      const double z_near = 1.0 / near.at(sAt(i)), z_far = 1.0 / far.at(sAt(i));
      const double beyond_m = 1.0 / columns_[i].q - z_near;
      if (std::abs(sAt(i) - end) > kReach || !(z_near > 0.0) ||
          beyond_m > std::min(0.5 * (z_far - z_near), kRounded_m))
        return false;
      s = sAt(i);
      return true;
    };
    if (right)
      for (std::size_t i = near.last; i < limit && take(i); ++i) continue;
    else
      for (std::size_t i = near.first; i-- > limit && take(i);) continue;
    return s;
  }

  std::optional<SliceCorner> jump(const InverseLine& left, const InverseLine& right) const {
    const double s_left = sAt(left.last - 1), s_right = sAt(right.first);
    SliceCorner corner;
    corner.jump = true;
    corner.far_on_right = left.at(s_left) > right.at(s_right);
    const InverseLine& near = corner.far_on_right ? left : right;
    const InverseLine& far = corner.far_on_right ? right : left;
    const double half_px = 0.5 / focal_px_;
    corner.s = corner.far_on_right ? outlineEnd(left, far, true, right.first) + half_px
                                   : outlineEnd(right, far, false, left.last) - half_px;
    corner.q = near.at(corner.s);
    if (!(corner.q > 0.0 && far.at(corner.s) > 0.0)) return std::nullopt;
    corner.step_m = 1.0 / far.at(corner.s) - 1.0 / corner.q;
    if (corner.step_m < jumpAt(corner.s, near)) return std::nullopt;
    // Nothing nearer may stand between them: then that hides where the surface ends.
    for (std::size_t i = left.last; i < right.first; ++i)
      if (columns_[i].q > 1.01 * near.at(sAt(i)) + 4.0 * std::sqrt(columns_[i].variance))
        return std::nullopt;
    const double edge_px = options_.edge_sigma_px * (0.25 + 0.75 * focal_px_ / 580.0);
    const double hidden_m = unresolved(near, corner.s);
    const double hidden_px = 1.2 * hidden_m / (hidden_m + kResolved_m);
    const double variance_s = (edge_px * edge_px + hidden_px * hidden_px) / (focal_px_ * focal_px_);
    const double variance_q = kSharedColumns * withHiddenRelief(near, corner.s).variance(corner.s);
    corner.covariance << variance_s, near.b * variance_s, near.b * variance_s,
        variance_q + near.b * near.b * variance_s;
    return corner;
  }

  const InverseColumns& columns_;
  double focal_px_;
  const DepthSlopeOptions& options_;
  InverseLineFits fits_;
  std::vector<Surface> surfaces_;
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

std::optional<bool> isSeenIn(const InverseColumns& band, const InverseColumns& columns,
                             const SliceCorner& corner, double focal_px) {
  const auto sideIn = [&](const InverseLine& line) -> std::optional<InverseLine> {
    const double low = columns[line.first].s, high = columns[line.last - 1].s;
    InverseColumns inside;
    for (const auto& column : band)
      if (column.s >= low && column.s <= high) inside.push_back(column);
    if (inside.size() < 3 || inside.size() * 2 < line.columns()) return std::nullopt;
    return InverseLineFits(inside).fit(0, inside.size());
  };
  const auto left = sideIn(*corner.left);
  const auto right = sideIn(*corner.right);
  if (!left || !right) return std::nullopt;
  const auto nearBy = [&](const InverseLine& seen, const InverseLine& line) {
    const double variance = kSharedColumns * (seen.variance(line.middle) + line.covariance(0, 0));
    return std::abs(seen.at(line.middle) - line.q_middle) <
           0.02 * line.q_middle + 3.0 * std::sqrt(variance);
  };
  if (corner.jump) {
    const auto& near = corner.far_on_right ? *left : *right;
    const auto& far = corner.far_on_right ? *right : *left;
    const auto& whole = corner.far_on_right ? *corner.left : *corner.right;
    if (!nearBy(near, whole) && near.at(whole.middle) > whole.q_middle)
      return std::nullopt;  // at these heights something stands before it
    const double step_m =
        1.0 / std::max(far.at(corner.s), 1e-3) - 1.0 / std::max(near.at(corner.s), 1e-3);
    return nearBy(near, whole) && step_m > 0.5 * corner.step_m;
  }
  if (!nearBy(*left, *corner.left) || !nearBy(*right, *corner.right)) return false;
  const auto there = intersection(*left, *right, kSharedColumns);
  if (!there) return false;
  const double tolerance =
      3.0 / focal_px + 3.0 * std::sqrt(there->covariance(0, 0) + corner.covariance(0, 0));
  return std::abs(there->s - corner.s) < tolerance;
}

}  // namespace colonnade
