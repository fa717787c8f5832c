// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "depth_slope_segments.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "colonnade/base/vector_kernel.hpp"
#include "colonnade/detectors/depth_noise.hpp"

namespace colonnade {
namespace {

constexpr std::size_t kShortest = 3;  ///< columns of a piece
constexpr std::size_t kStray = std::numeric_limits<std::size_t>::max();

struct CostRange {
  double least, most;
};

/// InverseLineFits::cost of pieces that end here, and what is before them. `starts`: the sums at
/// which they begin, one after the other, `stride` apart.
COLONNADE_VECTOR_KERNEL
CostRange costPieces(const InverseLineFits::Sums& end, const double* starts, std::size_t stride,
                     const double* before, std::size_t count, double* costs) {
  const InverseLineFits::Sums e = end;
  const double* __restrict w = starts;
  const double* __restrict s = starts + stride;
  const double* __restrict q = starts + 2 * stride;
  const double* __restrict ss = starts + 3 * stride;
  const double* __restrict sq = starts + 4 * stride;
  const double* __restrict qq = starts + 5 * stride;
  const double* __restrict cost_before = before;
  double* __restrict out = costs;
  for (std::size_t k = 0; k < count; ++k) {
    const double n_w = e.w - w[k], n_s = e.s - s[k], n_q = e.q - q[k];
    const double n_ss = e.ss - ss[k] - n_s * n_s / n_w;
    const double n_sq = e.sq - sq[k] - n_s * n_q / n_w;
    const double n_qq = e.qq - qq[k] - n_q * n_q / n_w;
    const double cost = n_qq - n_sq * n_sq / n_ss;
    out[k] = cost_before[k] + ((n_ss > 0.0) & (cost > 0.0) ? cost : 0.0);
  }
  using Lanes = double __attribute__((vector_size(32)));
  CostRange range{out[0], out[0]};
  Lanes least = range.least - Lanes{}, most = least;
  std::size_t k = 0;
  for (; k + 4 <= count; k += 4) {
    Lanes cost;
    std::memcpy(&cost, out + k, sizeof cost);
    least = cost < least ? cost : least;
    most = cost > most ? cost : most;
  }
  for (int i = 0; i < 4; ++i) {
    range.least = std::min(range.least, least[i]);
    range.most = std::max(range.most, most[i]);
  }
  for (; k < count; ++k) {
    range.least = std::min(range.least, out[k]);
    range.most = std::max(range.most, out[k]);
  }
  return range;
}

/// Starts of a piece, what their columns before sum up to and cost; number by number, for vectors.
class OpenStarts {
 public:
  explicit OpenStarts(std::size_t most)
      : starts_(most), costs_(most), before_(most), sums_(kSums * most), most_(most) {}

  void add(std::size_t start, const InverseLineFits::Sums& sums, double cost_before) {
    starts_[count_] = start;
    before_[count_] = cost_before;
    const double all[kSums] = {sums.w, sums.s, sums.q, sums.ss, sums.sq, sums.qq};
    for (std::size_t i = 0; i < kSums; ++i) sums_[i * most_ + count_] = all[i];
    ++count_;
  }

  struct Best {
    std::size_t start;
    double cost;  ///< of the piece and all before
  };
  /// The start from which a piece up to here costs least, if there is one.
  std::optional<Best> cheapest(const InverseLineFits::Sums& end) {
    if (count_ == 0) return std::nullopt;
    const CostRange range =
        costPieces(end, sums_.data(), most_, before_.data(), count_, costs_.data());
    highest_ = range.most;
    const auto least = std::find(costs_.begin(), costs_.end(), range.least);
    return Best{starts_[static_cast<std::size_t>(least - costs_.begin())], range.least};
  }

  /// Those that cost so much or more as last asked for.
  void dropAbove(double cost) {
    if (count_ == 0 || highest_ < cost) return;
    std::size_t kept = 0;
    while (kept < count_ && costs_[kept] < cost) ++kept;
    for (std::size_t k = kept; k < count_; ++k) {
      if (!(costs_[k] < cost)) continue;
      starts_[kept] = starts_[k];
      before_[kept] = before_[k];
      for (std::size_t i = 0; i < kSums; ++i) sums_[i * most_ + kept] = sums_[i * most_ + k];
      ++kept;
    }
    count_ = kept;
  }

 private:
  static constexpr std::size_t kSums = 6;
  std::vector<std::size_t> starts_;
  std::vector<double> costs_, before_, sums_;
  std::size_t most_;
  std::size_t count_ = 0;
  double highest_ = 0.0;  ///< of the costs
};

}  // namespace

InverseColumns inverseColumns(const DepthProfile& profile, int band) {
  // Rounding to columns and what remains of the steps of disparity; no average takes it out.
  constexpr double kFloor = 0.0004;
  InverseColumns result;
  result.reserve(profile.columns.size());
  for (std::size_t i = 0; i < profile.columns.size(); ++i) {
    const auto& column = profile.columns[i];
    const auto b = static_cast<std::size_t>(std::max(0, band));
    const double z = band < 0 ? column.z : column.band_z[b];
    if (!(z > 0.0)) continue;
    const double sigma = kinectDepthSigma(z) / (z * z);
    const double pixels = std::max(1, band < 0 ? column.pixels : column.pixels / 3);
    constexpr double kSharedByRows = 1.5;
    result.push_back({band < 0 ? column.slope : column.band_slope[b], 1.0 / z,
                      kFloor * kFloor + kSharedByRows * sigma * sigma / pixels, static_cast<int>(i),
                      column.pixels});
  }
  return result;
}

InverseLineFits::InverseLineFits(const InverseColumns& columns) : sums_(columns.size() + 1) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto& c = columns[i];
    const double w = 1.0 / c.variance;
    Sums& to = sums_[i + 1];
    to = sums_[i];
    to.w += w;
    to.s += w * c.s;
    to.q += w * c.q;
    to.ss += w * c.s * c.s;
    to.sq += w * c.s * c.q;
    to.qq += w * c.q * c.q;
  }
}

