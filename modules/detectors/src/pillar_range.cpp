// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "pillar_range.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "colonnade/detectors/depth_noise.hpp"
#include "statistics.hpp"

namespace colonnade {
namespace {

constexpr int kRows = 32;         // along the edge
constexpr int kFirst_px = 3;      // nearer pixels mix both surfaces
constexpr int kSurface_px = 8;    // width of the strip that measures a surface
constexpr int kReach_px = 28;     // how far to look past the shadow of a near object
constexpr int kNearStart_px = 7;  // depth and colour edges may be displaced by so much

struct RowSample {
  int row = 0;
  double inverse_range = 0.0;
};

/// The surface on one side: 1 / range is linear in the distance from the edge for a vertical plane.
struct Side {
  bool valid = false;
  int start = 0;  ///< px from the edge
  int last = 0;
  double inverse_range = 0.0;  ///< at the edge
  double gradient = 0.0;       ///< per px away from the edge
  double range() const { return 1.0 / inverse_range; }
};

/// Every pixel of the nearest surface, every third one of the shadow beyond.
constexpr int nextDistance(int k) { return k < kFirst_px + kSurface_px ? k + 1 : k + 3; }

using Strip = std::array<std::vector<RowSample>, kReach_px + 1>;  // by distance from the edge

std::vector<double> inverseRanges(const std::vector<RowSample>& samples) {
  std::vector<double> values;
  values.reserve(samples.size());
  for (const auto& sample : samples) values.push_back(sample.inverse_range);
  return values;
}

/// Walks away from the edge until the surface ends. A nearer surface that begins within
/// kNearStart_px replaces a far one: depth edges are displaced.
Side walk(const Strip& strip, int usable_rows) {
  Side side;
  std::vector<std::pair<int, double>> bins;
  for (int k = kFirst_px; k <= kReach_px; k = nextDistance(k)) {
    const auto& samples = strip[static_cast<std::size_t>(k)];
    if (static_cast<int>(samples.size()) * 10 < usable_rows * 3 || samples.size() < 3) {
      if (!bins.empty() && k > bins.back().first + 3) break;
      continue;
    }
    auto values = inverseRanges(samples);
    const double inverse = medianOf(values);
    if (!bins.empty()) {
      const double step = 1.0 / inverse - 1.0 / bins.back().second;
      if (std::abs(step) > 0.06 + 2.0 * kinectDepthSigma(1.0 / inverse)) {
        const bool flying = bins.size() == 1;  // a pixel between two surfaces
        if (k > kNearStart_px || (step > 0.0 && !flying)) break;
        bins.clear();
      }
    }
    bins.emplace_back(k, inverse);
    if (k >= bins.front().first + kSurface_px - 1) break;
  }
  if (bins.size() < 2) return side;
  std::vector<double> slopes;
  if (bins.size() >= 4) {
    for (std::size_t i = 0; i < bins.size(); ++i) {
      for (std::size_t j = i + 2; j < bins.size(); ++j) {
        slopes.push_back((bins[j].second - bins[i].second) / (bins[j].first - bins[i].first));
      }
    }
  }
  side.gradient = medianOf(slopes);
  std::vector<double> at_edge;
  for (const auto& [k, inverse] : bins) at_edge.push_back(inverse - side.gradient * k);
  side.inverse_range = medianOf(at_edge);
  side.start = bins.front().first;
  side.last = bins.back().first;
  side.valid = side.inverse_range > 0.0;
  return side;
}

/// Deviation of the range in each row from the surface that all rows share.
std::vector<std::pair<int, double>> rowDeviations(const Strip& strip, const Side& side) {
  std::array<double, kRows> sum{};
  std::array<int, kRows> count{};
  for (int k = side.start; k <= side.last; ++k) {
    for (const auto& sample : strip[static_cast<std::size_t>(k)]) {
      const auto row = static_cast<std::size_t>(sample.row);
      sum[row] += sample.inverse_range - (side.inverse_range + side.gradient * k);
      ++count[row];
    }
  }
  std::vector<std::pair<int, double>> deviations;
  for (int row = 0; row < kRows; ++row) {
    const auto i = static_cast<std::size_t>(row);
    if (count[i] < 2) continue;
    deviations.emplace_back(row, -side.range() * side.range() * sum[i] / count[i]);
  }
  return deviations;
}

bool isUpright(const Strip& strip, const Side& side, double tolerance_m) {
  const auto deviations = rowDeviations(strip, side);
  if (deviations.size() < 4) return false;
  std::vector<double> upper;
  std::vector<double> lower;
  std::vector<double> all;
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    (2 * i < deviations.size() ? upper : lower).push_back(deviations[i].second);
    all.push_back(deviations[i].second);
  }
  const double noise_m = 2.0 * kinectDepthSigma(side.range());
  const double trend_m = std::abs(medianOf(upper) - medianOf(lower));
  return trend_m < tolerance_m + noise_m && robustSpread(all) < tolerance_m + noise_m;
}

}  // namespace

