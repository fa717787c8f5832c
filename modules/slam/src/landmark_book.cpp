// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/landmark_book.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "colonnade/base/angle.hpp"

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

/// The normal of a floor edge points away from where it was first seen.
bool isSeenFromOtherSide(const Block& block, const Detection& detection, const EkfSlam& filter) {
  if (block.block_kind != BlockKind::kFloorLine) return false;
  const double normal = filter.state().values(block)(2) - filter.pose().phi;
  return std::abs(wrapAngle(detection.measurement.z(0) - normal)) > 0.5 * kPi;
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
  page.looks.observe(fromFirstSide(block, detection, filter));
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

LandmarkLooks LandmarkBook::looksInAxesOf(LandmarkId like, LandmarkId of,
                                          const State& state) const {
  const LandmarkLooks& looks = pages_.at(of).looks;
  const Block* a = state.find(like);
  const Block* b = state.find(of);
  const bool opposite = a && b && a->block_kind == BlockKind::kFloorLine &&
                        b->block_kind == BlockKind::kFloorLine &&
                        std::cos(state.values(*a)(2) - state.values(*b)(2)) < 0.0;
  return opposite ? looks.fromOtherSide() : looks;
}

bool LandmarkBook::lookAlike(LandmarkId a, LandmarkId b, const State& state) const {
  const auto one = pages_.find(a);
  if (one == pages_.end() || !pages_.contains(b)) return true;
  return one->second.looks.sameDarkSide(looksInAxesOf(a, b, state));
}

std::optional<double> LandmarkBook::colourDistance(LandmarkId a, LandmarkId b,
                                                   const State& state) const {
  const auto one = pages_.find(a), other = pages_.find(b);
  if (one == pages_.end() || other == pages_.end() || one->second.looks.sightings() == 0 ||
      other->second.looks.sightings() == 0)
    return std::nullopt;
  return one->second.looks.colourDistance(looksInAxesOf(a, b, state));
}

void LandmarkBook::merge(LandmarkId kept, LandmarkId twin, const State& state) {
  const auto from = pages_.find(twin);
  if (from == pages_.end()) return;
  const Page other = from->second;
  Page& page = pages_[kept];
  page.looks.merge(looksInAxesOf(kept, twin, state));
  if (other.first_m - page.last_m > kLongWay_m)
    page.returned_m = other.first_m;
  else if (other.returned_m)
    page.returned_m = std::max(page.returned_m.value_or(0.0), *other.returned_m);
  page.first_m = std::min(page.first_m, other.first_m);
  page.last_m = std::max(page.last_m, other.last_m);
  page.asleep = page.asleep && other.asleep;
  page.estranged = page.estranged && other.estranged;
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

bool LandmarkBook::looksLike(const Block& landmark, const Detection& detection,
                             const EkfSlam& filter) const {
  const auto page = pages_.find(landmark.id);
  if (page == pages_.end()) return true;
  const LandmarkLooks& looks = page->second.looks;
  if (detection.kind() == LandmarkKind::kPillarEdge) return looks.sameDarkSide(detection);
  if (!looks.agreesOnJoint(detection)) return false;
  return !isSeenFromOtherSide(landmark, detection, filter) || !looks.hasDarkSide() ||
         looks.sameDarkSide(fromFirstSide(landmark, detection, filter));
}

Detection LandmarkBook::fromFirstSide(const Block& landmark, const Detection& detection,
                                      const EkfSlam& filter) {
  Detection seen = detection;
  if (!isSeenFromOtherSide(landmark, detection, filter)) return seen;
  seen.appearance.gradient_sign *= -1;
  std::swap(seen.appearance.left, seen.appearance.right);
  return seen;
}

bool LandmarkBook::isJoint(LandmarkId landmark) const {
  const LandmarkLooks* known = looks(landmark);
  return known && known->isJoint();
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