InverseLineFits::Sums InverseLineFits::between(std::size_t first, std::size_t last) const {
  const Sums& a = sums_[first];
  const Sums& b = sums_[last];
  Sums n{b.w - a.w, b.s - a.s, b.q - a.q, b.ss - a.ss, b.sq - a.sq, b.qq - a.qq};
  // About the weighted mean from here on.
  n.ss -= n.s * n.s / n.w;
  n.sq -= n.s * n.q / n.w;
  n.qq -= n.q * n.q / n.w;
  return n;
}

double InverseLineFits::cost(std::size_t first, std::size_t last) const {
  const Sums n = between(first, last);
  return n.ss > 0.0 ? std::max(0.0, n.qq - n.sq * n.sq / n.ss) : 0.0;
}

InverseLine InverseLineFits::fit(std::size_t first, std::size_t last) const {
  const Sums n = between(first, last);
  InverseLine line;
  line.first = first;
  line.last = last;
  line.middle = n.s / n.w;
  line.q_middle = n.q / n.w;
  if (n.ss <= 0.0) return line;
  line.b = n.sq / n.ss;
  line.covariance(0, 0) = 1.0 / n.w;
  line.covariance(1, 1) = 1.0 / n.ss;
  line.cost = std::max(0.0, n.qq - n.sq * n.sq / n.ss);
  // What the columns say of their own scatter counts, with a few of prior knowledge.
  constexpr double kPrior = 10.0;
  line.covariance *=
      (line.cost + kPrior * scale_) / (static_cast<double>(last - first) - 2.0 + kPrior);
  return line;
}

ColumnNoise columnNoise(const InverseColumns& columns, const std::vector<InverseLine>& pieces) {
  constexpr std::size_t kLags = 3;  // sensors correlate small windows
  constexpr double kPrior = 30.0;   // columns
  const ColumnNoise usual;
  std::array<double, kLags + 1> sums{}, counts{};
  double freedom = 0.0;
  for (const InverseLine& piece : pieces) {
    const auto residual = [&](std::size_t i) {
      return (columns[i].q - piece.at(columns[i].s)) / std::sqrt(columns[i].variance);
    };
    freedom += static_cast<double>(piece.columns()) - 2.0;
    for (std::size_t i = piece.first; i < piece.last; ++i)
      for (std::size_t lag = 0; lag <= kLags && i + lag < piece.last; ++lag) {
        if (columns[i + lag].index != columns[i].index + static_cast<int>(lag)) break;
        sums[lag] += residual(i) * residual(i + lag);
        counts[lag] += 1.0;
      }
  }
  if (!(sums[0] > 0.0 && freedom > 0.0)) return usual;
  double shared = 1.0;
  for (std::size_t lag = 1; lag <= kLags; ++lag)
    if (counts[lag] > 0.0) shared += 2.0 * (sums[lag] / counts[lag]) / (sums[0] / counts[0]);
  ColumnNoise noise;
  noise.scale = (kPrior * usual.scale + sums[0]) / (kPrior + freedom);
  noise.shared = (kPrior * usual.shared + freedom * std::max(1.0, shared)) / (kPrior + freedom);
  return noise;
}

std::vector<InverseLine> straightPieces(const InverseColumns& columns, double piece_cost,
                                        double stray_cost) {
  const std::size_t n = columns.size();
  const InverseLineFits fits(columns);
  std::vector<double> least(n + 1, 0.0);          // of the columns before
  std::vector<std::size_t> begin(n + 1, kStray);  // of the piece that ends there
  OpenStarts open(n);                             // where the last piece may begin
  for (std::size_t end = 1; end <= n; ++end) {
    least[end] = least[end - 1] + stray_cost;
    if (end >= kShortest) {
      const std::size_t start = end - kShortest;
      open.add(start, fits.sumsBefore(start), least[start]);
    }
    if (const auto best = open.cheapest(fits.sumsBefore(end));
        best && best->cost + piece_cost < least[end]) {
      least[end] = best->cost + piece_cost;
      begin[end] = best->start;
    }
    // A start that is worse by what two stray columns cost can never win again.
    open.dropAbove(least[end] + 2.0 * stray_cost);
  }
  std::vector<InverseLine> pieces;
  for (std::size_t end = n; end > 0;) {
    if (begin[end] == kStray) {
      --end;
      continue;
    }
    pieces.push_back(fits.fit(begin[end], end));
    end = begin[end];
  }
  std::reverse(pieces.begin(), pieces.end());
  return pieces;
}

}  // namespace colonnade
