// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/floor_edge_detector.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "across_profile.hpp"
#include "colonnade/detectors/depth_noise.hpp"
#include "colonnade/detectors/levelled_camera.hpp"
#include "colour_sampling.hpp"
#include "depth_view.hpp"
#include "floor_line.hpp"

namespace colonnade {
namespace {

/// What depth sees where a wall would stand on the line.
struct WallVotes {
  int wall = 0;
  int nearer = 0;   ///< something stands before the line: it is above the floor
  int beyond = 0;   ///< the floor goes on
  int unknown = 0;  ///< within the reach of depth, but not measured
  int seen() const { return wall + nearer + beyond; }
};

WallVotes askDepth(const DepthView& depth, const LevelledCamera& camera, const FloorLine& line,
                   const FloorEdgeOptions& options, const GeometryOptions& geometry) {
  WallVotes votes;
  constexpr int kPlaces = 40;
  for (int i = 0; i <= kPlaces; ++i) {
    const Eigen::Vector2d p_robot =
        line.p_robot_a + (line.p_robot_b - line.p_robot_a) * i / kPlaces;
    const double distance_m = (p_robot - camera.centre().head<2>()).norm();
    const auto p_px = camera.project({p_robot.x(), p_robot.y(), options.wall_height_m});
    if (!p_px) continue;
    const auto point = depth.at(*p_px);
    if (!point) {
      if (distance_m < geometry.max_depth_m) ++votes.unknown;
      continue;
    }
    // A tilt error moves floor points by (D^2 + H^2) / H per radian.
    const double tilt_m =
        geometry.tilt_sigma * (distance_m * distance_m / camera.height() + camera.height());
    const double tolerance_m =
        options.wall_tolerance_m + 2.0 * kinectDepthSigma(point->depth_m) + tilt_m;
    // Where the floor would be seen there if it went on; the wall must be told from it.
    const double room_m = distance_m * options.wall_height_m /
                          std::max(camera.height() - options.wall_height_m, 1e-3);
    const double limit_m =
        camera.height() > options.wall_height_m ? std::min(tolerance_m, 0.5 * room_m) : tolerance_m;
    const double difference_m = point->range_m - distance_m;
    if (difference_m > limit_m) {
      ++votes.beyond;
    } else if (difference_m < -tolerance_m) {
      ++votes.nearer;
    } else {
      ++votes.wall;
    }
  }
  return votes;
}

std::string reasonToRefuse(const WallVotes& votes, const FloorLine& line, bool has_depth,
                           const FloorEdgeOptions& options) {
  constexpr int kEnough = 6;
  if (line.R(0, 0) > options.max_direction_sigma * options.max_direction_sigma ||
      line.R(1, 1) > options.max_distance_sigma_m * options.max_distance_sigma_m) {
    return "too uncertain";
  }
  if (!has_depth) return "";
  if (votes.seen() < kEnough) return votes.unknown >= kEnough ? "no depth to confirm it" : "";
  if (votes.wall >= options.min_wall_share * votes.seen()) return "";
  return votes.beyond >= votes.nearer ? "floor goes on behind it" : "above the floor";
}

bool isNearVertical(const LevelledCamera& camera, const RefinedLine& line, double tolerance) {
  const Eigen::Vector2d along = (line.at(line.end) - line.at(line.begin)).normalized();
  const Eigen::Vector2d down = camera.downDirection(line.at(0.5 * (line.begin + line.end)));
  return std::abs(along.dot(down)) > std::cos(tolerance);
}

Detection toDetection(const LevelledCamera& camera, const RefinedLine& line,
                      const FloorLine& floor_line) {
  Detection detection;
  detection.measurement.kind = LandmarkKind::kFloorEdge;
  detection.measurement.z = floor_line.z;
  detection.measurement.R = floor_line.R;
  detection.measurement.p_robot_camera = camera.centre().head<2>();
  detection.a_px = line.at(floor_line.begin);
  detection.b_px = line.at(floor_line.end);
  detection.p_robot_a = floor_line.p_robot_a;
  detection.p_robot_b = floor_line.p_robot_b;
  // The far side is the one away from the foot of the camera: up in the image.
  Eigen::Vector2d across =
      line.steep ? Eigen::Vector2d(1.0, -line.slope) : Eigen::Vector2d(-line.slope, 1.0);
  const Eigen::Vector2d middle = line.at(0.5 * (floor_line.begin + floor_line.end));
  const int far = across.dot(camera.downDirection(middle)) < 0.0 ? 1 : -1;
  detection.appearance.gradient_sign = far * line.gradient_sign;
  return detection;
}

void addColours(const Frame& frame, const RefinedLine& line, const FloorLine& floor_line,
                Detection& detection) {
  const BesideColours colours = coloursBeside(frame, line, floor_line.begin, floor_line.end);
  const bool far_is_behind = detection.appearance.gradient_sign == line.gradient_sign;
  detection.appearance.left = far_is_behind ? colours.before : colours.behind;
  detection.appearance.right = far_is_behind ? colours.behind : colours.before;
}

/// Whether the floor is the same on both sides: a joint or paint.
bool isJoint(const Frame& frame, const LevelledCamera& camera, RefinedLine line,
             const FloorLine& floor_line) {
  constexpr double kWidest_m = 0.03;
  const Eigen::Vector2d middle = 0.5 * (floor_line.p_robot_a + floor_line.p_robot_b);
  const Eigen::Vector2d normal(std::cos(floor_line.z[0]), std::sin(floor_line.z[0]));
  const Eigen::Vector2d beyond = middle + kWidest_m * normal;
  const auto a = camera.project({middle.x(), middle.y(), 0.0});
  const auto b = camera.project({beyond.x(), beyond.y(), 0.0});
  if (!a || !b) return false;
  const Eigen::Vector2d d = *b - *a;
  const double width_px = line.steep ? d.x() - line.slope * d.y() : d.y() - line.slope * d.x();
  line.begin = floor_line.begin;
  line.end = floor_line.end;
  return AcrossProfile(frame.gray, line)
      .isThinLine(std::max(3, 1 + static_cast<int>(std::abs(width_px))));
}

double length(const Detection& detection) {
  return (detection.p_robot_b - detection.p_robot_a).norm();
}

/// Largest distance of the ends of `a` from the line of `b`.
double apart(const Detection& a, const Detection& b) {
  const auto& z = b.measurement.z;
  const Eigen::Vector2d normal(std::cos(z[0]), std::sin(z[0]));
  const auto off = [&](const Eigen::Vector2d& p_robot) {
    return std::abs(normal.dot(p_robot - b.measurement.p_robot_camera) - z[1]);
  };
  return std::max(off(a.p_robot_a), off(a.p_robot_b));
}

/// Whether the middle of `a` lies before the line of `b`, which need not be quite parallel to it.
bool isNearer(const Detection& a, const Detection& b) {
  const auto& z = b.measurement.z;
  const Eigen::Vector2d middle = 0.5 * (a.p_robot_a + a.p_robot_b) - b.measurement.p_robot_camera;
  return std::cos(z[0]) * middle.x() + std::sin(z[0]) * middle.y() < z[1];
}

double overlap(const Detection& a, const Detection& b) {
  const Eigen::Vector2d along = (b.p_robot_b - b.p_robot_a).normalized();
  const double s = along.dot(a.p_robot_a - b.p_robot_a);
  const double t = along.dot(a.p_robot_b - b.p_robot_a);
  return std::min(std::max(s, t), length(b)) - std::max(std::min(s, t), 0.0);
}

/// Takes `other` into the extent of `kept`, along its line.
void extend(Detection& kept, const Detection& other) {
  const Eigen::Vector2d origin = kept.p_robot_a;
  const Eigen::Vector2d along = (kept.p_robot_b - kept.p_robot_a).normalized();
  double low = 0.0;
  double high = length(kept);
  for (const auto& p_robot : {other.p_robot_a, other.p_robot_b}) {
    low = std::min(low, along.dot(p_robot - origin));
    high = std::max(high, along.dot(p_robot - origin));
  }
  kept.p_robot_a = origin + low * along;
  kept.p_robot_b = origin + high * along;
}

/// Whether depth between two lines along each other shows the floor, so that the nearer one is a
/// joint or paint and the farther one the foot of the wall, or an upright surface, as of a skirting
/// board, whose foot is the nearer one. What is compared is how range grows from one to the other,
/// which no tilt error changes. Nothing where they are too close in the image or depth is missing.
std::optional<bool> isFloorBetween(const DepthView& depth, const LevelledCamera& camera,
                                   const Detection& near, const Detection& far) {
  constexpr int kPlaces = 20, kEnough = 6;
  constexpr double kNearestApart_px = 6.0;  // depth and colour edges are some pixels apart
  const Eigen::Vector2d& p_camera = far.measurement.p_robot_camera;
  const Eigen::Vector2d normal(std::cos(far.measurement.z[0]), std::sin(far.measurement.z[0]));
  const Eigen::Vector2d far_along = (far.p_robot_b - far.p_robot_a).normalized();
  std::vector<double> growth;  // as a share of what the floor's would be
  for (int i = 0; i <= kPlaces; ++i) {
    const Eigen::Vector2d to_near =
        near.p_robot_a + (near.p_robot_b - near.p_robot_a) * i / kPlaces - p_camera;
    const Eigen::Vector2d to_far = to_near * (far.measurement.z[1] / normal.dot(to_near));
    const double along = far_along.dot(p_camera + to_far - far.p_robot_a);
    const double deeper_m = to_far.norm() - to_near.norm();
    if (normal.dot(to_near) <= 0.0 || deeper_m <= 0.0 || along < 0.0 || along > length(far))
      continue;
    const auto pixelAt = [&](double share) {
      const Eigen::Vector2d p = p_camera + to_near + share * (to_far - to_near);
      return camera.project({p.x(), p.y(), 0.0});
    };
    const auto a = pixelAt(0.0), b = pixelAt(1.0), early = pixelAt(0.25), late = pixelAt(0.75);
    if (!a || !b || !early || !late || (*b - *a).norm() < kNearestApart_px) continue;
    const auto first = depth.at(*early), second = depth.at(*late);
    if (!first || !second) continue;
    growth.push_back((second->range_m - first->range_m) / (0.5 * deeper_m));
  }
  if (static_cast<int>(growth.size()) < kEnough) return std::nullopt;
  std::nth_element(growth.begin(), growth.begin() + growth.size() / 2, growth.end());
  return growth[growth.size() / 2] > 0.5;
}

/// One detection for each line: pieces of one line join the longest, and of parallel edges close
/// together (skirting boards) the nearest to the camera stays, where wall and floor touch, but for
/// joints of the floor along the wall.
Detections contactEdges(Detections found, const DepthView& depth, const LevelledCamera& camera,
                        const FloorEdgeOptions& options) {
  std::sort(found.begin(), found.end(), [](const Detection& a, const Detection& b) {
    return length(a) > length(b) ||
           (length(a) == length(b) && a.measurement.z[0] < b.measurement.z[0]);
  });
  constexpr double kSkirting_m = 0.1;
  constexpr double kOneLineUnlike_m = 0.02;  // of a joint and a foot
  Detections kept;
  for (auto& detection : found) {
    bool taken = false;
    for (auto& longer : kept) {
      if (!detection.accepted() || !longer.accepted()) continue;
      const double apart_m = apart(detection, longer);
      // An edge this high above the floor seems to lie so much farther out.
      const double skirting_m = longer.measurement.z[1] * kSkirting_m /
                                std::max(camera.height() - kSkirting_m, kSkirting_m);
      const bool alike = detection.on_surface == longer.on_surface;
      const double one_line_m =
          alike ? std::min(0.04 + 2.0 * std::sqrt(detection.measurement.R(1, 1)) / 3.0, 0.1)
                : kOneLineUnlike_m;
      const bool along = apart_m < options.parallel_m + skirting_m &&
                         overlap(detection, longer) > 0.5 * length(detection);
      const bool nearer = isNearer(detection, longer);
      const auto floor_between = along ? isFloorBetween(depth, camera, nearer ? detection : longer,
                                                        nearer ? longer : detection)
                                       : std::nullopt;
      if (floor_between.value_or(false)) {
        (nearer ? detection : longer).refusal = "floor goes on behind it";
      } else if (!floor_between && apart_m < one_line_m) {
        extend(longer, detection);
        taken = true;
      } else if (along && !alike) {
        // A joint before the foot of a wall leaves it what it is; behind it there is no floor.
        Detection& farther = nearer ? longer : detection;
        if (farther.on_surface) farther.refusal = "a nearer edge runs along it";
      } else if (along) {
        if (nearer && length(detection) > 0.5 * length(longer)) {
          longer.refusal = "a nearer edge runs along it";
        } else {
          detection.refusal = "a nearer edge runs along it";
        }
      }
      if (taken) break;
    }
    if (!taken) kept.push_back(std::move(detection));
  }
  return kept;
}

}  // namespace

Detections FloorEdgeDetector::detect(const Frame& frame, const EdgeLines& edges) const {
  return detect(frame, refineLines(frame.gray, edges, lines_));
}

Detections FloorEdgeDetector::detect(const Frame& frame, const RefinedLines& lines) const {
  if (frame.gray.empty()) return {};
  const LevelledCamera camera(frame);
  const DepthView depth(frame, camera);
  Detections found;
  for (const auto& line : lines) {
    if (isNearVertical(camera, line, options_.from_vertical)) continue;
    const auto floor_line = mapToFloor(camera, line, options_, geometry_);
    if (!floor_line) continue;
    Detection detection = toDetection(camera, line, *floor_line);
    if ((detection.b_px - detection.a_px).norm() < options_.min_length_px) continue;
    if (length(detection) < options_.min_length_m) continue;
    const WallVotes votes = askDepth(depth, camera, *floor_line, options_, geometry_);
    detection.refusal = reasonToRefuse(votes, *floor_line, !depth.empty(), options_);
    if (detection.accepted()) addColours(frame, line, *floor_line, detection);
    detection.on_surface =
        detection.accepted() && depth.empty() && isJoint(frame, camera, line, *floor_line);
    found.push_back(std::move(detection));
  }
  return contactEdges(std::move(found), depth, camera, options_);
}

}  // namespace colonnade
