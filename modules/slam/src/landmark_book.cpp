// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/landmark_book.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

/// Widens the seen part of a floor edge by what this detection shows of it.
void widenExtent(const Block& block, const EkfSlam& filter, const Detection& detection,
                 Evidence& evidence) {
  const BlockVector y = filter.state().values(block);
  const Eigen::Vector2d m(std::cos(y(2)), std::sin(y(2)));
  const Eigen::Vector2d along(-m.y(), m.x());
  const Eigen::Vector2d foot = y.head<2>() + y(3) * m;
  const double a = along.dot(transform(filter.pose(), detection.p_robot_a) - foot);
  const double b = along.dot(transform(filter.pose(), detection.p_robot_b) - foot);
  const bool is_first = evidence.observations == 0;
  evidence.along_min_m = std::min({is_first ? a : evidence.along_min_m, a, b});
  evidence.along_max_m = std::max({is_first ? a : evidence.along_max_m, a, b});
}

constexpr int kPairSightings = 3;

}  // namespace

void LandmarkBook::observe(LandmarkId landmark, const Detection& detection, double stamp_s,
                           EkfSlam& filter) {
  Evidence& evidence = filter.evidence(landmark);
  const Block& block = *filter.state().find(landmark);
  if (block.block_kind == BlockKind::kFloorLine) widenExtent(block, filter, detection, evidence);
  if (evidence.observations == 0) evidence.first_stamp_s = stamp_s;
  evidence.last_stamp_s = stamp_s;
  ++evidence.observations;
  Page& page = pages_[landmark];
  if (page.looks.sightings() == 0)
    page.first_m = way_m_;
  else if (way_m_ - page.last_m > kLongWay_m)
    page.returned_m = way_m_;
  page.last_m = way_m_;
  page.looks.observe(detection);
}

LandmarkBook::Seen LandmarkBook::seenOnWay(LandmarkId landmark) const {
  const auto page = pages_.find(landmark);
  return page == pages_.end()
             ? Seen{}
             : Seen{page->second.first_m, page->second.last_m, page->second.returned_m};
}

bool LandmarkBook::isAsleep(LandmarkId landmark) const {
  const auto page = pages_.find(landmark);
  return page != pages_.end() && page->second.asleep;
}

void LandmarkBook::wakeAll() {
  for (auto& [id, page] : pages_) page.asleep = page.estranged = false;
}

void LandmarkBook::setEstranged(const std::set<LandmarkId>& landmarks) {
  for (const LandmarkId id : landmarks) {
    const auto page = pages_.find(id);
    if (page != pages_.end()) page->second.asleep = page->second.estranged = true;
  }
}

bool LandmarkBook::isEstranged(LandmarkId landmark) const {
  const auto page = pages_.find(landmark);
  return page != pages_.end() && page->second.estranged;
}

void LandmarkBook::endEstrangement() {
  for (auto& [id, page] : pages_) page.estranged = false;
}

void LandmarkBook::observeTogether(const std::vector<LandmarkId>& landmarks) {
  for (const LandmarkId id : landmarks) {
    auto& company = pages_[id].company;
    company.insert(landmarks.begin(), landmarks.end());
    company.erase(id);
  }
}

bool LandmarkBook::seenTogether(LandmarkId a, LandmarkId b) const {
  const auto page = pages_.find(a);
  return page != pages_.end() && page->second.company.contains(b);
}

bool LandmarkBook::lookAlike(LandmarkId a, LandmarkId b) const {
  const auto one = pages_.find(a), other = pages_.find(b);
  if (one == pages_.end() || other == pages_.end()) return true;
  return one->second.looks.sameDarkSide(other->second.looks);
}

std::optional<double> LandmarkBook::colourDistance(LandmarkId a, LandmarkId b) const {
  const auto one = pages_.find(a), other = pages_.find(b);
  if (one == pages_.end() || other == pages_.end() || one->second.looks.sightings() == 0 ||
      other->second.looks.sightings() == 0)
    return std::nullopt;
  return one->second.looks.colourDistance(other->second.looks);
}

void LandmarkBook::merge(LandmarkId kept, LandmarkId twin) {
  const auto from = pages_.find(twin);
  if (from == pages_.end()) return;
  const Page other = from->second;
  Page& page = pages_[kept];
  page.looks.merge(other.looks);
  page.first_m = std::min(page.first_m, other.first_m);
  page.last_m = std::max(page.last_m, other.last_m);
  for (const auto& [id, count] : other.partners)
    if (id != kept) page.partners[id] += count;
  page.company.insert(other.company.begin(), other.company.end());
  page.company.erase(kept);
  for (auto& [id, neighbour] : pages_) {
    if (id == kept) continue;
    if (const auto count = neighbour.partners.find(twin); count != neighbour.partners.end())
      neighbour.partners[kept] += count->second;
    if (neighbour.company.contains(twin)) neighbour.company.insert(kept);
  }
  forget(twin);
}

void LandmarkBook::observePair(LandmarkId a, LandmarkId b) {
  ++pages_[a].partners[b];
  ++pages_[b].partners[a];
}

void LandmarkBook::forget(LandmarkId landmark) {
  pages_.erase(landmark);
  for (auto& [id, page] : pages_) {
    page.partners.erase(landmark);
    page.company.erase(landmark);
  }
}

bool LandmarkBook::looksLike(LandmarkId landmark, const Detection& detection) const {
  const auto page = pages_.find(landmark);
  if (page == pages_.end() || detection.kind() != LandmarkKind::kPillarEdge) return true;
  return page->second.looks.sameDarkSide(detection);
}

const LandmarkLooks* LandmarkBook::looks(LandmarkId landmark) const {
  const auto page = pages_.find(landmark);
  return page == pages_.end() ? nullptr : &page->second.looks;
}

std::optional<LandmarkId> LandmarkBook::bestPartner(LandmarkId landmark) const {
  const auto page = pages_.find(landmark);
  if (page == pages_.end() || page->second.partners.empty()) return std::nullopt;
  const auto& partners = page->second.partners;
  const auto best = std::max_element(partners.begin(), partners.end(),
                                     [](auto& a, auto& b) { return a.second < b.second; });
  if (best->second < kPairSightings) return std::nullopt;
  return best->first;
}

void LandmarkBook::fillPairs(LandmarkMap& map) const {
  for (LandmarkRecord& record : map) {
    const auto partner = bestPartner(record.id);
    const bool in_map = partner && std::any_of(map.begin(), map.end(), [&](const auto& other) {
                          return other.id == *partner;
                        });
    if (in_map && bestPartner(*partner) == record.id) record.pair_id = partner;
  }
}

}  // namespace colonnade
