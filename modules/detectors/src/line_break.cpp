// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "line_break.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "colonnade/base/vector_kernel.hpp"

namespace colonnade {
namespace {

struct Sums {
  double s = 0.0, t = 0.0, ss = 0.0, st = 0.0, tt = 0.0;
};
/// Sums over samples 0 to i, each in an array.
struct SumsBefore {
  const double *s, *t, *ss, *st, *tt;
  Sums at(std::size_t i) const { return {s[i], t[i], ss[i], st[i], tt[i]}; }
};

/// Sum of squared residuals of a straight line through n samples between two sums.
inline __attribute__((always_inline)) double costBetween(const Sums& a, const Sums& b, double n) {
  const double s = b.s - a.s, t = b.t - a.t;
  const double ss = b.ss - a.ss - s * s / n;
  const double st = b.st - a.st - s * t / n;
  const double tt = b.tt - a.tt - t * t / n;
  const double cost = ss > 0.0 ? tt - st * st / ss : tt;
  return cost > 0.0 ? cost : 0.0;
}

/// costs[i]: of two lines of which the second begins at sample i, for i in [first, last).
COLONNADE_VECTOR_KERNEL
void costsOfParts(const SumsBefore& sums, std::size_t count, std::size_t first, std::size_t last,
                  double* costs) {
  const SumsBefore before = sums;
  const Sums none, all = before.at(count);
  const auto n = static_cast<int>(count), end = static_cast<int>(last);
  double* __restrict out = costs;
  for (int i = static_cast<int>(first); i < end; ++i) {
    const Sums here{before.s[i], before.t[i], before.ss[i], before.st[i], before.tt[i]};
    out[i] = costBetween(none, here, i) + costBetween(here, all, n - i);
  }
}

/// The least cost of a line that may break at any sample, in O(samples).
class BrokenCosts {
 public:
  explicit BrokenCosts(SampleSpan samples)
      : count_(samples.size()), stride_(count_ + 1), sums_(5 * stride_, 0.0), costs_(count_) {
    double* const all[] = {&sums_[0], &sums_[stride_], &sums_[2 * stride_], &sums_[3 * stride_],
                           &sums_[4 * stride_]};
    const double origin = samples.s[0], level = samples.across[0];
    for (std::size_t i = 0; i < count_; ++i) {
      const double s = samples.s[i] - origin, t = samples.across[i] - level;
      const double terms[] = {s, t, s * s, s * t, t * t};
      for (std::size_t k = 0; k < 5; ++k) all[k][i + 1] = all[k][i] + terms[k];
    }
  }

  double ofOne() const { return costBetween({}, before().at(count_), static_cast<double>(count_)); }
  struct Break {
    std::size_t at;
    double cost;
  };
  /// The best place that leaves both parts so many samples.
  Break best(std::size_t least_samples) {
    const std::size_t first = least_samples, last = count_ - least_samples + 1;
    costsOfParts(before(), count_, first, last, costs_.data());
    const auto begin = costs_.begin();
    const auto best = std::min_element(begin + static_cast<std::ptrdiff_t>(first),
                                       begin + static_cast<std::ptrdiff_t>(last));
    return {static_cast<std::size_t>(best - begin), *best};
  }

 private:
  SumsBefore before() const {
    const double* const s = sums_.data();
    return {s, s + stride_, s + 2 * stride_, s + 3 * stride_, s + 4 * stride_};
  }
  std::size_t count_, stride_;
  std::vector<double> sums_, costs_;
};

}  // namespace

std::optional<std::size_t> breakOf(SampleSpan samples, double correlated_samples) {
  constexpr std::size_t kLeast = 10;  // samples of a part
  constexpr double kLeastSigma_px = 0.1;
  constexpr double kImprobable = 16.0;  // chi-squared, the place being free
  const std::size_t n = samples.size();
  if (n < 2 * kLeast) return std::nullopt;
  BrokenCosts costs(samples);
  const double whole = costs.ofOne();
  const auto [best, least] = costs.best(kLeast);
  const double variance =
      std::max(kLeastSigma_px * kLeastSigma_px, least / (static_cast<double>(n) - 4.0));
  if (whole - least < kImprobable * correlated_samples * variance) return std::nullopt;
  // Lenses bend lines by less than this.
  constexpr double kApart_px = 0.5;
  const auto one = leastSquares(samples);
  for (const SampleSpan part : {samples.first(best), samples.subspan(best)}) {
    const auto fit = leastSquares(part);
    if (!one || !fit) continue;
    for (const double s : {part.s[0], part.s[part.size() - 1]})
      if (std::abs(one->line.across(s) - fit->line.across(s)) > kApart_px) return best;
  }
  return std::nullopt;
}

}  // namespace colonnade
