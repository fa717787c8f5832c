// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/door_leaves.hpp"

#include <algorithm>
#include <cmath>

#include "colonnade/base/angle.hpp"
#include "colonnade/detectors/depth_noise.hpp"
#include "plane_fit.hpp"

namespace colonnade {
namespace {

constexpr double kStep_m = 0.05;
constexpr std::size_t kMostPlaces = 100;

}  // namespace

DoorLeaves::DoorLeaves(const DoorLeafOptions& options)
    : options_(options),
      slices_(options.max_way_m),
      places_(options.gate_m, options.max_way_m, kMostPlaces) {}

/// The surface that begins in the slice beside an edge, on its left (-1) or right (+1).
std::optional<DoorLeaves::Plate> DoorLeaves::plateBeside(const DepthProfile& profile,
                                                         const Eigen::Vector2d& p_robot, int side) {
  constexpr int kOutline_px = 3;        // depth at an outline is frayed
  constexpr double kAtEdge_m = 0.15;    // of the surface's end from the edge
  constexpr double kFitted_m = 0.5;     // of the surface, beside its end
  constexpr double kShortest_m = 0.12;  // whose direction means anything
  const Eigen::Vector2d p = profile.R_robot_slice.transpose() * (p_robot - profile.p_robot_camera);
  if (p.y() <= 0.0) return std::nullopt;
  const int columns = static_cast<int>(profile.columns.size());
  const int edge =
      static_cast<int>(std::lround(0.5 * (columns - 1) + profile.focal_px * p.x() / p.y()));
  std::vector<Eigen::Vector2d> points;
  for (int i = edge + side * kOutline_px; i >= 0 && i < columns; i += side) {
    const auto& column = profile.columns[static_cast<std::size_t>(i)];
    if (!column.valid()) continue;
    const Eigen::Vector2d next = column.point();
    const double noise_m = 3.0 * kinectDepthSigma(column.z);
    if (points.empty() ? (next - p).norm() > kAtEdge_m + noise_m
                       : (next - points.back()).norm() > 0.1 + noise_m)
      break;
    points.push_back(next);
    if ((next - points.front()).norm() > kFitted_m) break;
  }
  if (points.size() < 6 || (points.back() - points.front()).norm() < kShortest_m)
    return std::nullopt;
  const SliceLine line = fitSliceLine(points);
  if (line.rms_m > 0.01 + kinectDepthSigma(line.centre.y())) return std::nullopt;
  const Eigen::Vector2d forth = line.along.dot(points.back() - points.front()) > 0.0
                                    ? line.along
                                    : Eigen::Vector2d(-line.along);
  const Eigen::Vector2d end = line.centre + forth.dot(p - line.centre) * forth;
  const Eigen::Vector2d normal(-forth.y(), forth.x());
  const Eigen::Vector2d front = normal.dot(end) < 0.0 ? normal : Eigen::Vector2d(-normal);
  return Plate{profile.toRobot(end), profile.R_robot_slice * forth, profile.R_robot_slice * front};
}

/// No wall is there, nor close behind it: a frame that stands out from its wall ends too, but at
/// the wall.
bool DoorLeaves::isClear(const Plate& plate, double along_m) const {
  for (const double front_m : {0.0, 0.1, -0.1, -0.25})
    if (!slices_.isFree(plate.at(along_m, front_m))) return false;
  return true;
}

/// Is it a surface over a good part of the width of a leaf?
bool DoorLeaves::isPlate(const Plate& plate) const {
  constexpr int kSamples = 8, kLeast = 5;
  int seen = 0;
  for (int i = 1; i <= kSamples; ++i)
    seen += slices_.isSurface(plate.at(i * options_.min_width_m / kSamples, 0.0)) ? 1 : 0;
  return seen >= kLeast;
}

/// The wall that goes on across the plate, beyond an opening as wide as a leaf, of which most was
/// seen, between two places along the plate.
DoorLeaves::WallAcross DoorLeaves::wallAcross(const Plate& plate, double from_m,
                                              double to_m) const {
  constexpr double kMostTurn = radians(20.0), kTurnStep = radians(5.0);
  constexpr int kWorthless = 3;
  WallAcross most;
  for (double along_m = from_m; along_m <= to_m; along_m += 2.0 * kStep_m)
    for (double turn = -kMostTurn; turn < kMostTurn + 0.5 * kTurnStep; turn += kTurnStep) {
      WallAcross wall{.along_m = along_m, .turn = turn};
      for (int i = 0;
           i < kWallSamples && wall.seen + kWallSamples - i > std::max(most.seen, kWorthless); ++i)
        wall.seen +=
            slices_.isSurface(wall.at(plate, options_.max_width_m - 0.15 + 0.1 * i)) ? 1 : 0;
      if (wall.seen > most.seen) most = wall;
    }
  return most;
}

/// Does the other side of the opening go in as deep as the plate? It is a passage then.
bool DoorLeaves::isPassage(const Plate& plate, const WallAcross& wall) const {
  constexpr int kSamples = 6, kLeast = 3;
  double begin_m = options_.min_width_m - 0.1;
  while (begin_m < options_.max_width_m && !slices_.isSurface(wall.at(plate, begin_m)))
    begin_m += kStep_m;
  int seen = 0;
  for (int i = 1; i <= kSamples; ++i)
    for (const double beside_m : {0.0, -kStep_m, kStep_m})
      if (slices_.isSurface(plate.at(0.1 * i, begin_m + beside_m))) {
        ++seen;
        break;
      }
  return seen >= kLeast;
}

bool DoorLeaves::isLeaf(const Plate& plate) const {
  constexpr double kClear_m = 0.1;  // twice so far from each other
  constexpr int kWall = 5, kNoWall = 3;
  const double farthest_m = options_.max_width_m + options_.max_jamb_m;
  if (!isPlate(plate)) return false;
  double end_m = 0.4;
  while (end_m <= farthest_m && !(isClear(plate, end_m) && isClear(plate, end_m + kClear_m)))
    end_m += kStep_m;
  if (end_m < options_.min_width_m || end_m > farthest_m) return false;
  const double from_m = std::max(options_.min_width_m, end_m - options_.max_jamb_m - kStep_m);
  const WallAcross wall = wallAcross(plate, from_m, end_m + kStep_m);
  return wall.seen >= kWall && !isPassage(plate, wall) &&
         wallAcross(plate, -0.1, 0.35).seen <= kNoWall;
}

void DoorLeaves::judge(Detections& detections, const DepthProfile& profile,
                       const Segmentation& segmentation,
                       const std::optional<Pose2>& T_previous_robot) {
  if (!options_.enabled) return;
  if (T_previous_robot) {
    slices_.move(*T_previous_robot);
    places_.move(*T_previous_robot);
  } else {
    slices_.clear();
    places_.clear();
  }
  slices_.add(profile);
  for (const Detection& edge : detections) {
    if (profile.empty() || !edge.accepted() || edge.on_surface) continue;
    const auto p_robot = placeOf(edge);
    if (!p_robot || segmentation.at(0.5 * (edge.a_px + edge.b_px)) == Segmentation::kMoving)
      continue;
    for (const int side : {-1, 1}) {
      const auto plate = plateBeside(profile, *p_robot, side);
      if (!plate || !isLeaf(*plate)) continue;
      places_.sight(*p_robot);
      break;
    }
  }
  for (Detection& edge : detections) {
    if (!edge.accepted()) continue;
    const auto p_robot = placeOf(edge);
    if (p_robot && places_.nearest(*p_robot))
      refuse(detections, edge, "on the leaf of an open door");
  }
}

}  // namespace colonnade
