// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/place_finder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <tuple>
#include <unordered_map>

namespace colonnade {
namespace {

constexpr double kSamePlace_m = 0.10;
/// Lengths of the pairs that are laid onto each other; longer ones where landmarks are sparse.
constexpr double kShortest_m = 1.5, kLongest_m = 8.0;
/// Of the small map; fewer where these alignments would become too many.
constexpr std::size_t kMostPairs = 150, kFewestPairs = 20, kMostAlignments = 400'000;
/// Of the alignments, one of each bin: those with most votes are counted, then fitted.
constexpr std::size_t kCounted = 500, kFitted = 100;
constexpr int kFits = 3;
/// Where the large map has nothing within this, it cannot tell.
constexpr double kMapped_m = 2.0;
/// A landmark has a like of its own within the tolerance by chance this often, or a namesake.
constexpr double kChance = 0.2, kChanceOfNamesake = 0.02;
constexpr double kLeastRms_m = 0.01;  ///< nothing fits better, but by chance
/// Alignments nearer than this are one.
constexpr double kDistinct_m = 0.5;
constexpr double kDistinct = radians(10.0);

bool mayBeOne(const PlaceMark& a, const PlaceMark& b) {
  if (a.kind != b.kind) return false;
  if (a.identity && b.identity) return *a.identity == *b.identity;
  return a.kind != LandmarkKind::kPillarEdge || !a.looks || !b.looks ||
         a.looks->sameDarkSide(*b.looks);
}

/// Marks by square cells, for those near a point.
class Cells {
 public:
  Cells(std::span<const PlaceMark> marks, double side_m) : marks_(marks), side_m_(side_m) {
    for (std::size_t i = 0; i < marks.size(); ++i) cells_[keyOf(cellOf(marks[i].p))].push_back(i);
  }
  /// Calls visit(index, distance) for marks within `reach_m`, at most a side of a cell.
  template <class Visit>
  void near(const Eigen::Vector2d& p, double reach_m, Visit visit) const {
    const Eigen::Vector2i middle = cellOf(p);
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        const auto cell = cells_.find(keyOf(middle + Eigen::Vector2i(dx, dy)));
        if (cell == cells_.end()) continue;
        for (const std::size_t i : cell->second)
          if (const double d = (marks_[i].p - p).norm(); d <= reach_m) visit(i, d);
      }
    }
  }

 private:
  Eigen::Vector2i cellOf(const Eigen::Vector2d& p) const {
    return (p / side_m_).array().floor().cast<int>();
  }
  static std::int64_t keyOf(const Eigen::Vector2i& cell) {
    return (static_cast<std::int64_t>(cell.x()) << 32) ^ static_cast<std::uint32_t>(cell.y());
  }
  std::span<const PlaceMark> marks_;
  double side_m_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
};

struct Pair {
  std::size_t a, b;
  double length_m;
};

/// Half of the pairs of the small map are shorter than this, or all.
double longestOf(std::span<const PlaceMark> here) {
  std::vector<double> lengths{kLongest_m};
  for (std::size_t a = 0; a < here.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) lengths.push_back((here[a].p - here[b].p).norm());
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return std::max(kLongest_m, *middle);
}

/// Pairs whose length is of use, ascending by it.
std::vector<Pair> pairsOf(std::span<const PlaceMark> marks, double longest_m) {
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < marks.size(); ++a)
    for (std::size_t b = a + 1; b < marks.size(); ++b)
      if (const double length = (marks[b].p - marks[a].p).norm();
          length >= kShortest_m && length <= longest_m)
        pairs.push_back({a, b, length});
  std::sort(pairs.begin(), pairs.end(), [](const Pair& one, const Pair& other) {
    return std::tuple(one.length_m, one.a, one.b) < std::tuple(other.length_m, other.a, other.b);
  });
  return pairs;
}

/// So many of them, evenly spread over the lengths.
std::vector<Pair> thinned(const std::vector<Pair>& pairs, std::size_t most) {
  if (pairs.size() <= most) return pairs;
  std::vector<Pair> some;
  for (std::size_t i = 0; i < most; ++i) some.push_back(pairs[i * pairs.size() / most]);
  return some;
}

