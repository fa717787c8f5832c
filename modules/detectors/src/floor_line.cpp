// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "floor_line.hpp"

#include <cmath>

namespace colonnade {
namespace {

/// Normal direction and distance of the floor line through two pixels, seen from the camera's foot.
std::optional<Eigen::Vector2d> normalForm(const LevelledCamera& camera, const Eigen::Vector2d& a_px,
                                          const Eigen::Vector2d& b_px) {
  const auto p_a = camera.floorPoint(a_px);
  const auto p_b = camera.floorPoint(b_px);
  if (!p_a || !p_b) return std::nullopt;
  const Eigen::Vector2d along = (*p_b - *p_a).normalized();
  Eigen::Vector2d normal(-along.y(), along.x());
  double distance = normal.dot(*p_a - camera.centre().head<2>());
  if (distance < 0.0) {
    normal = -normal;
    distance = -distance;
  }
  return Eigen::Vector2d(std::atan2(normal.y(), normal.x()), distance);
}

/// The ends of the line moved across it by so many pixels each.
struct Ends {
  Eigen::Vector2d a_px;
  Eigen::Vector2d b_px;
};
Ends movedEnds(const RefinedLine& line, double begin, double end, double at_begin, double at_end) {
  Ends ends{line.at(begin), line.at(end)};
  ends.a_px[line.steep ? 0 : 1] += at_begin;
  ends.b_px[line.steep ? 0 : 1] += at_end;
  return ends;
}

/// The longest stretch of the extent whose floor points are within reach.
bool clipToFloor(const LevelledCamera& camera, const RefinedLine& line, double reach_m,
                 FloorLine& result) {
  constexpr int kSteps = 96;
  int best_first = 0;
  int best_length = 0;
  int length = 0;
  const auto place = [&](int i) { return line.begin + (line.end - line.begin) * i / kSteps; };
  for (int i = 0; i <= kSteps; ++i) {
    const auto p_robot = camera.floorPoint(line.at(place(i)));
    const bool inside = p_robot && (*p_robot - camera.centre().head<2>()).norm() <= reach_m;
    length = inside ? length + 1 : 0;
    if (length > best_length) {
      best_length = length;
      best_first = i - length + 1;
    }
  }
  if (best_length < 2) return false;
  result.begin = place(best_first);
  result.end = place(best_first + best_length - 1);
  return true;
}

}  // namespace

std::optional<FloorLine> mapToFloor(const LevelledCamera& camera, const RefinedLine& line,
                                    const FloorEdgeOptions& options,
                                    const GeometryOptions& geometry) {
  FloorLine result;
  if (!clipToFloor(camera, line, options.max_distance_m, result)) return std::nullopt;
  const auto form = [&](const LevelledCamera& seen_by, double at_begin, double at_end) {
    const Ends ends = movedEnds(line, result.begin, result.end, at_begin, at_end);
    return normalForm(seen_by, ends.a_px, ends.b_px);
  };
  const auto z = form(camera, 0.0, 0.0);
  constexpr double kLeastDistance_m = 0.05;
  if (!z || z->y() < kLeastDistance_m) return std::nullopt;
  result.z = *z;
  result.p_robot_a = *camera.floorPoint(line.at(result.begin));
  result.p_robot_b = *camera.floorPoint(line.at(result.end));

  constexpr double kStep_px = 0.02;
  constexpr double kStep_rad = 1e-5;
  constexpr double kStep_m = 1e-4;
  const std::optional<Eigen::Vector2d> moved[5] = {
      form(camera, kStep_px, 0.0), form(camera, 0.0, kStep_px),
      form(camera.disturbed({kStep_rad, 0.0}, 0.0), 0.0, 0.0),
      form(camera.disturbed({0.0, kStep_rad}, 0.0), 0.0, 0.0),
      form(camera.disturbed({0.0, 0.0}, kStep_m), 0.0, 0.0)};
  const double steps[5] = {kStep_px, kStep_px, kStep_rad, kStep_rad, kStep_m};
  Eigen::Matrix<double, 2, 5> J;
  for (int i = 0; i < 5; ++i) {
    if (!moved[i]) return std::nullopt;
    J(0, i) = wrapAngle(moved[i]->x() - z->x()) / steps[i];
    J(1, i) = (moved[i]->y() - z->y()) / steps[i];
  }
  Eigen::Matrix2d fit;  // ends of the part used, as functions of (offset, slope)
  fit << 1.0, result.begin - line.middle, 1.0, result.end - line.middle;
  Eigen::Matrix<double, 5, 5> cause = Eigen::Matrix<double, 5, 5>::Zero();
  cause.topLeftCorner<2, 2>() = fit * line.covariance * fit.transpose();
  const double line_variance = geometry.line_sigma_px * geometry.line_sigma_px;
  const double tilt_variance = geometry.tilt_sigma * geometry.tilt_sigma;
  cause.diagonal() += (Eigen::Matrix<double, 5, 1>() << line_variance, line_variance, tilt_variance,
                       tilt_variance, geometry.height_sigma_m * geometry.height_sigma_m)
                          .finished();
  result.R = J * cause * J.transpose();
  return result;
}

}  // namespace colonnade
