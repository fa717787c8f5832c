// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "depth_slope_corners.hpp"

#include <algorithm>
#include <cmath>

#include "depth_slope_round.hpp"
#include "statistics.hpp"

namespace colonnade {
namespace {

constexpr double kPieceCost = 25.0;  ///< chi-squared: a bend must be worth it
constexpr double kStrayCost = 9.0;   ///< three sigma

/// A lip of a frame or skirting board shows where a column covers no more of its surface.
constexpr double kResolved_m = 0.015;

double angleBetween(const InverseLine& a, const InverseLine& b) {
  return std::acos(std::clamp(a.normal().dot(b.normal()), -1.0, 1.0));
}

class Finder {
 public:
  Finder(const InverseColumns& columns, double focal_px, const DepthSlopeOptions& options)
      : columns_(columns), focal_px_(focal_px), options_(options), fits_(columns) {
    std::vector<InverseLine> pieces = straightPieces(columns, kPieceCost, kStrayCost);
    std::erase_if(pieces, [&](const InverseLine& piece) { return !isStrong(piece); });
    noise_ = columnNoise(columns, pieces);
    fits_.assumeScale(noise_.scale);
    for (const auto& piece : pieces) addSurface(piece);
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
    std::size_t first_end = 0;   ///< of the straight piece at its left end
    std::size_t last_begin = 0;  ///< of the one at its right end
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
        surfaces_.back().last_begin = piece.first;
        return;
      }
    }
    surfaces_.push_back({piece, piece.last, piece.first});
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
  InverseLine beside(const Surface& surface, bool right) const {
    const InverseLine& line = surface.line;
    const InverseLine whole = beside(line, right);
    // A wall beside a door frame that stands out from it is not straight: its line would be turned
    // by far more than the covariance says. Lenses bend walls too, by less.
    constexpr double kBent = 4.0;
    if (whole.cost < kBent * noise_.scale * static_cast<double>(whole.columns())) return whole;
    return beside(
        right ? fits_.fit(surface.last_begin, line.last) : fits_.fit(line.first, surface.first_end),
        right);
  }

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
    line.covariance(0, 0) += sigma_q * sigma_q / noise_.shared;
    return line;
  }

  /// The surfaces left and right meet in a corner where both are seen to end.
  std::optional<SliceCorner> meeting(const InverseLine& left, const InverseLine& right) const {
    auto corner = intersection(left, right, noise_.shared);
    if (!corner || !(corner->q > 0.0)) return std::nullopt;
    const double tolerance =
        options_.reach_px / focal_px_ + 2.0 * std::sqrt(corner->covariance(0, 0));
    if (corner->s < sAt(left.last - 1) - tolerance || corner->s > sAt(right.first) + tolerance)
      return std::nullopt;
    const Eigen::Vector2d gap = endOf(left, true) - endOf(right, false);
    if (gap.norm() > options_.max_gap_m + 2.0 * tolerance / corner->q) return std::nullopt;
    return corner;
  }

  /// The columns in which two surfaces meet show some of both: not to be taken for either.
  InverseLine withoutMixed(const InverseLine& line, bool right, double s_corner) const {
    const double mixed = 1.0 / focal_px_;
    constexpr std::size_t kLeast = 4;
    std::size_t first = line.first, last = line.last;
    while (right && last - first > kLeast && sAt(last - 1) > s_corner - mixed) --last;
    while (!right && last - first > kLeast && sAt(first) < s_corner + mixed) ++first;
    return isFitted(line) ? fits_.fit(first, last) : line;
  }

  /// Not so where it was moved onto a lip.
  bool isFitted(const InverseLine& line) const {
    return std::abs(fits_.fit(line.first, line.last).at(line.middle) - line.q_middle) < 1e-9;
  }

