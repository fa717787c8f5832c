// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/drive_record.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <map>

#include "range_bearing_world.hpp"

namespace colonnade {
namespace {

std::vector<WorldAnchor> anchorsOf(const std::vector<Eigen::Vector2d>& points,
                                   const std::vector<double>& weights) {
  std::vector<WorldAnchor> anchors;
  for (std::size_t i = 0; i < points.size(); ++i) anchors.push_back({points[i], weights[i]});
  return anchors;
}

/// Of more landmarks the information is too much to smooth with.
constexpr std::size_t kMostOfMap = 500;

Eigen::MatrixXd inverseOf(const Eigen::LLT<Eigen::MatrixXd>& P) {
  return P.solve(Eigen::MatrixXd::Identity(P.rows(), P.cols()));
}

/// The covariance of a place that has nothing in common with the others.
void standAlone(Eigen::MatrixXd& C, std::size_t i, const Eigen::Matrix2d& covariance) {
  const auto row = static_cast<Eigen::Index>(2 * i);
  C.middleRows<2>(row).setZero();
  C.middleCols<2>(row).setZero();
  C.block<2, 2>(row, row) = covariance;
}

/// What a loaded map says beforehand. Smoothed with are those of its landmarks the drive saw; the
/// others follow by what they have in common with them.
class KnownMap {
 public:
  KnownMap(const Resumption& from, const LandmarkMap& now, const std::vector<bool>& seen)
      : from_(from) {
    for (std::size_t i = 0; i < now.size(); ++i) {
      const Block* block = from.map.state.find(now[i].id);
      if (!block) {
        kept_.push_back(i);  // ids ascend: from here on they are new
      } else if (block->block_kind != BlockKind::kPoint) {
        usable_ = false;
      } else {
        (seen[i] ? kept_ : unseen_).push_back(i);
        auto& rows = seen[i] ? seen_rows_ : unseen_rows_;
        rows.insert(rows.end(), {block->offset, block->offset + 1});
      }
    }
    P_seen_ = from.map.state.P(seen_rows_, seen_rows_);
    seen_llt_.compute(P_seen_);
    usable_ = usable_ && seen_rows_.size() <= 2 * kMostOfMap && seen_llt_.info() == Eigen::Success;
  }

  bool isUsable() const { return usable_; }
  /// Indices of the map: seen ones first, then the new ones.
  const std::vector<std::size_t>& kept() const { return kept_; }

  /// Of the pose after the first motion, and of the landmarks seen.
  Drive::Prior prior(const Drive::Motion& first) const {
    Drive::Prior prior;
    Eigen::Matrix3d J_start, J_motion;
    prior.T_world_start = compose(from_.T_world_robot, first.T_previous_robot, &J_start, &J_motion);
    const Eigen::Matrix3d P = J_start * from_.covariance * J_start.transpose() +
                              J_motion * first.covariance * J_motion.transpose();
    prior.information_start = P.inverse();
    const Eigen::VectorXd x = from_.map.state.x(seen_rows_);
    for (Eigen::Index i = 0; i < x.size(); i += 2) prior.points_world.emplace_back(x.segment<2>(i));
    prior.information_points = inverseOf(seen_llt_);
    return prior;
  }

