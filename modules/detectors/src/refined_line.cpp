// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/refined_line.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "line_break.hpp"
#include "line_refinement.hpp"

namespace colonnade {
namespace {

/// The line through two samples that most others agree with; pairs are taken at fixed places.
std::optional<Straight> consensus(SampleSpan samples, double inlier_px) {
  const std::size_t n = samples.size();
  if (n < 8) return std::nullopt;
  std::optional<Straight> best;
  int best_count = 0;
  constexpr std::size_t kPlaces = 7;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    for (std::size_t j = i + 2; j < kPlaces; ++j) {
      const std::size_t a = i * (n - 1) / (kPlaces - 1), b = j * (n - 1) / (kPlaces - 1);
      const double steps = samples.s[b] - samples.s[a];
      if (steps < 8.0) continue;
      const Straight line{samples.s[a], samples.across[a],
                          (samples.across[b] - samples.across[a]) / steps};
      const int count = countWithin(samples, line, inlier_px, best_count);
      if (count > best_count) {
        best_count = count;
        best = line;
        if (count * 10 >= static_cast<int>(n) * 9) return best;
      }
    }
  }
  return best;
}

/// How many of the samples, ordered along the line, come before the first gap that is too wide.
std::size_t firstRun(SampleSpan samples, double max_gap_px) {
  std::size_t count = samples.empty() ? 0 : 1;
  while (count < samples.size() && samples.s[count] - samples.s[count - 1] <= max_gap_px) ++count;
  return count;
}

/// Share of the samples whose gradient points straight across the line; blobs of texture turn it.
double alignedShare(SampleSpan samples, const RefinedLine& line, const Walker& walker) {
  const Eigen::Vector2d normal =
      line.gradient_sign *
      (line.steep ? Eigen::Vector2d(1.0, -line.slope) : Eigen::Vector2d(-line.slope, 1.0));
  const double direction = std::atan2(normal.y(), normal.x());
  constexpr double kAligned = radians(33.0);
  std::array<int, 8> across{};
  for (std::size_t sector = 0; sector < across.size(); ++sector)
    across[sector] =
        std::abs(wrapAngle(static_cast<double>(sector) * kPi / 4.0 - direction)) < kAligned ? 1 : 0;
  int aligned = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
    aligned += across[static_cast<std::size_t>(walker.sectorAt(samples.s[i], samples.t[i])) %
                      across.size()];
  return static_cast<double>(aligned) / static_cast<double>(samples.size());
}

/// Uprights are not broken: lenses bend long ones a little.
bool mayBreak(const RefinedLine& line) {
  constexpr double kUpright = radians(20.0);
  return !line.steep || std::abs(line.slope) > std::tan(kUpright);
}

/// What a line is compared by.
struct Placed {
  Eigen::Vector2d begin, end;  ///< px
  Eigen::Vector2d along;       ///< unit
  Eigen::Vector2d gradient;    ///< unit: which way it points, roughly
  double length = 0.0;

  explicit Placed(const RefinedLine& line)
      : begin(line.at(line.begin)),
        end(line.at(line.end)),
        along((end - begin).normalized()),
        gradient(line.gradient_sign * (line.steep ? Eigen::Vector2d(1.0, -line.slope)
                                                  : Eigen::Vector2d(-line.slope, 1.0))
                                          .normalized()),
        length(line.length()) {}
};

/// `line` says nothing that the longer `kept` does not say.
bool isDuplicate(const Placed& line, const Placed& kept, double duplicate_px) {
  if (kept.gradient.dot(line.gradient) < 0.5) return false;
  double low = 1e9;
  double high = -1e9;
  for (const Eigen::Vector2d& end : {line.begin, line.end}) {
    const Eigen::Vector2d offset = end - kept.begin;
    if (std::abs(kept.gradient.dot(offset)) > duplicate_px) return false;
    low = std::min(low, kept.along.dot(offset));
    high = std::max(high, kept.along.dot(offset));
  }
  const double overlap = std::min(high, kept.length) - std::max(low, 0.0);
  return overlap > 0.4 * (high - low);
}

/// Another seed has led to this line already: neighbouring bins share most edges.
bool isFitted(const Straight& line, SampleSpan samples, bool steep, int sign,
              const RefinedLines& fitted) {
  constexpr double kSame_px = 0.7;
  return std::any_of(fitted.begin(), fitted.end(), [&](const RefinedLine& other) {
    if (other.steep != steep || other.gradient_sign != sign) return false;
    const auto same = [&](double s) {
      return std::abs(other.across(s) - line.across(s)) < kSame_px;
    };
    return same(samples.s[0]) && same(samples.s[samples.size() - 1]) && same(other.begin) &&
           same(other.end);
  });
}

}  // namespace

LineRefiner::LineRefiner(const cv::Mat& gray, const cv::Mat& edges, EdgeBits bits, bool steep,
                         const LineRefinementOptions& options)
    : walker_(gray, edges, std::move(bits), steep),
      steep_(steep),
      options_(options),
      rising_(walker_.steps()),
      falling_(walker_.steps()),
      beside_(walker_.steps()),
      some_(walker_.steps()) {}

