// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibration_fits.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace colonnade {
namespace {

struct Row {
  double x;
  double y;
};
using Rows = std::vector<Row>;

double rmsOf(double squares, std::size_t rows, std::size_t unknowns) {
  return std::sqrt(squares / static_cast<double>(rows - unknowns));
}

/// y = slope * x + offset.
std::optional<LinearFit> straight(const Rows& rows) {
  if (rows.size() < 3) return std::nullopt;
  const auto n = static_cast<double>(rows.size());
  double mean_x = 0.0, mean_y = 0.0;
  for (const Row& row : rows) {
    mean_x += row.x / n;
    mean_y += row.y / n;
  }
  double xx = 0.0, xy = 0.0;
  for (const Row& row : rows) {
    xx += (row.x - mean_x) * (row.x - mean_x);
    xy += (row.x - mean_x) * (row.y - mean_y);
  }
  if (xx <= 1e-12 * (1.0 + mean_x * mean_x)) return std::nullopt;
  LinearFit fit;
  fit.slope = xy / xx;
  fit.offset = mean_y - fit.slope * mean_x;
  double squares = 0.0;
  for (const Row& row : rows) squares += std::pow(row.y - fit.lateral(row.x), 2);
  fit.rms = rmsOf(squares, rows.size(), 2);
  return fit;
}

Rows distanceRows(const std::vector<PillarPlace>& places) {
  Rows rows;
  for (const PillarPlace& place : places)
    if (place.distance && place.delta_rho_px)
      rows.push_back({*place.distance, *place.delta_rho_px});
  return rows;
}

}  // namespace

double ExponentialFit::deltaRho(double distance) const {
  return at_zero_px * std::pow(10.0, -decades * distance);
}

double ExponentialFit::distance(double delta_rho_px) const {
  return -std::log10(delta_rho_px / at_zero_px) / decades;
}

std::optional<ExponentialFit> fitExponential(const std::vector<PillarPlace>& places) {
  const Rows rows = distanceRows(places);
  Rows logarithms;
  for (const Row& row : rows) logarithms.push_back({row.x, std::log10(row.y)});
  const auto start = straight(logarithms);
  if (!start) return std::nullopt;
  ExponentialFit fit{std::pow(10.0, start->offset), -start->slope};
  const auto squaresOf = [&](const ExponentialFit& f) {
    double squares = 0.0;
    for (const Row& row : rows) squares += std::pow(row.y - f.deltaRho(row.x), 2);
    return squares;
  };
  double squares = squaresOf(fit);
  // Gauss-Newton with halved steps; the logarithms give a start near the solution.
  for (int round = 0; round < 100; ++round) {
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (const Row& row : rows) {
      const double curve = fit.deltaRho(row.x);
      const Eigen::Vector2d j(curve / fit.at_zero_px, -std::log(10.0) * row.x * curve);
      normal += j * j.transpose();
      right += j * (row.y - curve);
    }
    Eigen::Vector2d step = normal.ldlt().solve(right);
    if (!step.allFinite()) break;
    bool better = false;
    for (int half = 0; half < 20 && !better; ++half, step *= 0.5) {
      const ExponentialFit next{fit.at_zero_px + step(0), fit.decades + step(1)};
      const double next_squares = squaresOf(next);
      if (!(next_squares < squares)) continue;
      better = squares - next_squares > 1e-14 * squares;
      squares = next_squares;
      fit = next;
      if (!better) half = 20;
    }
    if (!better) break;
  }
  fit.rms_px = rmsOf(squares, rows.size(), 2);
  return fit;
}

std::optional<PinholeFit> fitPinhole(const std::vector<PillarPlace>& places) {
  const Rows rows = distanceRows(places);
  if (rows.size() < 2) return std::nullopt;
  double xx = 0.0, xy = 0.0;
  for (const Row& row : rows) {
    xx += 1.0 / (row.x * row.x);
    xy += row.y / row.x;
  }
  PinholeFit fit{xy / xx};
  double squares = 0.0;
  for (const Row& row : rows) squares += std::pow(row.y - fit.deltaRho(row.x), 2);
  fit.rms_px = rmsOf(squares, rows.size(), 1);
  return fit;
}

std::optional<LinearFit> fitLinear(const std::vector<PillarPlace>& places) {
  Rows rows;
  for (const PillarPlace& place : places)
    if (place.lateral && place.left_rho_px) rows.push_back({*place.left_rho_px, *place.lateral});
  return straight(rows);
}

std::optional<ObliqueFit> fitOblique(const std::vector<PillarPlace>& places) {
  // lateral = b * distance - a * distance * left_rho, with a = 1 / focal, b = centre / focal.
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  std::vector<const PillarPlace*> rows;
  for (const PillarPlace& place : places) {
    if (!place.lateral || !place.left_rho_px || !place.distance) continue;
    const Eigen::Vector2d j(-*place.distance * *place.left_rho_px, *place.distance);
    normal += j * j.transpose();
    right += j * *place.lateral;
    rows.push_back(&place);
  }
  if (rows.size() < 3) return std::nullopt;
  const Eigen::Vector2d solution = normal.ldlt().solve(right);
  if (!solution.allFinite() || std::abs(normal.determinant()) <= 1e-12 * normal.squaredNorm() ||
      solution(0) <= 0.0)
    return std::nullopt;
  ObliqueFit fit{1.0 / solution(0), solution(1) / solution(0)};
  double squares = 0.0;
  for (const PillarPlace* row : rows)
    squares += std::pow(*row->lateral - fit.lateral(*row->left_rho_px, *row->distance), 2);
  fit.rms = rmsOf(squares, rows.size(), 2);
  return fit;
}

}  // namespace colonnade
