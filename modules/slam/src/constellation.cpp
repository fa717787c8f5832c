// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/constellation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "colonnade/filter/gate.hpp"

namespace colonnade {
namespace {

constexpr double kSamePlace_m = 0.10;
constexpr double kAround_m = 1.0;  ///< what counts as around a constellation
constexpr std::size_t kMostPairs = 400;
/// A pair may lie so far out that one right pair in ten thousand is lost.
constexpr double kPairProbability = 0.9999;
/// Colours tell something when twins are nearer to each other than so many times what the other
/// pairings of the same landmarks are.
constexpr double kTellingColours = 0.6;
constexpr double kNextProbability = 0.99;

struct Pair {
  Twins twins;
  TwinDifference d;
  double alone2 = 0.0;
};

/// All pairs that may be twins, with their differences and the joint covariance of these.
struct Pairs {
  std::vector<Pair> pairs;
  Eigen::VectorXd difference;
  Eigen::MatrixXd C;
};

double distance2(const Eigen::Vector2d& e, const Eigen::Matrix2d& C) {
  const Eigen::LLT<Eigen::Matrix2d> llt(C);
  return llt.info() == Eigen::Success ? e.dot(llt.solve(e))
                                      : std::numeric_limits<double>::infinity();
}

/// Covariance of a drift (x, y, turn) since the kept landmark of the pair was last seen.
Eigen::Matrix3d driftCovariance(double way_m, const LoopOptions& options) {
  const double place = options.drift_share * way_m;
  return Eigen::Vector3d(place * place, place * place, options.drift_turn * options.drift_turn)
      .asDiagonal();
}

bool overlap(const State& state, const Twins& twins, const TwinDifference& d) {
  // The middle of the twin must lie beside the seen part of the kept line.
  const Block& kept = *state.find(twins.kept);
  const BlockVector k = state.values(kept);
  const Eigen::Vector2d m(std::cos(k(2)), std::sin(k(2)));
  const Eigen::Vector2d along(-m.y(), m.x());
  const double s = along.dot(d.p_kept - k.head<2>() - k(3) * m);
  return s > kept.evidence.along_min_m - kAround_m && s < kept.evidence.along_max_m + kAround_m;
}

Pairs pairUp(const std::vector<LandmarkId>& sleeping, const std::vector<LandmarkId>& recent,
             const EkfSlam& filter, const LandmarkBook& book, const LoopOptions& options) {
  const State& state = filter.state();
  std::vector<Pair> found;
  // The common drift is judged over the longest way, so that one covariance serves all pairs.
  double way_m = 0.0;
  for (const LandmarkId then : sleeping)
    way_m = std::max(way_m, book.way() - book.seenOnWay(then).last_m);
  const Eigen::Matrix3d D = driftCovariance(way_m, options);
  const TwinNoise noise{options.twin_place_m, options.twin_direction};
  const double gate = chiSquareQuantile(kPairProbability, 2);
  for (const LandmarkId now : recent) {
    for (const LandmarkId then : sleeping) {
      if (!book.lookAlike(then, now, state) || book.seenTogether(then, now)) continue;
      const auto d = differenceOf(state, {then, now});
      if (!d || (d->is_line && !overlap(state, {then, now}, *d))) continue;
      const Eigen::Matrix2d C = filter.covarianceOf(stacked({&*d, 1})) +
                                d->J_drift * D * d->J_drift.transpose() +
                                noise.covariance(d->is_line);
      const double alone2 = distance2(d->difference, C);
      if (alone2 < gate) found.push_back({{then, now}, *d, alone2});
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Pair& a, const Pair& b) { return a.alone2 < b.alone2; });
  if (found.size() > kMostPairs) found.erase(found.begin() + kMostPairs, found.end());

  Pairs pairs;
  std::vector<TwinDifference> differences;
  for (const Pair& pair : found) differences.push_back(pair.d);
  pairs.C = filter.covarianceOf(stacked(differences));
  const auto rows = static_cast<Eigen::Index>(2 * found.size());
  pairs.difference.resize(rows);
  Eigen::MatrixXd J(rows, 3);
  for (Eigen::Index i = 0; i < rows; i += 2) {
    const TwinDifference& d = differences[static_cast<std::size_t>(i / 2)];
    pairs.difference.segment<2>(i) = d.difference;
    J.middleRows<2>(i) = d.J_drift;
    pairs.C.block<2, 2>(i, i) += noise.covariance(d.is_line);
  }
  pairs.C += J * D * J.transpose();
  pairs.pairs = std::move(found);
  return pairs;
}

/// Differences and covariance of the pairs still open, given those already taken.
struct Conditional {
  std::vector<std::size_t> open;
  Eigen::VectorXd e;
  Eigen::MatrixXd C;