void LineRefiner::refine(const Straight& guess, RefinedLines& lines) {
  walker_.collectFree(guess, options_.search_px, rising_, falling_);
  for (const int sign : {1, -1}) {
    Samples& beside = sign > 0 ? rising_ : falling_;
    if (static_cast<double>(beside.size()) < options_.min_support * 0.7 * options_.min_length_px) {
      continue;
    }
    walker_.measure(beside);
    const SampleSpan candidates = beside;
    const auto agreed = consensus(candidates, options_.inlier_px);
    if (!agreed || isFitted(*agreed, candidates, steep_, sign, lines)) continue;
    walker_.collectAll(*agreed, 2.0 * options_.inlier_px, sign, beside_);
    walker_.measure(beside_);
    some_.assignWithin(beside_, *agreed, options_.inlier_px);
    const auto fitted = leastSquares(some_);
    if (!fitted) continue;
    beside_.assignWithin(beside_, fitted->line, 1.5 * options_.inlier_px);
    for (SampleSpan rest = beside_; !rest.empty();) {
      const SampleSpan run = rest.first(firstRun(rest, options_.max_gap_px));
      rest = rest.subspan(run.size());
      if (run.s[run.size() - 1] - run.s[0] < 0.7 * options_.min_length_px) continue;
      some_.assign(run);
      const auto line = fitRun(some_, sign);
      if (!line) continue;
      walker_.take(some_, sign);
      if (mayBreak(*line))
        appendStraightParts(*line, some_, lines);
      else
        lines.push_back(*line);
    }
  }
}

std::optional<RefinedLine> LineRefiner::fitRun(Samples& samples, int sign) const {
  for (int round = 0; round < 2; ++round) {
    const auto fit = leastSquares(samples);
    if (!fit) return std::nullopt;
    samples.assignWithin(samples, fit->line, options_.inlier_px);
  }
  const auto fit = leastSquares(samples);
  if (!fit) return std::nullopt;
  const SampleSpan kept = samples;
  const double squares = sumOfSquaredResiduals(kept, fit->line);
  constexpr double kLeastSigma_px = 0.05;
  const double n = fit->samples;
  const double variance = std::max(kLeastSigma_px * kLeastSigma_px, squares / (n - 2.0 + 1e-9));
  RefinedLine result;
  result.steep = steep_;
  result.middle = fit->line.middle;
  result.offset = fit->line.offset;
  result.slope = fit->line.slope;
  result.covariance.diagonal() << 1.0 / n, 1.0 / fit->spread;
  result.covariance *= variance * options_.correlated_samples;
  result.begin = kept.s[0];
  result.end = kept.s[kept.size() - 1];
  result.gradient_sign = sign;
  result.samples = static_cast<int>(kept.size());
  const double steps = result.end - result.begin + 1.0;
  if (squares > n * options_.max_residual_px * options_.max_residual_px) return std::nullopt;
  if (result.length() < options_.min_length_px || n < options_.min_support * steps) {
    return std::nullopt;
  }
  if (alignedShare(kept, result, walker_) < options_.min_aligned) return std::nullopt;
  return result;
}

void LineRefiner::appendStraightParts(const RefinedLine& line, SampleSpan samples,
                                      RefinedLines& lines) const {
  const auto at = breakOf(samples, options_.correlated_samples);
  if (!at) {
    lines.push_back(line);
    return;
  }
  for (const SampleSpan some : {samples.first(*at), samples.subspan(*at)}) {
    Samples part(static_cast<int>(some.size()));
    part.assign(some);
    const auto fitted = fitRun(part, line.gradient_sign);
    if (fitted) appendStraightParts(*fitted, part, lines);
  }
}

RefinedLines withoutDuplicates(RefinedLines lines, double duplicate_px) {
  const auto rank = [](const RefinedLine& line) {
    return std::tuple(-line.length(), line.steep, line.offset, line.begin);
  };
  std::sort(lines.begin(), lines.end(),
            [&](const RefinedLine& a, const RefinedLine& b) { return rank(a) < rank(b); });
  RefinedLines kept;
  std::vector<Placed> places;
  for (const auto& line : lines) {
    const Placed place(line);
    if (std::any_of(places.begin(), places.end(),
                    [&](const Placed& longer) { return isDuplicate(place, longer, duplicate_px); }))
      continue;
    kept.push_back(line);
    places.push_back(place);
  }
  return kept;
}

RefinedLines refineLines(const cv::Mat& gray, const EdgeLines& edges,
                         const LineRefinementOptions& options) {
  if (gray.empty() || gray.type() != CV_8UC1 || edges.edges.size() != gray.size()) return {};
  auto [steep_bits, flat_bits] = bitsOfBoth(edges.edges);
  LineRefiner steep(gray, edges.edges, std::move(steep_bits), true, options);
  LineRefiner flat(gray, edges.edges, std::move(flat_bits), false, options);
  RefinedLines lines;
  for (const auto& seed : edges.lines) {
    const double theta = radians(seed.theta_index);
    const double c = std::cos(theta);
    const double s = std::sin(theta);
    if (std::abs(c) >= std::abs(s))
      steep.refine({0.0, seed.rho_bin / c, -s / c}, lines);
    else
      flat.refine({0.0, seed.rho_bin / s, -c / s}, lines);
  }
  return withoutDuplicates(std::move(lines), options.duplicate_px);
}

}  // namespace colonnade