  bool areConnected(std::size_t i) const {
    return meeting(beside(surfaces_[i], true), beside(surfaces_[i + 1], false)).has_value();
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
      const double beyond = (to_right ? 1.0 : -1.0) * (sAt(i) - corner.s);
      if (beyond < sigma_s) continue;
      if (beyond > kFarthest_px / focal_px_ || !(other.at(sAt(i)) > 0.0)) continue;
      const double variance =
          noise_.scale * columns_[i].variance + noise_.shared * other.variance(sAt(i));
      // How far towards the surface that should have ended.
      const double way = ending.at(sAt(i)) > other.at(sAt(i)) ? 1.0 : -1.0;
      const double off = way * (columns_[i].q - other.at(sAt(i)));
      if (off > kSigmas * std::sqrt(variance) &&
          std::abs(1.0 / columns_[i].q - 1.0 / other.at(sAt(i))) > kGap_m)
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
    const InverseLine& j_line = surfaces_[j].line;
    InverseLine left = withRelief(beside(surfaces_[i], true), true, j_line.first);
    InverseLine right = withRelief(beside(surfaces_[j], false), false, left.last);
    std::optional<SliceCorner> corner = meeting(left, right);
    if (corner && !isConvex(left, right)) {
      const InverseLine pure_left = withoutMixed(left, true, corner->s);
      const InverseLine pure_right = withoutMixed(right, false, corner->s);
      if (const auto purer = meeting(pure_left, pure_right)) {
        left = pure_left;
        right = pure_right;
        corner = purer;
      }
    }
    if (corner && isConvex(left, right))
      corner = meeting(withHiddenRelief(left, corner->s), withHiddenRelief(right, corner->s));
    bool round = false;
    if (corner) {
      corner->turn = angleBetween(left, right);
      if (corner->turn < options_.min_turn) return std::nullopt;
      if (!isConvex(left, right) && !options_.concave) return std::nullopt;
      round = surfaces_[i].round && surfaces_[j].round;
      if (!isConvex(left, right) &&
          (goesOnPast(*corner, left, right) || goesOnPast(*corner, right, left)))
        corner->refusal = "a gap between the surfaces";
    } else if (options_.occlusions) {
      corner = jump(left, right);
      if (!corner) return std::nullopt;
      round = surfaces_[corner->far_on_right ? i : j].round;
    }
    if (!corner) return std::nullopt;
    if (round) corner->refusal = "the outline of something round";
    corner->left = left;
    corner->right = right;
    corner->noise_scale = noise_.scale;
    corner->noise_shared = noise_.shared;
    return corner;
  }