  double distance2At(std::size_t i) const {
    const auto row = static_cast<Eigen::Index>(2 * i);
    return distance2(e.segment<2>(row), C.block<2, 2>(row, row));
  }
  /// Takes open[i]: conditions all others on its difference being zero.
  void take(std::size_t i, double gate, const std::vector<Pair>& pairs) {
    const auto row = static_cast<Eigen::Index>(2 * i);
    const Eigen::LLT<Eigen::Matrix2d> llt(C.block<2, 2>(row, row));
    const Eigen::MatrixXd columns = C.middleCols<2>(row);
    e -= columns * llt.solve(Eigen::Vector2d(e.segment<2>(row)));
    C -= columns * llt.solve(columns.transpose());
    const Twins taken = pairs[open[i]].twins;
    std::vector<std::size_t> stays;
    for (std::size_t k = 0; k < open.size(); ++k) {
      const Twins& other = pairs[open[k]].twins;
      if (other.kept == taken.kept || other.twin == taken.twin || distance2At(k) > gate) continue;
      stays.push_back(k);
    }
    Conditional rest;
    const auto size = static_cast<Eigen::Index>(2 * stays.size());
    rest.e.resize(size);
    rest.C.resize(size, size);
    for (std::size_t a = 0; a < stays.size(); ++a) {
      rest.open.push_back(open[stays[a]]);
      const auto row_a = static_cast<Eigen::Index>(2 * a);
      const auto from_a = static_cast<Eigen::Index>(2 * stays[a]);
      rest.e.segment<2>(row_a) = e.segment<2>(from_a);
      for (std::size_t b = 0; b < stays.size(); ++b)
        rest.C.block<2, 2>(row_a, static_cast<Eigen::Index>(2 * b)) =
            C.block<2, 2>(from_a, static_cast<Eigen::Index>(2 * stays[b]));
    }
    *this = std::move(rest);
  }
};

std::vector<std::size_t> grow(const Pairs& pairs, std::size_t seed, double& joint2) {
  const double gate = chiSquareQuantile(kNextProbability, 2);
  Conditional c;
  c.open.resize(pairs.pairs.size());
  for (std::size_t i = 0; i < c.open.size(); ++i) c.open[i] = i;
  c.e = pairs.difference;
  c.C = pairs.C;
  std::vector<std::size_t> members{seed};
  joint2 = c.distance2At(seed);
  c.take(seed, gate, pairs.pairs);
  while (!c.open.empty()) {
    std::size_t best = 0;
    double best2 = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < c.open.size(); ++i) {
      const double d2 = c.distance2At(i);
      if (d2 < best2) {
        best2 = d2;
        best = i;
      }
    }
    members.push_back(c.open[best]);
    joint2 += best2;
    c.take(best, gate, pairs.pairs);
  }
  return members;
}

int countPlaces(const std::vector<Eigen::Vector2d>& places) {
  int count = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const bool known =
        std::any_of(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(i),
                    [&](const auto& p) { return (p - places[i]).norm() < kSamePlace_m; });
    count += known ? 0 : 1;
  }
  return count;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::optional<Eigen::Vector2d> placeOf(LandmarkId id, const State& state) {
  const Block* block = state.find(id);
  if (!block || block->block_kind != BlockKind::kPoint) return std::nullopt;
  return state.values(*block).head<2>();
}

Constellation describe(const Pairs& pairs, const std::vector<std::size_t>& members, double joint2,
                       const std::vector<LandmarkId>& recent, const EkfSlam& filter,
                       const LandmarkBook& book) {
  Constellation c;
  c.distance2 = joint2;
  c.degrees_of_freedom = static_cast<int>(2 * members.size());
  std::vector<Eigen::Vector2d> places;  // then
  std::vector<Eigen::Vector2d> seen;    // now
  std::vector<Twins> coloured;
  for (const std::size_t i : members) {
    const Pair& pair = pairs.pairs[i];
    c.twins.push_back(pair.twins);
    if (pair.d.is_line) {
      ++c.floor_edges;
      continue;
    }
    places.push_back(pair.d.p_kept);
    seen.push_back(pair.d.p_kept + pair.d.difference);
    c.shift += pair.d.difference;
    c.largest_shift_m = std::max(c.largest_shift_m, pair.d.difference.norm());
    if (filter.state().find(pair.twins.kept)->landmark_kind == LandmarkKind::kPillarEdge)
      coloured.push_back(pair.twins);
  }
  if (places.empty()) return c;
  c.shift /= static_cast<double>(places.size());
  c.places = countPlaces(places);
  for (const auto& a : places)
    for (const auto& b : places) c.spread_m = std::max(c.spread_m, (a - b).norm());
  std::vector<Eigen::Vector2d> around;
  for (const LandmarkId id : recent) {
    const auto p = placeOf(id, filter.state());
    if (p && std::any_of(seen.begin(), seen.end(),
                         [&](const auto& q) { return (*p - q).norm() < kAround_m; }))
      around.push_back(*p);
  }
  c.share = around.empty() ? 0.0 : static_cast<double>(countPlaces(seen)) / countPlaces(around);
  std::vector<double> own, others;
  for (const Twins& one : coloured)
    for (const Twins& other : coloured)
      if (const auto levels = book.colourDistance(one.kept, other.twin, filter.state()))
        (one.kept == other.kept ? own : others).push_back(*levels);
  if (own.size() >= 3) {
    c.colour_levels = median(own);
    c.other_colour_levels = median(others);
  }
  return c;
}

/// Why a constellation is not enough by itself.
std::string judge(const Constellation& c, const LoopOptions& options) {
  if (c.places < options.min_places) return "too few places";
  if (c.spread_m < options.min_spread_m) return "too narrow";
  if (c.share < options.min_share) return "too few of the places around it fit";
  if (c.distance2 > chiSquareQuantile(options.joint_probability, c.degrees_of_freedom))
    return "joint test";
  if (c.colour_levels && *c.colour_levels > 2.0 * options.colour_levels) return "colours differ";
  return "";
}

std::string cuesOf(const Constellation& c, const LoopOptions& options) {
  std::string cues;
  if (c.floor_edges > 0) cues += "floor edges";
  if (c.colour_levels && *c.colour_levels <= options.colour_levels &&
      *c.colour_levels < kTellingColours * c.other_colour_levels)
    cues += cues.empty() ? "colours" : " and colours";
  return cues;
}

}  // namespace

