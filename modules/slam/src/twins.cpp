// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/twins.hpp"

#include <algorithm>
#include <cmath>

#include "colonnade/base/angle.hpp"

namespace colonnade {
namespace {

Eigen::Vector2d unit(double angle) { return {std::cos(angle), std::sin(angle)}; }
Eigen::Vector2d turned(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }

struct Place {
  Eigen::Vector2d p;
  Eigen::MatrixXd J;
};

Place placeOf(const State& state, const Block& block) {
  const BlockVector y = state.values(block);
  if (block.block_kind == BlockKind::kPoint) return {y, Eigen::Matrix2d::Identity()};
  Eigen::Matrix<double, 2, 4> J;
  const Eigen::Vector2d p = pointOf(y, &J);
  return {p, J};
}

bool hasPlace(const State& state, const Block& block) {
  return block.isLandmark() &&
         (block.block_kind != BlockKind::kInverseDepth || state.x(block.offset + 3) > 1e-3);
}

void differPoints(const State& state, const Block& kept, const Block& twin, TwinDifference& d) {
  const Place a = placeOf(state, kept), b = placeOf(state, twin);
  d.difference = b.p - a.p;
  d.H_kept = -a.J;
  d.H_twin = b.J;
  d.J_drift << Eigen::Matrix2d::Identity(), turned(b.p - state.x.head<2>());
  d.p_kept = a.p;
}

/// The middle q of the twin's seen part against the kept line m . (p - anchor) = d.
void differLines(const State& state, const Block& kept, const Block& twin, TwinDifference& d) {
  const BlockVector k = state.values(kept), t = state.values(twin);
  const Eigen::Vector2d m_k = unit(k(2)), m_t = unit(t(2));
  const double along = 0.5 * (twin.evidence.along_min_m + twin.evidence.along_max_m);
  const Eigen::Vector2d q = t.head<2>() + t(3) * m_t + along * turned(m_t);
  const Eigen::Vector2d q_by_alpha = t(3) * turned(m_t) - along * m_t;
  const Eigen::Vector2d from_anchor = q - k.head<2>();
  d.difference << std::remainder(t(2) - k(2), kPi), m_k.dot(from_anchor) - k(3);
  d.H_kept.resize(2, 4);
  d.H_kept << 0.0, 0.0, -1.0, 0.0, -m_k.transpose(), turned(m_k).dot(from_anchor), -1.0;
  d.H_twin.resize(2, 4);
  d.H_twin << 0.0, 0.0, 1.0, 0.0, m_k.transpose(), m_k.dot(q_by_alpha), m_k.dot(m_t);
  d.J_drift << 0.0, 0.0, 1.0, m_k.transpose(), m_k.dot(turned(q - state.x.head<2>()));
  d.p_kept = q - d.difference(1) * m_k;
  d.is_line = true;
}

/// The seen part of a floor edge that was merged into another one.
void widen(const State& state, const Block& twin, const Block& kept, Evidence& evidence) {
  const BlockVector k = state.values(kept), t = state.values(twin);
  const Eigen::Vector2d m_k = unit(k(2)), m_t = unit(t(2));
  const Eigen::Vector2d foot_k = k.head<2>() + k(3) * m_k, foot_t = t.head<2>() + t(3) * m_t;
  for (const double along : {twin.evidence.along_min_m, twin.evidence.along_max_m}) {
    const double s = turned(m_k).dot(foot_t + along * turned(m_t) - foot_k);
    evidence.along_min_m = std::min(evidence.along_min_m, s);
    evidence.along_max_m = std::max(evidence.along_max_m, s);
  }
}

}  // namespace

std::optional<TwinDifference> differenceOf(const State& state, const Twins& twins) {
  const Block* kept = state.find(twins.kept);
  const Block* twin = state.find(twins.twin);
  if (!kept || !twin || kept == twin || !hasPlace(state, *kept) || !hasPlace(state, *twin))
    return std::nullopt;
  if (kept->landmark_kind != twin->landmark_kind) return std::nullopt;
  TwinDifference d;
  d.offset_kept = kept->offset;
  d.offset_twin = twin->offset;
  if (kept->block_kind == BlockKind::kFloorLine)
    differLines(state, *kept, *twin, d);
  else
    differPoints(state, *kept, *twin, d);
  return d;
}

SparseJacobian stacked(std::span<const TwinDifference> differences) {
  SparseJacobian H(static_cast<Eigen::Index>(2 * differences.size()));
  Eigen::Index row = 0;
  for (const TwinDifference& d : differences) {
    H.add(row, d.offset_kept, d.H_kept).add(row, d.offset_twin, d.H_twin);
    row += 2;
  }
  return H;
}

Eigen::Matrix2d TwinNoise::covariance(bool is_line) const {
  return Eigen::Vector2d(is_line ? direction * direction : place_m * place_m, place_m * place_m)
      .asDiagonal();
}

bool fuse(std::span<const Twins> twins, const TwinNoise& noise, EkfSlam& filter,
          LandmarkBook& book) {
  std::vector<TwinDifference> differences;
  for (const Twins& pair : twins) {
    const auto difference = differenceOf(filter.state(), pair);
    if (!difference) return false;
    differences.push_back(*difference);
  }
  const auto rows = static_cast<Eigen::Index>(2 * differences.size());
  Eigen::VectorXd nu(rows);
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(rows, rows);
  Eigen::Index row = 0;
  for (const TwinDifference& d : differences) {
    nu.segment<2>(row) = -d.difference;
    R.block<2, 2>(row, row) = noise.covariance(d.is_line);
    row += 2;
  }
  if (!filter.constrain(stacked(differences), nu, R)) return false;
  for (const Twins& pair : twins) {
    const Block kept = *filter.state().find(pair.kept), twin = *filter.state().find(pair.twin);
    Evidence& evidence = filter.evidence(pair.kept);
    if (kept.block_kind == BlockKind::kFloorLine) widen(filter.state(), twin, kept, evidence);
    evidence.observations += twin.evidence.observations;
    evidence.first_stamp_s = std::min(evidence.first_stamp_s, twin.evidence.first_stamp_s);
    evidence.last_stamp_s = std::max(evidence.last_stamp_s, twin.evidence.last_stamp_s);
    book.merge(pair.kept, pair.twin, filter.state());
    filter.remove(pair.twin);
  }
  return true;
}

}  // namespace colonnade