  /// All places and their covariance (none: empty), from those kept. A new landmark none of whose
  /// readings was `used` stays as it is.
  void spread(const std::vector<Eigen::Vector2d>& points_kept, const Eigen::MatrixXd& C_kept,
              const std::vector<double>& used, LandmarkMap& map, Eigen::MatrixXd& C) const {
    const auto seen = static_cast<Eigen::Index>(seen_rows_.size());
    Eigen::VectorXd moved = -from_.map.state.x(seen_rows_);
    for (Eigen::Index i = 0; i < seen; i += 2)
      moved.segment<2>(i) += points_kept[static_cast<std::size_t>(i / 2)];
    Eigen::MatrixXd gain(static_cast<Eigen::Index>(unseen_rows_.size()), seen);
    Eigen::VectorXd unseen;
    if (!unseen_.empty()) {
      const Eigen::MatrixXd P_cross = from_.map.state.P(unseen_rows_, seen_rows_);
      gain = seen_llt_.solve(P_cross.transpose()).transpose();
      unseen = from_.map.state.x(unseen_rows_) + gain * moved;
    }
    const auto put = [&](std::size_t i, const Eigen::Vector2d& p) {
      map[i].p_world = map[i].extent_a = map[i].extent_b = p;
    };
    const auto stays = [&](std::size_t k) { return 2 * k >= seen_rows_.size() && used[k] == 0.0; };
    for (std::size_t k = 0; k < kept_.size(); ++k)
      if (!stays(k)) put(kept_[k], points_kept[k]);
    for (std::size_t k = 0; k < unseen_.size(); ++k)
      put(unseen_[k], unseen.segment<2>(static_cast<Eigen::Index>(2 * k)));
    if (C_kept.size() == 0 || map.size() > kMostOfMap) return;
    const auto rows = [](const std::vector<std::size_t>& indices) {
      std::vector<Eigen::Index> rows;
      for (const std::size_t i : indices)
        rows.insert(rows.end(),
                    {static_cast<Eigen::Index>(2 * i), static_cast<Eigen::Index>(2 * i + 1)});
      return rows;
    };
    const auto at_kept = rows(kept_), at_unseen = rows(unseen_);
    const auto size = static_cast<Eigen::Index>(2 * map.size());
    C.resize(size, size);
    const Eigen::MatrixXd C_cross = gain * C_kept.topRows(seen);
    C(at_kept, at_kept) = C_kept;
    if (!unseen_.empty()) {
      C(at_unseen, at_kept) = C_cross;
      C(at_kept, at_unseen) = C_cross.transpose();
      C(at_unseen, at_unseen) =
          from_.map.state.P(unseen_rows_, unseen_rows_) +
          gain * (C_kept.topLeftCorner(seen, seen) - P_seen_) * gain.transpose();
    }
    C = (0.5 * (C + C.transpose())).eval();
    for (std::size_t k = 0; k < kept_.size(); ++k)
      if (stays(k)) standAlone(C, kept_[k], map[kept_[k]].covariance);
    for (std::size_t i = 0; i < map.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(2 * i);
      map[i].covariance = C.block<2, 2>(row, row);
    }
  }

 private:
  const Resumption& from_;
  std::vector<std::size_t> kept_, unseen_;
  std::vector<Eigen::Index> seen_rows_, unseen_rows_;  ///< of the loaded state
  Eigen::MatrixXd P_seen_;
  Eigen::LLT<Eigen::MatrixXd> seen_llt_;
  bool usable_ = true;
};

/// The same drive past fewer points, in this order; all of its sightings are of them.
void keepPoints(Drive& drive, const std::vector<std::size_t>& kept) {
  std::vector<std::size_t> place(drive.points_world.size(), 0);
  std::vector<Eigen::Vector2d> points;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    place[kept[k]] = k;
    points.push_back(drive.points_world[kept[k]]);
  }
  for (Drive::Sighting& sighting : drive.sightings) sighting.point = place[sighting.point];
  drive.points_world = std::move(points);
}

}  // namespace

void DriveRecord::add(double stamp_s, const RangeBearingScan& scan,
                      const RangeBearingReport& report, const Pose2& T_world_robot) {
  for (std::size_t i = 0; i < scan.readings.size(); ++i)
    readings_.push_back({stamps_s_.size(), scan.readings[i].id, report.measurements[i]});
  stamps_s_.push_back(stamp_s);
  T_world_robot_.push_back(T_world_robot);
  motions_.push_back({report.T_previous_robot, report.motion_covariance});
}

