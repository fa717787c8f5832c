// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "known_map.hpp"

#include <Eigen/LU>

namespace colonnade {
namespace {

/// Of more landmarks the information is too much to smooth with.
constexpr std::size_t kMostOfMap = 500;

Eigen::MatrixXd inverseOf(const Eigen::LLT<Eigen::MatrixXd>& P) {
  return P.solve(Eigen::MatrixXd::Identity(P.rows(), P.cols()));
}

}  // namespace

void standAlone(Eigen::MatrixXd& C, std::size_t i, const Eigen::Matrix2d& covariance) {
  const auto row = static_cast<Eigen::Index>(2 * i);
  C.middleRows<2>(row).setZero();
  C.middleCols<2>(row).setZero();
  C.block<2, 2>(row, row) = covariance;
}

KnownMap::KnownMap(const Resumption& from, const LandmarkMap& now, const std::vector<bool>& seen)
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

Drive::Prior KnownMap::prior(const Drive::Motion& first) const {
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

void KnownMap::spread(const std::vector<Eigen::Vector2d>& points_kept,
                      const Eigen::MatrixXd& C_kept, const std::vector<double>& used,
                      LandmarkMap& map, Eigen::MatrixXd& C) const {
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

}  // namespace colonnade
