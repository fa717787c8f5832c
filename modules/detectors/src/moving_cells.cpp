// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "moving_cells.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "cell_regions.hpp"

namespace colonnade {
namespace {

constexpr double kFloor_m = 0.08;  ///< what is lower belongs to the floor
constexpr float kSurfaceStep_m = 0.12F;

/// Where a point falls in the other view.
struct Hit {
  int column;
  int row;
  double depth_m;
};

std::optional<Hit> project(const DepthCells& cells, const Eigen::Vector3d& p_camera) {
  constexpr double kNearest_m = 0.2;
  if (p_camera.z() < kNearest_m) return std::nullopt;
  const double u = cells.camera.cx_px + cells.camera.fx_px * p_camera.x() / p_camera.z();
  const double v = cells.camera.cy_px + cells.camera.fy_px * p_camera.y() / p_camera.z();
  if (!(u > -0.5 && v > -0.5 && u < cells.columns * cells.cell_px - 0.5 &&
        v < cells.rows * cells.cell_px - 0.5))
    return std::nullopt;
  return Hit{static_cast<int>(u + 0.5) / cells.cell_px, static_cast<int>(v + 0.5) / cells.cell_px,
             p_camera.z()};
}

/// Calls take(cell of `from`, where it falls in `to`, depth there) for every cell of `from` whose
/// surface stands where `to` looks through free space; returns the number of cells compared.
template <class Take>
std::size_t eachThrough(const DepthGlimpse& from, const DepthGlimpse& to,
                        const SegmentationOptions& options, Take&& take) {
  const Eigen::Isometry3d T_to_from = to.T_world_camera.inverse() * from.T_world_camera;
  std::size_t compared = 0;
  for (int row = 0; row < from.cells.rows; ++row) {
    for (int column = 0; column < from.cells.columns; ++column) {
      const std::size_t cell = from.cells.index(column, row);
      const float z = from.cells.near_m[cell];
      if (z == DepthCells::kNone) continue;
      const Eigen::Vector3d p = T_to_from * (static_cast<double>(z) * from.cells.ray(column, row));
      const auto hit = project(to.cells, p);
      if (!hit) continue;
      const std::size_t there = to.cells.index(hit->column, hit->row);
      const double seen_m = static_cast<double>(to.cells.around_m[there]);
      if (to.cells.around_m[there] == DepthCells::kNone) continue;
      ++compared;
      const double tolerance = options.tolerance_m + options.tolerance_per_m2 * seen_m * seen_m;
      if (seen_m > hit->depth_m + tolerance) take(cell, there, hit->depth_m);
    }
  }
  return compared;
}

double areaOf(const DepthCells& cells, const std::vector<std::size_t>& region) {
  double area = 0.0;
  for (const std::size_t cell : region) {
    const double side = cells.cell_px * static_cast<double>(cells.near_m[cell]);
    area += side * side / (cells.camera.fx_px * cells.camera.fy_px);
  }
  return area;
}

}  // namespace

bool markMoving(const DepthGlimpse& now, const DepthGlimpse& former,
                const SegmentationOptions& options, std::vector<std::uint8_t>& marks) {
  std::vector<std::uint8_t> found(marks.size(), 0);
  std::size_t through = 0;
  const std::size_t compared =
      eachThrough(now, former, options, [&](std::size_t cell, std::size_t, double) {
        found[cell] = 1;
        ++through;
      });
  // A surface that is gone: what stands a little behind its place may be the same thing now.
  const double way_m = options.max_speed_m_s * (now.stamp_s - former.stamp_s);
  eachThrough(former, now, options, [&](std::size_t, std::size_t there, double depth_m) {
    const float z = now.cells.near_m[there];
    if (z != DepthCells::kNone && static_cast<double>(z) < depth_m + way_m) found[there] = 1;
  });
  if (static_cast<double>(through) > options.max_moving_share * static_cast<double>(compared))
    return false;
  for (std::size_t i = 0; i < marks.size(); ++i) marks[i] = marks[i] | found[i];
  return true;
}

void completeMoving(const DepthGlimpse& now, const Frame& frame, const SegmentationOptions& options,
                    std::vector<std::uint8_t>& marks) {
  const DepthCells& cells = now.cells;
  struct Front {
    std::size_t cell;
    double left_m;  ///< how much farther
  };
  std::deque<Front> fronts;
  std::vector<double> left(marks.size(), -1.0);
  for (const auto& region : regionsOf(marks, cells.columns, cells.rows)) {
    const bool enough = areaOf(cells, region) >= options.min_moving_area_m2;
    for (const std::size_t cell : region) {
      marks[cell] = enough ? 1 : 0;
      if (!enough) continue;
      left[cell] = options.grow_m;
      fronts.push_back({cell, options.grow_m});
    }
  }
  const auto aboveFloor = [&](int column, int row, float z) {
    const Eigen::Vector3d p =
        frame.T_robot_camera * (static_cast<double>(z) * cells.ray(column, row));
    return p.z() > kFloor_m;
  };
  while (!fronts.empty()) {
    const Front front = fronts.front();
    fronts.pop_front();
    const int column = static_cast<int>(front.cell) % cells.columns;
    const int row = static_cast<int>(front.cell) / cells.columns;
    const float z = cells.near_m[front.cell];
    const double step_m = cells.cell_px * static_cast<double>(z) / cells.camera.fx_px;
    constexpr int kSides[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    for (const auto& side : kSides) {
      const int c = column + side[0];
      const int r = row + side[1];
      if (!cells.contains(c, r)) continue;
      const std::size_t next = cells.index(c, r);
      const float next_z = cells.near_m[next];
      const double next_left = front.left_m - step_m;
      if (next_z == DepthCells::kNone || next_left <= left[next] || next_left < 0.0) continue;
      if (std::abs(next_z - z) > kSurfaceStep_m || !aboveFloor(c, r, next_z)) continue;
      left[next] = next_left;
      marks[next] = 1;
      fronts.push_back({next, next_left});
    }
  }
}

}  // namespace colonnade
