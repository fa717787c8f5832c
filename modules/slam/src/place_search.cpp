// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/place_search.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

/// So many times the landmarks of the last look make a new one worth it, on the spot, too.
constexpr double kMore = 1.2;
constexpr std::size_t kMostMarks = 60;  ///< those nearest to the robot
/// Two looks in a row tell the same where the start is within this.
constexpr double kSameStart_m = 0.5;
constexpr double kSameHeading = radians(5.0);
/// Between two maps of one landmark, beside what both are unsure of.
constexpr double kMapNoise_m = 0.05;
constexpr int kSteps = 3;
constexpr double kCountedTwice = 4.0;

/// The covariance of the places of some marks, two rows for each.
Eigen::MatrixXd covarianceOf(const State& state, const std::vector<PlaceMark>& marks,
                             const std::vector<std::size_t>& which) {
  std::vector<Eigen::Index> rows;
  for (const std::size_t i : which) rows.insert(rows.end(), {marks[i].offset, marks[i].offset + 1});
  return state.P(rows, rows);
}

}  // namespace

std::vector<PlaceMark> placeMarks(const State& state, const std::function<bool(const Block&)>& use,
                                  const std::function<std::optional<int>(LandmarkId)>& identity,
                                  const std::function<const LandmarkLooks*(LandmarkId)>& looks) {
  std::vector<PlaceMark> marks;
  for (const Block& block : state.blocks)
    if (block.block_kind == BlockKind::kPoint && !block.evidence.hypothesis && use(block))
      marks.push_back({state.values(block), block.landmark_kind, identity(block.id),
                       looks(block.id), block.offset});
  return marks;
}

PlaceSearch::PlaceSearch(Resumption anywhere)
    : anywhere_(std::make_shared<const Resumption>(std::move(anywhere))) {
  const SavedMap& map = anywhere_->map;
  map_ = placeMarks(
      map.state, [](const Block&) { return true; },
      [&](LandmarkId id) {
        const auto named = map.identities.find(id);
        return named == map.identities.end() ? std::nullopt : std::optional(named->second);
      },
      [&](LandmarkId id) { return map.book.looks(id); });
}

bool PlaceSearch::isDue(std::size_t landmarks, double way_m) {
  const bool more = static_cast<double>(landmarks) > kMore * static_cast<double>(looked_at_);
  if (!more && way_m - looked_m_ < options().try_every_m) return false;
  looked_m_ = way_m;
  looked_at_ = landmarks;
  return true;
}

std::optional<Resumption> PlaceSearch::look(std::vector<PlaceMark> here, const State& own) {
  if (here.size() > kMostMarks) {
    const auto distance = [&](const PlaceMark& mark) {
      return std::tuple((mark.p - own.x.head<2>()).norm(), mark.p.x(), mark.p.y());
    };
    std::nth_element(here.begin(), here.begin() + kMostMarks, here.end(),
                     [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
    here.resize(kMostMarks);
  }
  const FoundPlace former = std::exchange(last_, findPlace(map_, here, options()));
  if (!last_.refusal.empty()) {
    confirmed_ = 0;
    return std::nullopt;
  }
  const Pose2 change = former.T_map_here.inverse() * last_.T_map_here;
  const bool same =
      change.translation().norm() < kSameStart_m && std::abs(change.phi) < kSameHeading;
  confirmed_ = confirmed_ > 0 && same ? confirmed_ + 1 : 1;
  if (confirmed_ < options().confirmations) {
    last_.refusal = "not confirmed";
    return std::nullopt;
  }
  return startIn(here, own);
}

/// The landmarks drifted together since the start: generalised least squares with the covariance of
/// all of them tells where the start is, and how well.
Resumption PlaceSearch::startIn(const std::vector<PlaceMark>& here, const State& own) const {
  std::vector<std::size_t> own_marks, map_marks;
  for (const auto& [a, b] : last_.pairs) {
    own_marks.push_back(a);
    map_marks.push_back(b);
  }
  const auto size = static_cast<Eigen::Index>(2 * last_.pairs.size());
  const Eigen::MatrixXd C_own = covarianceOf(own, here, own_marks);
  const Eigen::MatrixXd C_map = covarianceOf(anywhere_->map.state, map_, map_marks) +
                                kMapNoise_m * kMapNoise_m * Eigen::MatrixXd::Identity(size, size);
  Eigen::Vector3d T = last_.T_map_here.vector();
  Eigen::Matrix3d information;
  for (int step = 0; step < kSteps; ++step) {
    const Pose2 T_map_own{T(0), T(1), T(2)};
    Eigen::VectorXd residual(size);
    Eigen::MatrixXd J(size, 3), turned(size, size);
    turned.setZero();
    for (Eigen::Index row = 0; row < size; row += 2) {
      const auto& [a, b] = last_.pairs[static_cast<std::size_t>(row / 2)];
      Eigen::Matrix<double, 2, 3> J_pose;
      residual.segment<2>(row) = transform(T_map_own, here[a].p, &J_pose) - map_[b].p;
      J.middleRows<2>(row) = J_pose;
      turned.block<2, 2>(row, row) = T_map_own.rotation();
    }
    const Eigen::LLT<Eigen::MatrixXd> C(turned * C_own * turned.transpose() + C_map);
    information = J.transpose() * C.solve(J);
    T -= information.inverse() * (J.transpose() * C.solve(residual));
  }
  Resumption known = *anywhere_;
  known.anywhere.reset();
  known.T_world_robot = {T(0), T(1), wrapAngle(T(2))};
  // What told it is filtered again from there: counted twice, it may not say all it says.
  known.covariance = kCountedTwice * information.inverse() + MapStart{}.covariance;
  return known;
}

Event PlaceSearch::found(double stamp_s, std::size_t frame) const {
  return {stamp_s, frame, "place found", std::nullopt,
          std::to_string(last_.fits) + " of " + std::to_string(last_.of) + " places fit to " +
              formatFixed(last_.rms_m, 3) + " m; evidence " + formatFixed(last_.evidence, 1) +
              ", elsewhere " + formatFixed(last_.elsewhere, 1) +
              "; the drive is mapped again from its start"};
}

}  // namespace colonnade