std::optional<DriveRecord::Smoothed> DriveRecord::smoothed(
    const RangeBearingEstimator& estimator, const RangeBearingOptions& options,
    const std::optional<Resumption>& from) const {
  if (T_world_robot_.empty()) return std::nullopt;
  Smoothed result;
  result.map = estimator.map();
  Drive drive{T_world_robot_, motions_, {}, {}};
  std::map<LandmarkId, std::size_t> point_of_landmark;
  std::map<int, std::size_t> point_of_identity;
  for (const LandmarkRecord& landmark : result.map) {
    const std::size_t point = drive.points_world.size();
    point_of_landmark[landmark.id] = point;
    if (const auto identity = estimator.identityOf(landmark.id))
      point_of_identity[*identity] = point;
    drive.points_world.push_back(landmark.p_world);
  }
  const auto decisions = estimator.decisions();
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    const Reading& reading = readings_[i];
    if (!reading.measurement) continue;
    std::optional<std::size_t> point;
    const auto bearer = point_of_identity.find(reading.identity);
    if (options.use_ids && reading.identity >= 0 && bearer != point_of_identity.end()) {
      point = bearer->second;
    } else if (decisions[i]) {
      const auto landmark = point_of_landmark.find(*decisions[i]);
      if (landmark != point_of_landmark.end()) point = landmark->second;
    }
    if (!point) continue;
    drive.sightings.push_back({reading.frame, *point, *reading.measurement});
  }

  std::vector<bool> seen(drive.points_world.size(), false);
  for (const Drive::Sighting& sighting : drive.sightings) seen[sighting.point] = true;
  std::optional<KnownMap> known;
  if (from) {
    known.emplace(*from, result.map, seen);
    if (!known->isUsable()) return std::nullopt;
    keepPoints(drive, known->kept());
    drive.prior = known->prior(motions_.front());
  }
  const auto before = drive.points_world;
  result.how = smooth(drive, options.known_gate_probability);
  if (!std::isfinite(result.how.cost) || 2 * result.how.unused >= drive.sightings.size())
    return std::nullopt;

  std::vector<double> used(drive.points_world.size(), 0.0);
  for (const Drive::Sighting& sighting : drive.sightings)
    if (sighting.used) used[sighting.point] += 1.0;
  Pose2 T_map_start;
  if (options.world_with_map && !from)
    T_map_start =
        motionOfMap(anchorsOf(before, used), anchorsOf(drive.points_world, used)).value_or(Pose2{});
  for (std::size_t k = 0; k < stamps_s_.size(); ++k)
    result.trajectory.push_back(
        {stamps_s_[k], (T_map_start * drive.T_world_robot[k]).toIsometry3()});
  if (known) {
    if (!from->localize)
      known->spread(drive.points_world, result.how.covariance, used, result.map, result.covariance);
    return result;
  }
  const Eigen::Matrix2d R = T_map_start.rotation();
  result.covariance = result.how.covariance;
  for (Eigen::Index i = 0; i < result.covariance.rows(); i += 2) {
    result.covariance.middleRows<2>(i) = (R * result.covariance.middleRows<2>(i)).eval();
    result.covariance.middleCols<2>(i) =
        (result.covariance.middleCols<2>(i) * R.transpose()).eval();
  }
  result.covariance = (0.5 * (result.covariance + result.covariance.transpose())).eval();
  for (std::size_t i = 0; i < result.map.size(); ++i) {
    LandmarkRecord& landmark = result.map[i];
    const auto row = static_cast<Eigen::Index>(2 * i);
    if (used[i] > 0.0) {
      landmark.p_world = transform(T_map_start, drive.points_world[i]);
      landmark.extent_a = landmark.extent_b = landmark.p_world;
    }
    if (result.covariance.size() == 0) continue;
    if (used[i] > 0.0) {
      landmark.covariance = result.covariance.block<2, 2>(row, row);
      continue;
    }
    standAlone(result.covariance, i, landmark.covariance);
  }
  return result;
}

}  // namespace colonnade