LoopCandidate findConstellation(const std::vector<LandmarkId>& sleeping,
                                const std::vector<LandmarkId>& recent, const EkfSlam& filter,
                                const LandmarkBook& book, const LoopOptions& options) {
  LoopCandidate candidate;
  candidate.refusal = "nothing fits";
  const Pairs pairs = pairUp(sleeping, recent, filter, book, options);
  if (static_cast<int>(pairs.pairs.size()) < options.min_places) return candidate;

  std::vector<Constellation> found;
  std::vector<bool> explained(pairs.pairs.size(), false);
  for (std::size_t seed = 0; seed < pairs.pairs.size(); ++seed) {
    if (explained[seed] || pairs.pairs[seed].d.is_line) continue;
    double joint2 = 0.0;
    const auto members = grow(pairs, seed, joint2);
    for (const std::size_t i : members) explained[i] = true;
    found.push_back(describe(pairs, members, joint2, recent, filter, book));
  }
  if (found.empty()) return candidate;
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.places > b.places; });
  candidate.best = found.front();
  candidate.refusal = judge(candidate.best, options);
  candidate.cues = cuesOf(candidate.best, options);
  if (!candidate.refusal.empty()) return candidate;
  for (const Constellation& other : found)
    if ((other.shift - candidate.best.shift).norm() > options.distinct_m &&
        other.places > options.ambiguity * candidate.best.places)
      candidate.refusal = "another constellation fits as well";
  return candidate;
}

}  // namespace colonnade