Pose2 alignmentOf(const Eigen::Vector2d& from_a, const Eigen::Vector2d& from_b,
                  const Eigen::Vector2d& to_a, const Eigen::Vector2d& to_b) {
  const Eigen::Vector2d u = from_b - from_a, v = to_b - to_a;
  const Pose2 turn{0.0, 0.0, std::atan2(u.x() * v.y() - u.y() * v.x(), u.dot(v))};
  const Eigen::Vector2d t = 0.5 * (to_a + to_b) - transform(turn, 0.5 * (from_a + from_b));
  return {t.x(), t.y(), turn.phi};
}

Eigen::Vector2d middleOf(std::span<const PlaceMark> marks) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const PlaceMark& mark : marks) middle += mark.p / static_cast<double>(marks.size());
  return middle;
}

class Aligner {
 public:
  Aligner(std::span<const PlaceMark> map, std::span<const PlaceMark> here,
          const PlaceOptions& options)
      : map_(map),
        here_(here),
        options_(options),
        near_(map, 2.0 * options.tolerance_m),
        around_(map, kMapped_m),
        place_of_(here.size()) {
    for (std::size_t i = 0; i < here.size(); ++i) {
      place_of_[i] = i;
      for (std::size_t k = 0; k < i && place_of_[i] == i; ++k)
        if ((here[k].p - here[i].p).norm() < kSamePlace_m) place_of_[i] = place_of_[k];
    }
  }

  struct Alignment {
    Pose2 T_map_here;
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    int fits = 0;
    int of = 0;
    int named = 0;  ///< of the places that fit, with the same identity
    double rms_m = 0.0;
    double evidence = 0.0;
  };

  /// Places that have a like of theirs within twice the tolerance.
  int count(const Pose2& T_map_here) const {
    std::vector<bool> fits(here_.size(), false);
    for (std::size_t i = 0; i < here_.size(); ++i)
      near_.near(transform(T_map_here, here_[i].p), 2.0 * options_.tolerance_m,
                 [&](std::size_t k, double) {
                   if (mayBeOne(here_[i], map_[k])) fits[place_of_[i]] = true;
                 });
    return static_cast<int>(std::count(fits.begin(), fits.end(), true));
  }

  /// By least squares, the reach becoming narrower.
  Alignment fitted(Pose2 T_map_here) const {
    std::vector<Pairing> pairs;
    for (int fit = 0; fit < kFits; ++fit) {
      const double wider = fit + 1 < kFits ? 2.0 : 1.0;
      pairs = paired(T_map_here, wider * options_.tolerance_m);
      if (pairs.size() < 2) return {};
      T_map_here = leastSquares(pairs);
    }
    Alignment found{T_map_here, {}, 0, 0, 0, 0.0, 0.0};
    std::set<std::size_t> fits, of, named;
    double sum2 = 0.0;
    for (const Pairing& pair : pairs) {
      found.pairs.emplace_back(pair.here, pair.map);
      fits.insert(place_of_[pair.here]);
      if (here_[pair.here].identity && map_[pair.map].identity) named.insert(place_of_[pair.here]);
      sum2 += (transform(T_map_here, here_[pair.here].p) - map_[pair.map].p).squaredNorm();
    }
    for (std::size_t i = 0; i < here_.size(); ++i)
      around_.near(transform(T_map_here, here_[i].p), kMapped_m,
                   [&](std::size_t, double) { of.insert(place_of_[i]); });
    found.fits = static_cast<int>(fits.size());
    found.of = static_cast<int>(of.size());
    found.named = static_cast<int>(named.size());
    found.rms_m = std::sqrt(sum2 / static_cast<double>(pairs.size()));
    found.evidence = evidenceOf(found);
    return found;
  }

  /// How unlikely chance does as well, as a natural logarithm: so many places have a like of theirs
  /// within the tolerance, and these, but for the three numbers that were fitted, lie so near.
  double evidenceOf(const Alignment& a) const {
    const double by_chance =
        (a.fits - a.named) * std::log(kChance) + a.named * std::log(kChanceOfNamesake);
    const double nearer = options_.tolerance_m / std::max(a.rms_m, kLeastRms_m);
    return std::max(0, 2 * a.fits - 3) * std::log(nearer) - by_chance;
  }

