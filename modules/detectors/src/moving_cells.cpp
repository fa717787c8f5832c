// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "moving_cells.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "background.hpp"
#include "cell_regions.hpp"
#include "colonnade/base/vector_kernel.hpp"

namespace colonnade {
namespace {

constexpr double kFloor_m = 0.08;  ///< what is lower belongs to the floor
constexpr float kSurfaceStep_m = 0.12F;

/// A view from another one: where the cells of a row stand there.
struct RowElsewhere {
  // Of the viewing rays of the row's cells in the other camera's axes: first + column * step.
  double first[3], step[3];
  double p_other[3];  ///< this camera's centre, in the other's axes
};
struct Places {
  std::int32_t* cell;  ///< of the other view; negative: outside or not measured
  double* depth_m;     ///< there
};

COLONNADE_VECTOR_KERNEL
void placeCells(const float* near_m, int columns, const RowElsewhere& row, const DepthCells& other,
                const Places& places) {
  constexpr double kNearest_m = 0.2;
  const float* __restrict depths = near_m;
  std::int32_t* __restrict cells = places.cell;
  double* __restrict depths_there = places.depth_m;
  const RowElsewhere r = row;
  const PinholeCamera camera = other.camera;
  const double width = other.columns * other.cell_px - 0.5;
  const double height = other.rows * other.cell_px - 0.5;
  const double cell_px = other.cell_px;
  const std::int32_t stride = other.columns;
  for (int column = 0; column < columns; ++column) {
    const auto depth = static_cast<double>(depths[column]);
    const double x = depth * (r.first[0] + column * r.step[0]) + r.p_other[0];
    const double y = depth * (r.first[1] + column * r.step[1]) + r.p_other[1];
    const double z = depth * (r.first[2] + column * r.step[2]) + r.p_other[2];
    const double u = camera.cx_px + camera.fx_px * x / z;
    const double v = camera.cy_px + camera.fy_px * y / z;
    const bool inside =
        (depth > 0.0) & (z >= kNearest_m) & (u > -0.5) & (v > -0.5) & (u < width) & (v < height);
    const auto there_column = static_cast<std::int32_t>(inside ? (u + 0.5) / cell_px : 0.0);
    const auto there_row = static_cast<std::int32_t>(inside ? (v + 0.5) / cell_px : 0.0);
    cells[column] = inside ? there_row * stride + there_column : -1;
    depths_there[column] = z;
  }
}

/// Calls take(cell of `from`, where it falls in `to`, depth there) for every cell of `from` whose
/// surface stands where `to` looks through free space; returns the number of cells compared.
template <class Take>
std::size_t eachThrough(const DepthGlimpse& from, const DepthGlimpse& to,
                        const SegmentationOptions& options, Take&& take) {
  const Eigen::Isometry3d T_to_from = to.T_world_camera.inverse() * from.T_world_camera;
  std::vector<std::int32_t> cells(static_cast<std::size_t>(from.cells.columns));
  std::vector<double> depths(cells.size());
  std::size_t compared = 0;
  for (int row = 0; row < from.cells.rows; ++row) {
    const Eigen::Vector3d first = T_to_from.linear() * from.cells.ray(0, row);
    const Eigen::Vector3d step = T_to_from.linear() * from.cells.ray(1, row) - first;
    RowElsewhere elsewhere;
    for (int axis = 0; axis < 3; ++axis) {
      elsewhere.first[axis] = first[axis];
      elsewhere.step[axis] = step[axis];
      elsewhere.p_other[axis] = T_to_from.translation()[axis];
    }
    placeCells(&from.cells.near_m[from.cells.index(0, row)], from.cells.columns, elsewhere,
               to.cells, {cells.data(), depths.data()});
    for (std::size_t column = 0; column < cells.size(); ++column) {
      if (cells[column] < 0) continue;
      const auto there = static_cast<std::size_t>(cells[column]);
      if (to.cells.around_m[there] == DepthCells::kNone) continue;
      ++compared;
      const auto seen_m = static_cast<double>(to.cells.around_m[there]);
      const double tolerance = options.tolerance_m + options.tolerance_per_m2 * seen_m * seen_m;
      if (seen_m > depths[column] + tolerance)
        take(from.cells.index(0, row) + column, there, depths[column]);
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

bool markMoving(const DepthGlimpse& now, const DepthGlimpse& former, Background& background,
                const SegmentationOptions& options, std::vector<std::uint8_t>& marks) {
  std::vector<std::uint8_t> found(marks.size(), 0);
  std::size_t through = 0;
  const std::size_t compared =
      eachThrough(now, former, options, [&](std::size_t cell, std::size_t, double) {
        found[cell] = 1;
        ++through;
      });
  // A surface that is gone: what stands a little behind its place may be the same thing now, or
  // the room that it no longer hides.
  const double way_m = options.max_speed_m_s * (now.stamp_s - former.stamp_s);
  eachThrough(former, now, options, [&](std::size_t, std::size_t there, double depth_m) {
    const float z = now.cells.near_m[there];
    if (z == DepthCells::kNone || static_cast<double>(z) >= depth_m + way_m || found[there]) return;
    const double nearer_m = static_cast<double>(z) - depth_m;
    if (!background.isUncovered(there, former, nearer_m)) found[there] = 1;
  });
  if (static_cast<double>(through) > options.max_moving_share * static_cast<double>(compared))
    return false;
  for (std::size_t i = 0; i < marks.size(); ++i) marks[i] = marks[i] | found[i];
  return true;
}

void completeMoving(const DepthGlimpse& now, const Frame& frame, Background& background,
                    const SegmentationOptions& options, std::vector<std::uint8_t>& marks) {
  if (std::find(marks.begin(), marks.end(), 1) == marks.end()) return;
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
      if (background.isStanding(next)) continue;
      left[next] = next_left;
      marks[next] = 1;
      fronts.push_back({next, next_left});
    }
  }
}

}  // namespace colonnade
