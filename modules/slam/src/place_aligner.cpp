// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "place_aligner.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "colonnade/base/rigid_fit.hpp"

namespace colonnade {
namespace {

constexpr double kSamePlace_m = 0.10;
constexpr int kFits = 3;
/// Where the large map has nothing within this, it cannot tell.
constexpr double kMapped_m = 2.0;
/// A landmark has a like of its own within the tolerance by chance this often, or a namesake.
constexpr double kChance = 0.2, kChanceOfNamesake = 0.02;
constexpr double kLeastRms_m = 0.01;  ///< nothing fits better, but by chance

}  // namespace

bool mayBeOne(const PlaceMark& a, const PlaceMark& b) {
  if (a.kind != b.kind) return false;
  if (a.identity && b.identity) return *a.identity == *b.identity;
  return a.kind != LandmarkKind::kPillarEdge || !a.looks || !b.looks ||
         a.looks->sameDarkSide(*b.looks);
}

PlaceAligner::PlaceAligner(std::span<const PlaceMark> map, std::span<const PlaceMark> here,
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

int PlaceAligner::count(const Pose2& T_map_here) const {
  std::vector<bool> fits(here_.size(), false);
  for (std::size_t i = 0; i < here_.size(); ++i)
    near_.near(transform(T_map_here, here_[i].p), 2.0 * options_.tolerance_m,
               [&](std::size_t k, double) {
                 if (mayBeOne(here_[i], map_[k])) fits[place_of_[i]] = true;
               });
  return static_cast<int>(std::count(fits.begin(), fits.end(), true));
}

PlaceAligner::Alignment PlaceAligner::fitted(Pose2 T_map_here) const {
  std::vector<Pairing> pairs;
  for (int fit = 0; fit < kFits; ++fit) {
    const double wider = fit + 1 < kFits ? 2.0 : 1.0;
    pairs = paired(T_map_here, wider * options_.tolerance_m);
    if (pairs.size() < 2) return {};
    std::vector<PointPair> points;
    for (const Pairing& pair : pairs) points.push_back({map_[pair.map].p, here_[pair.here].p});
    T_map_here = rigidFit(points);
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

std::vector<PlaceAligner::Pairing> PlaceAligner::paired(const Pose2& T_map_here,
                                                        double reach_m) const {
  std::vector<Pairing> all, taken;
  for (std::size_t i = 0; i < here_.size(); ++i)
    near_.near(transform(T_map_here, here_[i].p), reach_m, [&](std::size_t k, double d) {
      if (mayBeOne(here_[i], map_[k])) all.push_back({i, k, d});
    });
  std::stable_sort(all.begin(), all.end(),
                   [](const Pairing& a, const Pairing& b) { return a.distance_m < b.distance_m; });
  std::set<std::size_t> used_here, used_map;
  for (const Pairing& pair : all) {
    if (used_here.contains(pair.here) || used_map.contains(pair.map)) continue;
    used_here.insert(pair.here);
    used_map.insert(pair.map);
    taken.push_back(pair);
  }
  return taken;
}

double PlaceAligner::evidenceOf(const Alignment& a) const {
  const double by_chance =
      (a.fits - a.named) * std::log(kChance) + a.named * std::log(kChanceOfNamesake);
  const double nearer = options_.tolerance_m / std::max(a.rms_m, kLeastRms_m);
  return std::max(0, 2 * a.fits - 3) * std::log(nearer) - by_chance;
}

}  // namespace colonnade