 private:
  struct Pairing {
    std::size_t here, map;
    double distance_m;
  };

  /// Each with one of the other map at most, the nearest first.
  std::vector<Pairing> paired(const Pose2& T_map_here, double reach_m) const {
    std::vector<Pairing> all, taken;
    for (std::size_t i = 0; i < here_.size(); ++i)
      near_.near(transform(T_map_here, here_[i].p), reach_m, [&](std::size_t k, double d) {
        if (mayBeOne(here_[i], map_[k])) all.push_back({i, k, d});
      });
    std::stable_sort(all.begin(), all.end(), [](const Pairing& a, const Pairing& b) {
      return a.distance_m < b.distance_m;
    });
    std::set<std::size_t> used_here, used_map;
    for (const Pairing& pair : all) {
      if (used_here.contains(pair.here) || used_map.contains(pair.map)) continue;
      used_here.insert(pair.here);
      used_map.insert(pair.map);
      taken.push_back(pair);
    }
    return taken;
  }

  /// Horn 1987, in the plane.
  Pose2 leastSquares(const std::vector<Pairing>& pairs) const {
    const auto count = static_cast<double>(pairs.size());
    Eigen::Vector2d here = Eigen::Vector2d::Zero(), map = here;
    for (const Pairing& pair : pairs) {
      here += here_[pair.here].p / count;
      map += map_[pair.map].p / count;
    }
    double cosine = 0.0, sine = 0.0;
    for (const Pairing& pair : pairs) {
      const Eigen::Vector2d a = here_[pair.here].p - here, b = map_[pair.map].p - map;
      cosine += a.dot(b);
      sine += a.x() * b.y() - a.y() * b.x();
    }
    const Pose2 turn{0.0, 0.0, std::atan2(sine, cosine)};
    const Eigen::Vector2d t = map - transform(turn, here);
    return {t.x(), t.y(), turn.phi};
  }

  std::span<const PlaceMark> map_, here_;
  const PlaceOptions& options_;
  Cells near_, around_;
  std::vector<std::size_t> place_of_;  ///< of the small map: its first mark there
};

/// Pairs of the small map with the pairs of the large one they may be laid onto.
class PairTable {
 public:
  PairTable(std::span<const PlaceMark> map, std::span<const PlaceMark> here, double tolerance_m)
      : map_(map), here_(here), tolerance_m_(tolerance_m) {
    const double longest_m = longestOf(here);
    map_pairs_ = pairsOf(map, longest_m + tolerance_m);
    here_pairs_ = pairsOf(here, longest_m);
    std::size_t alignments = 0;
    for (const Pair& pair : here_pairs_) alignments += likeIt(pair).size();
    here_pairs_ = thinned(here_pairs_, kMostPairs);
    if (alignments > kMostAlignments)
      here_pairs_ = thinned(
          here_pairs_, std::max(kFewestPairs, here_pairs_.size() * kMostAlignments / alignments));
  }

  /// Calls visit(T_map_here) for every alignment of a pair with a pair of its like.
  template <class Visit>
  void forEach(Visit visit) const {
    for (const Pair& pair : here_pairs_)
      for (const Pair& on : likeIt(pair))
        for (const auto& [a, b] : {std::pair(on.a, on.b), std::pair(on.b, on.a)})
          if (mayBeOne(here_[pair.a], map_[a]) && mayBeOne(here_[pair.b], map_[b]))
            visit(alignmentOf(here_[pair.a].p, here_[pair.b].p, map_[a].p, map_[b].p));
  }

 private:
  std::span<const Pair> likeIt(const Pair& pair) const {
    const auto shorter = [](const Pair& one, double length_m) { return one.length_m < length_m; };
    const auto first = std::lower_bound(map_pairs_.begin(), map_pairs_.end(),
                                        pair.length_m - tolerance_m_, shorter);
    return {first,
            std::lower_bound(first, map_pairs_.end(), pair.length_m + tolerance_m_, shorter)};
  }

  std::span<const PlaceMark> map_, here_;
  double tolerance_m_;
  std::vector<Pair> map_pairs_, here_pairs_;
};

/// What alignments say that are about the same: where the middle of the small map comes to lie.
struct Bin {
  int votes = 0;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  ///< sums
  double cosine = 0.0, sine = 0.0;

