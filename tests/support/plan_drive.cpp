// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "plan_drive.hpp"

#include <algorithm>
#include <cmath>

#include "colonnade/simulation/drive.hpp"

namespace colonnade::testing {
namespace {

constexpr double kNear_m = 0.7;
constexpr double kPillarReach_m = 6.0;
constexpr double kRangeReach_m = 5.0;
constexpr double kCornerNear_m = 1.22;
constexpr double kCornerFar_m = 3.81;
constexpr double kFloorReach_m = 4.0;
constexpr double kShortestFloor_m = 0.8;
constexpr int kRays = 60;
constexpr double kVisualFloor_m = 0.001;  ///< of a visual increment, even at rest
constexpr double kVisualFloor = radians(0.02);

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double rangeSigma(double range_m) { return 0.008 + 0.0025 * range_m * range_m; }

}  // namespace

PlanDrive::PlanDrive(const World& world, std::uint64_t seed, const PlanSensor& sensor)
    : world_(world),
      sensor_(sensor),
      building_(buildBuilding(world)),
      poses_(driveRoute(world.route, world.camera.rate_hz)),
      odometry_(world.odometry, seed),
      random_(seed, "plan") {}

std::optional<Observation> PlanDrive::next() {
  if (next_ >= poses_.size()) return std::nullopt;
  Observation seen;
  seen.index = next_;
  seen.stamp_s = static_cast<double>(next_) / world_.camera.rate_hz;
  truth_ = poses_[next_];
  if (next_ > 0) {
    const auto moved = odometry_.measure(poses_[next_ - 1].inverse() * truth_);
    seen.motion = {moved.T_previous_robot, moved.covariance, MotionSource::kOdometry};
    if (sensor_.visual_share > 0.0) fuseVisual(poses_[next_ - 1].inverse() * truth_, seen.motion);
  }
  ++next_;
  const Eigen::Vector2d p_robot_camera(world_.camera.forward_m, world_.camera.left_m);
  p_camera_ = transform(truth_, p_robot_camera);
  seeEdges(seen);
  seeFloor(seen);
  seeClutter(seen);
  for (Detection& detection : seen.detections)
    detection.measurement.p_robot_camera = p_robot_camera;
  if (sensor_.depth) {
    seen.sight.p_robot_camera = p_robot_camera;
    look(seen);
  }
  return seen;
}

void PlanDrive::fuseVisual(const Pose2& moved, MotionIncrement& motion) {
  const double place = sensor_.visual_share * moved.translation().norm() + kVisualFloor_m;
  const double turn = sensor_.visual_share * std::abs(moved.phi) + kVisualFloor;
  const Eigen::Vector3d sigma(place, place, turn);
  Eigen::Vector3d value = moved.vector();
  for (int i = 0; i < 3; ++i) value[i] += sigma[i] * random_.normal();
  const Eigen::Matrix3d visual = sigma.cwiseAbs2().asDiagonal();
  const Eigen::Matrix3d gain = motion.covariance * (motion.covariance + visual).inverse();
  const Eigen::Vector3d fused =
      motion.T_previous_robot.vector() + gain * (value - motion.T_previous_robot.vector());
  motion.T_previous_robot = {fused.x(), fused.y(), wrapAngle(fused.z())};
  motion.covariance = ((Eigen::Matrix3d::Identity() - gain) * motion.covariance).eval();
  motion.covariance = (0.5 * (motion.covariance + motion.covariance.transpose())).eval();
}

void PlanDrive::removeEdgesNear(const Eigen::Vector2d& p_world, double radius_m) {
  // The order is the identity of noise and appearance: edges move away instead of leaving.
  for (VerticalEdge& edge : building_.edges)
    if ((edge.p_world - p_world).norm() < radius_m) edge.p_world.setConstant(1e6);
}

void PlanDrive::moveEdgesNear(const Eigen::Vector2d& p_world, double radius_m,
                              const Eigen::Vector2d& by_m) {
  for (VerticalEdge& edge : building_.edges)
    if ((edge.p_world - p_world).norm() < radius_m) edge.p_world += by_m;
}

/// Two standard normal errors of one thing that resemble those of the frame before.
Eigen::Vector2d PlanDrive::noise(int key, double stamp_s) {
  const bool is_new = !errors_.contains(key);
  Error& error = errors_[key];
  const double rho = is_new ? 0.0 : std::exp((error.stamp_s - stamp_s) / sensor_.error_memory_s);
  const double fresh = std::sqrt(1.0 - rho * rho);
  error.value = rho * error.value + fresh * Eigen::Vector2d(random_.normal(), random_.normal());
  error.stamp_s = stamp_s;
  return error.value;
}

double PlanDrive::firstSurface(const Eigen::Vector2d& from, double direction) const {
  const Eigen::Vector2d ray(std::cos(direction), std::sin(direction));
  double nearest = 1e3;
  for (const FloorLine& line : building_.outline) {
    const Eigen::Vector2d along = line.b - line.a;
    const double denominator = cross(ray, along);
    if (std::abs(denominator) < 1e-9) continue;
    const double range = cross(line.a - from, along) / denominator;
    const double s = cross(line.a - from, ray) / denominator;
    if (range > 1e-6 && s >= 0.0 && s <= 1.0) nearest = std::min(nearest, range);
  }
  return nearest;
}

void PlanDrive::seeEdges(Observation& seen) {
  const double half = 0.48 * world_.camera.field_of_view;
  for (std::size_t i = 0; i < building_.edges.size(); ++i) {
    const VerticalEdge& edge = building_.edges[i];
    const Eigen::Vector2d v = edge.p_world - p_camera_;
    const double range = v.norm(), direction = std::atan2(v.y(), v.x());
    const double bearing = wrapAngle(direction - truth_.phi);
    if (range < kNear_m || range > kPillarReach_m || std::abs(bearing) > half) continue;
    // Seen past either side: an edge is in view when the ray beside it reaches its distance.
    const double beside = 0.01 / range;
    if (std::max(firstSurface(p_camera_, direction + beside),
                 firstSurface(p_camera_, direction - beside)) < range - 0.05)
      continue;
    const int side = static_cast<int>(std::floor(direction / (kPi / 4.0)));
    const int key = static_cast<int>(i) * 64 + side + 16;
    const Eigen::Vector2d lasting =
        sensor_.landmark_bias_m *
        Eigen::Vector2d(latticeNoise(key, 0.5, 11), latticeNoise(key, 0.5, 12));
    const auto detect = [&](LandmarkKind kind, int channel, bool with_range) {
      const Eigen::Vector2d e = noise(key * 4 + channel, seen.stamp_s);
      Detection d;
      Measurement& m = d.measurement;
      m.kind = kind;
      const double bearing_sigma =
          std::hypot(sensor_.bearing_sigma, 0.5 * sensor_.landmark_bias_m / range);
      const double range_sigma = std::hypot(rangeSigma(range), 0.5 * sensor_.landmark_bias_m);
      const double z = bearing + sensor_.bearing_sigma * e(0) + lasting.x() / range;
      if (with_range) {
        m.z = Eigen::Vector2d(z, range + rangeSigma(range) * e(1) + lasting.y());
        m.R =
            Eigen::Vector2d(bearing_sigma * bearing_sigma, range_sigma * range_sigma).asDiagonal();
      } else {
        m.z = Eigen::VectorXd::Constant(1, z);
        m.R = Eigen::MatrixXd::Constant(1, 1, bearing_sigma * bearing_sigma);
      }
      if (kind == LandmarkKind::kPillarEdge)
        d.appearance.gradient_sign = cellNoise(static_cast<std::int64_t>(i), 7, 3) > 0.0 ? 1 : -1;
      seen.detections.push_back(d);
    };
    if (random_.uniform() < sensor_.pillar_share)
      detect(LandmarkKind::kPillarEdge, 0, sensor_.depth && range < kRangeReach_m);
    if (sensor_.depth && edge.slope && range > kCornerNear_m && range < kCornerFar_m &&
        random_.uniform() < sensor_.corner_share)
      detect(LandmarkKind::kDepthSlope, 1, true);
  }
}

void PlanDrive::seeFloor(Observation& seen) {
  const double half = 0.48 * world_.camera.field_of_view;
  for (std::size_t i = 0; i < building_.floor_lines.size(); ++i) {
    const FloorLine& line = building_.floor_lines[i];
    const Eigen::Vector2d along = (line.b - line.a).normalized();
    const double length = (line.b - line.a).norm();
    double first = 1e9, last = -1e9;
    for (double s = 0.05; s < length; s += 0.1) {
      const Eigen::Vector2d v = line.a + s * along - p_camera_;
      const double range = v.norm(), direction = std::atan2(v.y(), v.x());
      if (range > kFloorReach_m || std::abs(wrapAngle(direction - truth_.phi)) > half) continue;
      if (firstSurface(p_camera_, direction) < range - 0.05) continue;
      first = std::min(first, s);
      last = std::max(last, s);
    }
    if (last - first < kShortestFloor_m) continue;
    const Eigen::Vector2d a = line.a + first * along, b = line.a + last * along;
    const Eigen::Vector2d e = noise(1000000 + static_cast<int>(i), seen.stamp_s);
    Eigen::Vector2d normal(-along.y(), along.x());
    double distance = normal.dot(a - p_camera_);
    if (distance < 0.0) {
      normal = -normal;
      distance = -distance;
    }
    const double turn = sensor_.direction_sigma * e(0);
    if (random_.uniform() < sensor_.floor_share) {
      Detection d;
      d.measurement.kind = LandmarkKind::kFloorEdge;
      d.measurement.z =
          Eigen::Vector2d(wrapAngle(std::atan2(normal.y(), normal.x()) - truth_.phi + turn),
                          distance + sensor_.distance_sigma_m * e(1));
      d.measurement.R = Eigen::Vector2d(sensor_.direction_sigma, sensor_.distance_sigma_m)
                            .cwiseAbs2()
                            .asDiagonal();
      d.p_robot_a = transform(truth_.inverse(), a);
      d.p_robot_b = transform(truth_.inverse(), b);
      seen.detections.push_back(d);
    }
    if (sensor_.depth && random_.uniform() < sensor_.wall_share)
      seen.walls.push_back({wrapQuarterTurn(std::atan2(along.y(), along.x()) - truth_.phi + turn),
                            sensor_.direction_sigma, last - first, transform(truth_.inverse(), a),
                            transform(truth_.inverse(), b)});
  }
  std::stable_sort(seen.walls.begin(), seen.walls.end(),
                   [](const auto& a, const auto& b) { return a.length_m > b.length_m; });
}

void PlanDrive::seeClutter(Observation& seen) {
  if (random_.uniform() >= sensor_.clutter) return;
  Detection d;
  const double bearing = world_.camera.field_of_view * (random_.uniform() - 0.5);
  const double range = 1.0 + 4.0 * random_.uniform();
  d.measurement.kind = LandmarkKind::kPillarEdge;
  d.appearance.gradient_sign = random_.uniform() < 0.5 ? 1 : -1;
  if (sensor_.depth) {
    d.measurement.z = Eigen::Vector2d(bearing, range);
    d.measurement.R =
        Eigen::Vector2d(sensor_.bearing_sigma, rangeSigma(range)).cwiseAbs2().asDiagonal();
  } else {
    d.measurement.z = Eigen::VectorXd::Constant(1, bearing);
    d.measurement.R =
        Eigen::MatrixXd::Constant(1, 1, sensor_.bearing_sigma * sensor_.bearing_sigma);
  }
  seen.detections.push_back(d);
}

void PlanDrive::look(Observation& seen) const {
  for (int i = 0; i < kRays; ++i) {
    const double bearing = world_.camera.field_of_view * ((i + 0.5) / kRays - 0.5);
    const double range = firstSurface(p_camera_, truth_.phi + bearing);
    seen.sight.rays.push_back({bearing, range < 8.0 ? range : 0.0});
  }
}

}  // namespace colonnade::testing
