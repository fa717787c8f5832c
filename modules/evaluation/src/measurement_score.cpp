// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/measurement_score.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

/// What an exact detector would have measured, if this may be the landmark measured.
struct Expected {
  Eigen::Vector2d z = Eigen::Vector2d::Zero();
  double cost = 0.0;
};

std::optional<Expected> expectedCorner(const Measurement& m, const LandmarkInView& there,
                                       const MeasurementScoreOptions& options) {
  const Eigen::Vector2d offset = there.p_robot_a - m.p_robot_camera;
  const Eigen::Vector2d seen = m.z[1] * Eigen::Vector2d(std::cos(m.z[0]), std::sin(m.z[0]));
  const double apart_m = (seen - offset).norm();
  if (apart_m > options.gate_m) return std::nullopt;
  return Expected{{std::atan2(offset.y(), offset.x()), offset.norm()}, apart_m};
}

/// Length that both extents share along the true line.
double sharedLength(const MeasuredLandmark& measured, const LandmarkInView& there) {
  const Eigen::Vector2d way = there.p_robot_b - there.p_robot_a;
  const double length = way.norm();
  const Eigen::Vector2d along = way / length;
  const double s = along.dot(measured.p_robot_a - there.p_robot_a);
  const double t = along.dot(measured.p_robot_b - there.p_robot_a);
  return std::min(std::max(s, t), length) - std::max(std::min(s, t), 0.0);
}

std::optional<Expected> expectedEdge(const MeasuredLandmark& measured, const LandmarkInView& there,
                                     const MeasurementScoreOptions& options) {
  const Measurement& m = measured.measurement;
  const Eigen::Vector2d way = there.p_robot_b - there.p_robot_a;
  if (way.norm() < 1e-6 || sharedLength(measured, there) <= 0.0) return std::nullopt;
  Eigen::Vector2d normal = Eigen::Vector2d(-way.y(), way.x()).normalized();
  double distance_m = normal.dot(there.p_robot_a - m.p_robot_camera);
  if (distance_m < 0.0) {
    normal = -normal;
    distance_m = -distance_m;
  }
  Expected expected{{std::atan2(normal.y(), normal.x()), distance_m}, 0.0};
  const double turn = std::abs(wrapAngle(m.z[0] - expected.z[0]));
  const double off_m = std::abs(m.z[1] - distance_m);
  if (turn > options.gate || off_m > options.gate_m) return std::nullopt;
  expected.cost = turn / options.gate + off_m / options.gate_m;
  return expected;
}

nlohmann::ordered_json orNull(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

std::optional<double> inDegrees(std::optional<double> angle) {
  if (angle) *angle = degrees(*angle);
  return angle;
}

}  // namespace

LandmarksInView landmarksInView(const LandmarkMap& landmarks, const Trajectory& truth,
                                const TrueImageLines& columns) {
  std::map<int, const LandmarkRecord*> by_id;
  for (const auto& record : landmarks) by_id[number(record.id)] = &record;
  LandmarksInView views;
  for (const auto& pose : truth) {
    const std::int64_t stamp = microseconds(pose.stamp_s);
    const auto lines = columns.find(stamp);
    if (lines == columns.end()) continue;
    const Pose2 T_robot_world = planarPart(pose.T_world_body).inverse();
    auto& view = views[stamp];
    for (const auto& line : lines->second) {
      const auto record = by_id.find(line.landmark);
      if (record == by_id.end() || record->second->kind != line.kind) continue;
      view.push_back({line.kind, transform(T_robot_world, record->second->extent_a),
                      transform(T_robot_world, record->second->extent_b)});
    }
  }
  return views;
}

void MeasurementScore::add(const std::vector<MeasuredLandmark>& measured,
                           const std::vector<LandmarkInView>& in_view) {
  for (const auto& one : measured) {
    const Measurement& m = one.measurement;
    if (m.kind == LandmarkKind::kPillarEdge) continue;
    const bool corner = m.kind == LandmarkKind::kDepthSlope;
    Kind& kind = kinds_[static_cast<std::size_t>(m.kind)];
    ++kind.measured;
    std::optional<Expected> best;
    for (const auto& there : in_view) {
      if (there.kind != m.kind) continue;
      const auto expected =
          corner ? expectedCorner(m, there, options_) : expectedEdge(one, there, options_);
      if (expected && (!best || expected->cost < best->cost)) best = expected;
    }
    if (!best) continue;
    ++kind.matched;
    Eigen::Vector2d error = m.z - best->z;
    error[0] = wrapAngle(error[0]);
    const double off_m = corner ? best->cost : error[1];
    kind.direction.add(error[0]);
    kind.place.add(off_m);
    if (best->z[1] >= options_.near_min_m && best->z[1] <= options_.near_max_m)
      kind.place_near.add(off_m);
    if (best->z[1] >= options_.far_min_m && best->z[1] <= options_.far_max_m)
      kind.place_far.add(off_m);
    const Eigen::Matrix2d R = m.R;
    kind.nees_sum += error.dot(R.ldlt().solve(error));
  }
}

std::optional<double> MeasurementScore::Sum::rms() const {
  if (count == 0) return std::nullopt;
  return std::sqrt(squares / static_cast<double>(count));
}
std::optional<double> MeasurementScore::Kind::precision() const {
  if (measured == 0) return std::nullopt;
  return static_cast<double>(matched) / static_cast<double>(measured);
}
std::optional<double> MeasurementScore::Kind::nees() const {
  if (matched == 0) return std::nullopt;
  return nees_sum / (2.0 * static_cast<double>(matched));
}

nlohmann::ordered_json toJson(const MeasurementScore& score) {
  nlohmann::ordered_json json;
  for (const auto kind : {LandmarkKind::kFloorEdge, LandmarkKind::kDepthSlope}) {
    const auto& k = score.of(kind);
    json[name(kind)] = {{"measured", k.measured},
                        {"precision", orNull(k.precision())},
                        {"direction_rms_deg", orNull(inDegrees(k.direction.rms()))},
                        {"place_rms_m", orNull(k.place.rms())},
                        {"place_rms_m_at_2m", orNull(k.place_near.rms())},
                        {"place_rms_m_at_3_7m", orNull(k.place_far.rms())},
                        {"nees", orNull(k.nees())}};
  }
  return json;
}

std::string toText(const MeasurementScore& score) {
  std::string text = "in metres against the true places\n";
  const auto orDash = [](const std::optional<double>& value, int decimals) {
    return value ? formatFixed(*value, decimals) : std::string("-");
  };
  for (const auto kind : {LandmarkKind::kFloorEdge, LandmarkKind::kDepthSlope}) {
    const auto& k = score.of(kind);
    std::string line = name(kind);
    line.resize(12, ' ');
    text += line + "precision " + orDash(k.precision(), 3) + " of " + std::to_string(k.measured) +
            ", direction " + orDash(inDegrees(k.direction.rms()), 2) + " deg rms, place " +
            orDash(k.place.rms(), 3) + " m rms, at 2 m " + orDash(k.place_near.rms(), 3) + " (" +
            std::to_string(k.place_near.count) + "), at 3.7 m " + orDash(k.place_far.rms(), 3) +
            " (" + std::to_string(k.place_far.count) + "), NEES " + orDash(k.nees(), 2) + "\n";
  }
  return text;
}

}  // namespace colonnade