  Pose2 mean(const Eigen::Vector2d& middle_here) const {
    const Pose2 turn{0.0, 0.0, std::atan2(sine, cosine)};
    const Eigen::Vector2d t = middle / votes - transform(turn, middle_here);
    return {t.x(), t.y(), turn.phi};
  }
};

/// The alignments most pairs vote for, one of each bin, those with most places first.
std::vector<Pose2> laidOnto(std::span<const PlaceMark> map, std::span<const PlaceMark> here,
                            const Aligner& aligner, double tolerance_m) {
  const Eigen::Vector2d middle = middleOf(here);
  const auto turns = static_cast<std::int64_t>(std::lround(2.0 * kPi / kDistinct));
  std::unordered_map<std::int64_t, Bin> bins;
  PairTable(map, here, tolerance_m).forEach([&](const Pose2& T_map_here) {
    const Eigen::Vector2d p = transform(T_map_here, middle);
    const Eigen::Vector2d cell = (p / kDistinct_m).array().round();
    const std::int64_t turn = (std::llround(T_map_here.phi / kDistinct) + turns) % turns;
    Bin& bin = bins[(static_cast<std::int64_t>(cell.x()) * (1 << 24) +
                     static_cast<std::int64_t>(cell.y())) *
                        turns +
                    turn];
    ++bin.votes;
    bin.middle += p;
    bin.cosine += std::cos(T_map_here.phi);
    bin.sine += std::sin(T_map_here.phi);
  });
  std::vector<std::pair<int, Pose2>> best;
  for (const auto& [key, bin] : bins) best.emplace_back(bin.votes, bin.mean(middle));
  const auto more = [](const auto& a, const auto& b) {
    return std::tuple(a.first, a.second.x, a.second.y, a.second.phi) >
           std::tuple(b.first, b.second.x, b.second.y, b.second.phi);
  };
  const auto keep = [&](std::size_t most) {
    std::sort(best.begin(), best.end(), more);
    if (best.size() > most) best.resize(most);
  };
  keep(kCounted);
  for (auto& [places, T] : best) places = aligner.count(T);
  keep(kFitted);
  std::vector<Pose2> alignments;
  for (const auto& [places, T] : best) alignments.push_back(T);
  return alignments;
}

}  // namespace

FoundPlace findPlace(std::span<const PlaceMark> map, std::span<const PlaceMark> here,
                     const PlaceOptions& options) {
  FoundPlace found;
  if (here.size() < 2 || map.size() < 2) return found;
  const Aligner aligner(map, here, options);
  std::vector<Aligner::Alignment> alignments;
  for (const Pose2& T : laidOnto(map, here, aligner, options.tolerance_m))
    alignments.push_back(aligner.fitted(T));
  if (alignments.empty()) return found;
  std::stable_sort(alignments.begin(), alignments.end(),
                   [](const auto& a, const auto& b) { return a.evidence > b.evidence; });
  const Aligner::Alignment& best = alignments.front();
  const Eigen::Vector2d middle = middleOf(here);
  for (const Aligner::Alignment& other : alignments) {
    const bool same =
        (transform(best.T_map_here, middle) - transform(other.T_map_here, middle)).norm() <
            kDistinct_m &&
        std::abs(wrapAngle(best.T_map_here.phi - other.T_map_here.phi)) < kDistinct;
    if (!same) found.elsewhere = std::max(found.elsewhere, other.evidence);
  }
  found.T_map_here = best.T_map_here;
  found.pairs = best.pairs;
  found.fits = best.fits;
  found.of = best.of;
  found.rms_m = best.rms_m;
  found.evidence = best.evidence;
  const bool named = best.named == best.fits;
  if (best.fits < (named ? options.min_named_places : options.min_places))
    found.refusal = "too few places fit";
  else if (best.fits < options.min_share * best.of)
    found.refusal = "too few of the places there fit";
  else if (!named && best.evidence < options.min_evidence)
    found.refusal = "they may fit by chance";
  else if (found.elsewhere > options.ambiguity * best.evidence)
    found.refusal = "another place fits as well";
  else
    found.refusal.clear();
  return found;
}

}  // namespace colonnade