  /// Sensors round surfaces off towards their outline; it is where depth has gone half of the way
  /// to what lies behind, a few pixels farther on at most.
  double outlineEnd(const InverseLine& near, const InverseLine& far, bool right,
                    std::size_t limit) const {
    constexpr double kReach = 12.0 / 580.0;
    constexpr double kRounded_m = 0.1;
    // Columns that few rows see are the fray of the outline.
    constexpr double kFray = 0.25;
    constexpr std::size_t kReference = 8;
    std::vector<int> pixels;
    for (std::size_t k = 0; k < std::min(kReference, near.columns()); ++k)
      pixels.push_back(columns_[right ? near.last - 1 - k : near.first + k].pixels);
    const double enough = kFray * medianOf(pixels);
    std::size_t end_column = right ? near.last - 1 : near.first;
    for (std::size_t k = 0; k + 1 < near.columns() && columns_[end_column].pixels < enough; ++k)
      right ? --end_column : ++end_column;
    const double end = sAt(end_column);
    double s = end;
    const auto take = [&](std::size_t i) {
      if (columns_[i].pixels < enough) return false;
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

  /// Pixels at an outline show what lies some pixels farther in (Nguyen, Izadi and Lovell 2012,
  /// lateral noise): on a slanting surface they are all too near or all too far.
  InverseLine withoutFray(const InverseLine& line, bool right) const {
    constexpr double kFray = 3.0 / 580.0;
    constexpr std::size_t kEnough = 12;  // columns: fewer cannot be extrapolated to the outline
    // What was moved onto a lip consists of such pixels alone, though few of them count.
    constexpr double kLipInward = 0.4, kInward = 1.0;  // columns
    if (!isFitted(line)) return doubtful(line, kLipInward);
    std::size_t first = line.first, last = line.last;
    const double end = sAt(right ? last - 1 : first);
    const auto isFray = [&](std::size_t i) { return std::abs(sAt(i) - end) < kFray; };
    while (right && last - first > kEnough && isFray(last - 1)) --last;
    while (!right && last - first > kEnough && isFray(first)) ++first;
    const InverseLine fitted = fits_.fit(first, last);
    return isFray(right ? last - 1 : first) ? doubtful(fitted, kInward) : fitted;
  }

  /// As if all columns showed what lies so many columns aside.
  InverseLine doubtful(InverseLine line, double columns) const {
    const double sigma_q = columns * line.b / focal_px_;
    line.covariance(0, 0) += sigma_q * sigma_q / noise_.shared;
    return line;
  }

  std::optional<SliceCorner> jump(const InverseLine& left, const InverseLine& right) const {
    const double s_left = sAt(left.last - 1), s_right = sAt(right.first);
    SliceCorner corner;
    corner.jump = true;
    corner.far_on_right = left.at(s_left) > right.at(s_right);
    InverseLine near = corner.far_on_right ? left : right;
    const InverseLine& far = corner.far_on_right ? right : left;
    const double half_px = 0.5 / focal_px_;
    corner.s = corner.far_on_right ? outlineEnd(left, far, true, right.first) + half_px
                                   : outlineEnd(right, far, false, left.last) - half_px;
    near = withoutFray(near, corner.far_on_right);
    corner.q = near.at(corner.s);
    if (!(corner.q > 0.0 && far.at(corner.s) > 0.0)) return std::nullopt;
    corner.step_m = 1.0 / far.at(corner.s) - 1.0 / corner.q;
    if (corner.step_m < jumpAt(corner.s, near)) return std::nullopt;
    // Nothing nearer may stand between them: then that hides where the surface ends.
    for (std::size_t i = left.last; i < right.first; ++i)
      if (columns_[i].q > 1.01 * near.at(sAt(i)) + 4.0 * std::sqrt(columns_[i].variance))
        return std::nullopt;
    const double edge_px = options_.edge_sigma_px * (0.5 + 0.5 * focal_px_ / 580.0);
    const double hidden_m = unresolved(near, corner.s);
    const double hidden_px = 0.5 * hidden_m / (hidden_m + kResolved_m);
    const double variance_s = (edge_px * edge_px + hidden_px * hidden_px) / (focal_px_ * focal_px_);
    const double variance_q = noise_.shared * withHiddenRelief(near, corner.s).variance(corner.s);
    corner.covariance << variance_s, near.b * variance_s, near.b * variance_s,
        variance_q + near.b * near.b * variance_s;
    return corner;
  }

  const InverseColumns& columns_;
  double focal_px_;
  const DepthSlopeOptions& options_;
  InverseLineFits fits_;
  ColumnNoise noise_;
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
    InverseLineFits fits(inside);
    fits.assumeScale(std::max(1.0, corner.noise_scale));
    return fits.fit(0, inside.size());
  };
  const auto left = sideIn(*corner.left);
  const auto right = sideIn(*corner.right);
  if (!left || !right) return std::nullopt;
  const auto nearBy = [&](const InverseLine& seen, const InverseLine& line) {
    const double variance =
        corner.noise_shared * (seen.variance(line.middle) + line.covariance(0, 0));
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
    const double z_near = 1.0 / std::max(near.at(corner.s), 1e-3);
    const double sigma_m =
        std::sqrt(corner.noise_shared * near.variance(corner.s)) * z_near * z_near;
    return nearBy(near, whole) && step_m + 3.0 * sigma_m > 0.5 * corner.step_m;
  }
  if (!nearBy(*left, *corner.left) || !nearBy(*right, *corner.right)) return false;
  const auto there = intersection(*left, *right, corner.noise_shared);
  if (!there) return false;
  const double tolerance =
      3.0 / focal_px + 3.0 * std::sqrt(there->covariance(0, 0) + corner.covariance(0, 0));
  return std::abs(there->s - corner.s) < tolerance;
}

}  // namespace colonnade
