// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface_ends.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {

InverseLine SurfaceEnds::beside(const SliceSurface& surface, bool right) const {
  const InverseLine& line = surface.line;
  const InverseLine whole = besideEnd(line, right);
  // A wall beside a door frame that stands out from it is not straight: its line would be turned
  // by far more than the covariance says. Lenses bend walls too, by less.
  constexpr double kBent = 4.0;
  if (whole.cost < kBent * surfaces_.noise().scale * static_cast<double>(whole.columns()))
    return whole;
  return besideEnd(right ? surfaces_.fits().fit(surface.last_begin, line.last)
                         : surfaces_.fits().fit(line.first, surface.first_end),
                   right);
}

InverseLine SurfaceEnds::besideEnd(const InverseLine& line, bool right) const {
  const Eigen::Vector2d end = surfaces_.endOf(line, right);
  std::size_t first = line.first, last = line.last;
  constexpr std::size_t kLeast = 4;
  const auto outside = [&](std::size_t i) {
    return (line.point(surfaces_.sAt(i)) - end).norm() > surfaces_.options().window_m;
  };
  while (right && last - first > kLeast && outside(first)) ++first;
  while (!right && last - first > kLeast && outside(last - 1)) --last;
  return surfaces_.fits().fit(first, last);
}

InverseLine SurfaceEnds::withRelief(InverseLine line, bool right, std::size_t limit) const {
  const double d = 1.0 / std::hypot(line.b, line.at(0.0));  // distance of the plane
  double sum = 0.0;
  int count = 0;
  std::size_t last = line.last;
  const auto take = [&](std::size_t i) {
    const double factor = surfaces_.columns()[i].q / line.at(surfaces_.sAt(i));
    const double out_m = d * (1.0 - 1.0 / factor);
    const double noise_m =
        3.0 * std::sqrt(surfaces_.columns()[i].variance) / surfaces_.columns()[i].q * d;
    if (out_m < noise_m || out_m > surfaces_.options().relief_m + noise_m) return false;
    sum += factor;
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
  line.covariance(0, 0) += surfaces_.columns()[last].variance / count;
  if (right)
    line.last = last + 1;
  else
    line.first = last;
  return line;
}

double SurfaceEnds::unresolved(const InverseLine& line, double s) const {
  const double q = line.at(s);
  const Eigen::Vector2d step =
      Eigen::Vector2d(1.0, 0.0) / q - Eigen::Vector2d(s, 1.0) * (line.b / (q * q));  // dp / ds
  return std::max(0.0, step.norm() / surfaces_.focal_px() - kResolved_m);
}

InverseLine SurfaceEnds::withHiddenRelief(InverseLine line, double s) const {
  constexpr double kOfColumn = 0.3;
  const double sigma_m =
      std::min(kOfColumn * unresolved(line, s), 0.25 * surfaces_.options().relief_m);
  const double sigma_q = sigma_m * line.q_middle * std::hypot(line.b, line.at(0.0));
  line.covariance(0, 0) += sigma_q * sigma_q / surfaces_.noise().shared;
  return line;
}

InverseLine SurfaceEnds::withoutMixed(const InverseLine& line, bool right, double s_corner) const {
  const double mixed = 1.0 / surfaces_.focal_px();
  constexpr std::size_t kLeast = 4;
  std::size_t first = line.first, last = line.last;
  while (right && last - first > kLeast && surfaces_.sAt(last - 1) > s_corner - mixed) --last;
  while (!right && last - first > kLeast && surfaces_.sAt(first) < s_corner + mixed) ++first;
  return isFitted(line) ? surfaces_.fits().fit(first, last) : line;
}

/// Not so where it was moved onto a lip.
bool SurfaceEnds::isFitted(const InverseLine& line) const {
  return std::abs(surfaces_.fits().fit(line.first, line.last).at(line.middle) - line.q_middle) <
         1e-9;
}

InverseLine SurfaceEnds::withoutFray(const InverseLine& line, bool right) const {
  constexpr double kFray = 3.0 / 580.0;
  constexpr std::size_t kEnough = 12;  // columns: fewer cannot be extrapolated to the outline
  // What was moved onto a lip consists of such pixels alone, though few of them count.
  constexpr double kLipInward = 0.4, kInward = 1.0;  // columns
  if (!isFitted(line)) return doubtful(line, kLipInward);
  std::size_t first = line.first, last = line.last;
  const double end = surfaces_.sAt(right ? last - 1 : first);
  const auto isFray = [&](std::size_t i) { return std::abs(surfaces_.sAt(i) - end) < kFray; };
  while (right && last - first > kEnough && isFray(last - 1)) --last;
  while (!right && last - first > kEnough && isFray(first)) ++first;
  const InverseLine fitted = surfaces_.fits().fit(first, last);
  return isFray(right ? last - 1 : first) ? doubtful(fitted, kInward) : fitted;
}

/// As if all columns showed what lies so many columns aside.
InverseLine SurfaceEnds::doubtful(InverseLine line, double columns) const {
  const double sigma_q = columns * line.b / surfaces_.focal_px();
  line.covariance(0, 0) += sigma_q * sigma_q / surfaces_.noise().shared;
  return line;
}

}  // namespace colonnade
