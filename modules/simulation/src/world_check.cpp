// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/world_check.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/simulation/building.hpp"
#include "colonnade/simulation/drive.hpp"

namespace colonnade {
namespace {

constexpr double kCellM = 0.05;
constexpr double kMarginM = 1.0;
constexpr double kRateHz = 20.0;
constexpr double kMeetsM = 1e-3;   ///< a wall's end this near to another wall meets it
constexpr double kCrackM = 0.10;   ///< an end this near was meant to
constexpr double kPersonM = 0.25;  ///< radius

double distance(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d d = b - a;
  const double t = std::clamp((p - a).dot(d) / std::max(d.squaredNorm(), 1e-12), 0.0, 1.0);
  return (p - a - t * d).norm();
}

/// 0 inside a solid obstacle.
double distance(const Eigen::Vector2d& p, const Obstacle& obstacle) {
  const auto& outline = obstacle.outline;
  double nearest = 1e9;
  bool inside = obstacle.solid;
  for (std::size_t i = 0; i + (obstacle.solid ? 0 : 1) < outline.size(); ++i) {
    const Eigen::Vector2d& a = outline[i];
    const Eigen::Vector2d& b = outline[(i + 1) % outline.size()];
    nearest = std::min(nearest, distance(p, a, b));
    // Solid outlines are convex and clockwise: their inside is on the right of every side.
    inside = inside && (b - a).x() * (p - a).y() - (b - a).y() * (p - a).x() <= 0.0;
  }
  return inside ? 0.0 : nearest;
}

std::string placeText(const Eigen::Vector2d& p) {
  return formatFixed(p.x(), 2) + " " + formatFixed(p.y(), 2);
}

[[noreturn]] void fail(const std::string& where, const std::string& what) {
  throw Error(where + ": " + what, ExitCode::kUsage);
}

/// The end of a wall that no other wall meets.
struct LooseEnd {
  const Wall* wall = nullptr;
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  double gap_m = 1e9;  ///< to the nearest other wall
  const Wall* nearest = nullptr;
};

std::vector<LooseEnd> looseEnds(const std::vector<Wall>& walls) {
  std::vector<LooseEnd> ends;
  for (const auto& wall : walls) {
    for (const auto& p : {wall.a, wall.b}) {
      LooseEnd end{&wall, p};
      for (const auto& other : walls) {
        if (&other == &wall) continue;
        const double gap = distance(p, other.a, other.b);
        if (gap < end.gap_m) end.gap_m = gap, end.nearest = &other;
      }
      if (end.gap_m > kMeetsM) ends.push_back(end);
    }
  }
  return ends;
}

[[noreturn]] void failAt(const LooseEnd& end) {
  fail(end.wall->where,
       "wall " + end.wall->name + " ends in the open at " + placeText(end.p) +
           (end.nearest ? ", " + formatFixed(end.gap_m, 2) + " m from wall " + end.nearest->name
                        : "") +
           ": the walls do not close around the robot; let another wall begin "
           "or end there");
}

/// Floods the floor from the robot's places over a grid in which everything that stands is drawn.
class Enclosure {
 public:
  explicit Enclosure(const Building& building)
      : origin_(building.low - Eigen::Vector2d::Constant(kMarginM)) {
    const Eigen::Vector2d size =
        (building.high + Eigen::Vector2d::Constant(kMarginM) - origin_) / kCellM;
    cells_ = cv::Mat(static_cast<int>(std::ceil(size.y())), static_cast<int>(std::ceil(size.x())),
                     CV_8UC1, cv::Scalar(kUnknown));
    for (const auto* lines : {&building.outline, &building.gaps}) {
      for (const auto& line : *lines) {
        cv::line(cells_, cell(line.a), cell(line.b), cv::Scalar(kWall), 1, cv::LINE_8);
      }
    }
  }

  /// Does everything that can be reached from p stay within the walls?
  bool holds(const Eigen::Vector2d& p) {
    const cv::Point start = cell(p);
    if (!cv::Rect({0, 0}, cells_.size()).contains(start)) return false;
    const auto there = cells_.at<unsigned char>(start);
    if (there == kWall || there == kReached) return true;
    cv::floodFill(cells_, start, cv::Scalar(kReached), nullptr, cv::Scalar(), cv::Scalar(), 4);
    return cells_.at<unsigned char>(0, 0) != kReached;
  }

  bool reached(const Eigen::Vector2d& p) const {
    const cv::Point c = cell(p);
    const cv::Rect around = cv::Rect(c.x - 2, c.y - 2, 5, 5) & cv::Rect({0, 0}, cells_.size());
    return cv::countNonZero(cells_(around) == kReached) > 0;
  }

 private:
  static constexpr int kWall = 0, kReached = 1, kUnknown = 2;

  cv::Point cell(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d q = (p - origin_) / kCellM;
    return {static_cast<int>(std::floor(q.x())), static_cast<int>(std::floor(q.y()))};
  }

  Eigen::Vector2d origin_;
  cv::Mat cells_;
};

void checkEnclosure(const World& world, const Building& building,
                    const std::vector<RoutePose>& poses) {
  const auto ends = looseEnds(world.walls);
  for (const auto& end : ends) {
    if (end.gap_m < kCrackM) failAt(end);
  }
  Enclosure enclosure(building);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const RoutePose& at = poses[i];
    if (enclosure.holds(at.pose.translation())) continue;
    for (const auto& end : ends) {
      if (enclosure.reached(end.p)) failAt(end);
    }
    fail(i == 0 ? world.route.where : world.route.steps[at.step].where,
         "the robot is outside of the building at " + placeText(at.pose.translation()) +
             "; move its route inside");
  }
}

void checkCollisions(const World& world, const Building& building,
                     const std::vector<RoutePose>& poses) {
  const double radius = world.route.robot_radius_m;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector2d p = poses[i].pose.translation();
    const std::string& where = i == 0 ? world.route.where : world.route.steps[poses[i].step].where;
    for (const auto& obstacle : building.obstacles) {
      if (distance(p, obstacle) >= std::max(radius, 1e-6)) continue;
      fail(where, "the robot, of radius " + formatFixed(radius, 2) + " m, runs into " +
                      obstacle.name + " at " + placeText(p) + "; move its route or that");
    }
    const double time_s = static_cast<double>(i) / kRateHz;
    for (const auto& walker : world.walkers) {
      if ((walker.poseAt(time_s).translation() - p).norm() >= radius + kPersonM) continue;
      fail(walker.where, "this person walks into the robot at " + placeText(p) + " after " +
                             formatFixed(time_s, 1) + " s; change phase_s or the way");
    }
  }
}

}  // namespace

void checkWorld(const World& world) {
  const Building building = buildBuilding(world);
  const auto poses = driveSteps(world.route, kRateHz);
  checkCollisions(world, building, poses);
  checkEnclosure(world, building, poses);
}

}  // namespace colonnade