PillarRange measurePillarRange(const DepthView& depth, const RefinedLine& line,
                               const PillarOptions& options, const GeometryOptions& geometry) {
  PillarRange result;
  if (depth.empty()) return result;
  Strip left;
  Strip right;
  int seen_rows = 0;
  int floor_rows = 0;
  for (int row = 0; row < kRows; ++row) {
    const double v = line.begin + (line.end - line.begin) * (row + 0.5) / kRows;
    const double u = line.across(v);
    std::array<std::optional<SeenPoint>, kReach_px + 1> points[2];
    const SeenPoint* nearest = nullptr;
    for (int side = 0; side < 2; ++side) {
      for (int k = kFirst_px; k <= kReach_px; k = nextDistance(k)) {
        auto& point = points[side][static_cast<std::size_t>(k)];
        point = depth.at({u + (side == 0 ? -k : k), v});
        if (point && k <= kNearStart_px && (!nearest || point->range_m < nearest->range_m)) {
          nearest = &*point;
        }
      }
    }
    if (!nearest) continue;
    ++seen_rows;
    if (nearest->height() < 0.05 + kinectDepthSigma(nearest->depth_m)) {
      ++floor_rows;
      continue;
    }
    for (int side = 0; side < 2; ++side) {
      for (int k = kFirst_px; k <= kReach_px; k = nextDistance(k)) {
        const auto& point = points[side][static_cast<std::size_t>(k)];
        if (point)
          (side == 0 ? left : right)[static_cast<std::size_t>(k)].push_back(
              {row, 1.0 / point->range_m});
      }
    }
  }
  if (seen_rows < kRows / 4) return result;
  if (2 * floor_rows > seen_rows) {
    result.verdict = PillarRange::Verdict::kOnFloor;
    return result;
  }
  const int usable_rows = seen_rows - floor_rows;
  const Side sides[2] = {walk(left, usable_rows), walk(right, usable_rows)};
  if (!sides[0].valid && !sides[1].valid) return result;
  // Depth fails beside an edge in the shadow it throws, on panes, beyond the reach of depth and on
  // walls seen at a grazing angle: the surface that is seen ends in the edge.
  const bool one_sided = !sides[0].valid || !sides[1].valid;
  const int near = one_sided ? (sides[0].valid ? 0 : 1)
                             : (sides[0].inverse_range >= sides[1].inverse_range ? 0 : 1);
  const Side& nearer = sides[near];
  const Strip& near_strip = near == 0 ? left : right;
  const double noise_m = kinectDepthSigma(nearer.range());
  // How much one pixel of displacement between depth and colour changes the range.
  const double lateral_m = nearer.range() * nearer.range() * std::abs(nearer.gradient);
  if (nearer.start > kNearStart_px) return result;
  if (!isUpright(near_strip, nearer, options.upright_tolerance_m)) {
    result.verdict = PillarRange::Verdict::kNotUpright;
    return result;
  }
  const Side& other = sides[1 - near];
  const bool smooth =
      !one_sided &&
      other.range() - nearer.range() < options.surface_step_m + 3.0 * noise_m + 2.0 * lateral_m &&
      other.start <= kNearStart_px;
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
