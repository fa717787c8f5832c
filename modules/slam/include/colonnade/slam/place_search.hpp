// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "colonnade/slam/event.hpp"
#include "colonnade/slam/place_finder.hpp"
#include "colonnade/slam/resumption.hpp"

namespace colonnade {

/// A robot somewhere in a map, which maps on its own, in a world of its own that starts with it,
/// until it knows where it is.
class PlaceSearch {
 public:
  explicit PlaceSearch(Resumption anywhere);

  /// Whether a look is worth it: some way after the last one, or with more landmarks.
  bool isDue(std::size_t landmarks, double way_m);
  /// Looks for the place. here: marks of the drive's own map; own: its state. Once the place is
  /// believed: the map, and where in it the drive's own world starts, as well as both maps tell.
  std::optional<Resumption> look(std::vector<PlaceMark> here, const State& own);
  const FoundPlace& last() const { return last_; }
  const PlaceOptions& options() const { return *anywhere_->anywhere; }
  /// The event `place found`.
  Event found(double stamp_s, std::size_t frame) const;

 private:
  Resumption startIn(const std::vector<PlaceMark>& here, const State& own) const;

  std::shared_ptr<const Resumption> anywhere_;
  std::vector<PlaceMark> map_;
  FoundPlace last_;
  double looked_m_ = 0.0;
  std::size_t looked_at_ = 0;  ///< landmarks
  int confirmed_ = 0;
};

/// What of a map has a place and `use` takes.
std::vector<PlaceMark> placeMarks(const State& state, const std::function<bool(const Block&)>& use,
                                  const std::function<std::optional<int>(LandmarkId)>& identity,
                                  const std::function<const LandmarkLooks*(LandmarkId)>& looks);

}  // namespace colonnade
