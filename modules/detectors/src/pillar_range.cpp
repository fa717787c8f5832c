// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "pillar_range.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "colonnade/detectors/depth_noise.hpp"
#include "range_strips.hpp"
#include "statistics.hpp"

namespace colonnade {
namespace {

constexpr int kRows = RangeStrips::kRows;
constexpr auto& kDistances_px = RangeStrips::kDistances_px;
constexpr std::size_t kPlaces = RangeStrips::kPlaces;
constexpr int kSurface_px = 8;  // width of the strip that measures a surface

/// A few numbers, without a heap.
template <std::size_t kMost>
class Few {
 public:
  void add(double value) { values_[count_++] = value; }
  std::size_t size() const { return count_; }
  std::span<double> all() { return {values_.data(), count_}; }

 private:
  std::array<double, kMost> values_;
  std::size_t count_ = 0;
};

/// The surface on one side: 1 / range is linear in the distance from the edge for a vertical plane.
struct Side {
  bool valid = false;
  std::size_t start = 0, last = 0;  ///< places
  double inverse_range = 0.0;       ///< at the edge
  double gradient = 0.0;            ///< per px away from the edge
  double range() const { return 1.0 / inverse_range; }
  int start_px() const { return kDistances_px[start]; }
};

/// Walks away from the edge until the surface ends. A nearer surface that begins within
/// kNearStart_px replaces a far one: depth edges are displaced.
Side walk(RangeStrips& strips, int which) {
  Side side;
  struct Bin {
    std::size_t place;
    double inverse;
    int px() const { return kDistances_px[place]; }
  };
  std::array<Bin, kPlaces> bins;
  std::size_t count = 0;
  const int usable_rows = strips.usableRows();
  for (std::size_t place = 0; place < kPlaces; ++place) {
    const int k = kDistances_px[place];
    const auto middle = strips.middle(which, place);
    if (middle.rows * 10 < usable_rows * 3 || middle.rows < 3) {
      if (count > 0 && k > bins[count - 1].px() + 3) break;
      continue;
    }
    const double inverse = middle.inverse;
    if (count > 0) {
      const double step = 1.0 / inverse - 1.0 / bins[count - 1].inverse;
      if (std::abs(step) > 0.06 + 2.0 * kinectDepthSigma(1.0 / inverse)) {
        const bool flying = count == 1;  // a pixel between two surfaces
        if (k > RangeStrips::kNearStart_px || (step > 0.0 && !flying)) break;
        count = 0;
      }
    }
    bins[count++] = {place, inverse};
    if (k >= bins[0].px() + kSurface_px - 1) break;
  }
  if (count < 2) return side;
  Few<kPlaces * kPlaces / 2> slopes;
  if (count >= 4)
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = i + 2; j < count; ++j)
        slopes.add((bins[j].inverse - bins[i].inverse) / (bins[j].px() - bins[i].px()));
  side.gradient = medianOf(slopes.all());
  Few<kPlaces> at_edge;
  for (std::size_t i = 0; i < count; ++i)
    at_edge.add(bins[i].inverse - side.gradient * bins[i].px());
  side.inverse_range = medianOf(at_edge.all());
  side.start = bins[0].place;
  side.last = bins[count - 1].place;
  side.valid = side.inverse_range > 0.0;
  return side;
}

/// Deviation of the range in each row from the surface that all rows share.
Few<kRows> rowDeviations(const RangeStrips& strips, int which, const Side& side) {
  Few<kRows> deviations;
  for (int row = 0; row < strips.usableRows(); ++row) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t place = side.start; place <= side.last; ++place) {
      const double inverse = strips.inverse(row, which, place);
      if (!std::isfinite(inverse)) continue;
      sum += inverse - (side.inverse_range + side.gradient * kDistances_px[place]);
      ++count;
    }
    if (count >= 2) deviations.add(-side.range() * side.range() * sum / count);
  }
  return deviations;
}

bool isUpright(const RangeStrips& strips, int which, const Side& side, double tolerance_m) {
  Few<kRows> all = rowDeviations(strips, which, side);
  if (all.size() < 4) return false;
  const double noise_m = 2.0 * kinectDepthSigma(side.range());
  const std::size_t half = (all.size() + 1) / 2;
  const double upper = medianOf(all.all().first(half)), lower = medianOf(all.all().subspan(half));
  return std::abs(upper - lower) < tolerance_m + noise_m &&
         robustSpread(all.all()) < tolerance_m + noise_m;
}

}  // namespace

PillarRange measurePillarRange(const DepthView& depth, const RefinedLine& line,
                               const PillarOptions& options, const GeometryOptions& geometry) {
  PillarRange result;
  if (depth.empty()) return result;
  RangeStrips strips(depth, line);
  if (strips.seenRows() < kRows / 4) return result;
  if (2 * strips.floorRows() > strips.seenRows()) {
    result.verdict = PillarRange::Verdict::kOnFloor;
    return result;
  }
  const Side sides[2] = {walk(strips, 0), walk(strips, 1)};
  if (!sides[0].valid && !sides[1].valid) return result;
  // Depth fails beside an edge in the shadow it throws, on panes, beyond the reach of depth and on
  // walls seen at a grazing angle: the surface that is seen ends in the edge.
  const bool one_sided = !sides[0].valid || !sides[1].valid;
  const int near = one_sided ? (sides[0].valid ? 0 : 1)
                             : (sides[0].inverse_range >= sides[1].inverse_range ? 0 : 1);
  const Side& nearer = sides[near];
  const double noise_m = kinectDepthSigma(nearer.range());
  // How much one pixel of displacement between depth and colour changes the range.
  const double lateral_m = nearer.range() * nearer.range() * std::abs(nearer.gradient);
  if (nearer.start_px() > RangeStrips::kNearStart_px) return result;
  if (!isUpright(strips, near, nearer, options.upright_tolerance_m)) {
    result.verdict = PillarRange::Verdict::kNotUpright;
    return result;
  }
  const Side& other = sides[1 - near];
  const bool smooth =
      !one_sided &&
      other.range() - nearer.range() < options.surface_step_m + 3.0 * noise_m + 2.0 * lateral_m &&
      other.start_px() <= RangeStrips::kNearStart_px;
  result.smooth = smooth;
  result.one_sided = one_sided;
  result.slope_m_per_px = lateral_m;
  result.range_m =
      smooth ? 2.0 / (sides[0].inverse_range + sides[1].inverse_range) : nearer.range();
  const double extrapolation = smooth ? 1.0 : 1.5;
  constexpr double kAveraged = 2.0;  // pixels of the strip share most of their error
  const double bias_m = depthBiasSigma(result.range_m, geometry.depth_bias_per_m2);
  result.sigma_m = std::hypot(std::hypot(extrapolation * noise_m / std::sqrt(kAveraged), lateral_m),
                              bias_m, 0.015);
  // It tells whether the edge stands on the floor, but now and then a pane or something black
  // stands there: such a range is not handed on.
  const bool usable = !one_sided && result.range_m >= geometry.min_depth_m &&
                      result.range_m <= geometry.max_depth_m;
  if (usable) result.verdict = PillarRange::Verdict::kMeasured;
  return result;
}

}  // namespace colonnade
