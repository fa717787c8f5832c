// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/place_finder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <unordered_map>

#include "place_aligner.hpp"

namespace colonnade {
namespace {

/// Lengths of the pairs that are laid onto each other; longer ones where landmarks are sparse.
constexpr double kShortest_m = 1.5, kLongest_m = 8.0;
/// Of the small map; fewer where these alignments would become too many.
constexpr std::size_t kMostPairs = 150, kFewestPairs = 20, kMostAlignments = 400'000;
/// Of the alignments, one of each bin: those with most votes are counted, then fitted.
constexpr std::size_t kCounted = 500, kFitted = 100;
/// Alignments nearer than this are one.
constexpr double kDistinct_m = 0.5;
constexpr double kDistinct = radians(10.0);

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
                            const PlaceAligner& aligner, double tolerance_m) {
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
  const PlaceAligner aligner(map, here, options);
  std::vector<PlaceAligner::Alignment> alignments;
  for (const Pose2& T : laidOnto(map, here, aligner, options.tolerance_m))
    alignments.push_back(aligner.fitted(T));
  if (alignments.empty()) return found;
  std::stable_sort(alignments.begin(), alignments.end(),
                   [](const auto& a, const auto& b) { return a.evidence > b.evidence; });
  const PlaceAligner::Alignment& best = alignments.front();
  const Eigen::Vector2d middle = middleOf(here);
  for (const PlaceAligner::Alignment& other : alignments) {
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
