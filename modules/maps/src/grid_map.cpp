// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grid_map.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

constexpr double kMargin_m = 0.5;
// A hit counts twice a pass: depth noise spreads a wall over two cells, and beams that end in the
// farther one pass through the nearer.
constexpr float kHitCertainty = 0.72F;
constexpr float kPassCertainty = 0.6F;
constexpr double kOccupiedFrom = 0.65;
constexpr double kFreeUpTo = 0.196;
constexpr unsigned char kOccupied = 0;
constexpr unsigned char kFree = 254;
constexpr unsigned char kUnknown = 205;

/// The point a beam reaches after `range`, in the world.
Eigen::Vector2d reach(const KeyFrame& key_frame, std::size_t beam, float range) {
  const double angle = key_frame.scan.angle(beam);
  const Eigen::Vector2d p_scan = range * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  return transform(key_frame.T_world_robot * key_frame.scan.T_robot_scan, p_scan);
}

Eigen::AlignedBox2d extentOf(const std::vector<KeyFrame>& key_frames) {
  Eigen::AlignedBox2d box;
  for (const auto& key_frame : key_frames) {
    box.extend(key_frame.T_world_robot.translation());
    const auto& scan = key_frame.scan;
    for (std::size_t i = 0; i < scan.size(); ++i)
      box.extend(reach(key_frame, i, std::max(scan.ranges_m[i], scan.free_m[i])));
  }
  return box;
}

/// Frees the floor that beams without an obstacle see.
void freeFloor(const KeyFrame& key_frame, mrpt::maps::COccupancyGridMap2D& grid) {
  for (std::size_t i = 0; i < key_frame.scan.size(); ++i) {
    const float range = key_frame.scan.free_m[i];
    if (range <= 0.0F) continue;
    const Eigen::Vector2d from = reach(key_frame, i, 0.0F);
    const Eigen::Vector2d way = reach(key_frame, i, range) - from;
    const auto steps = static_cast<int>(std::ceil(range / grid.getResolution()));
    int last_x = -1;
    int last_y = -1;
    for (int step = 0; step <= steps; ++step) {
      const Eigen::Vector2d p = from + way * (static_cast<double>(step) / steps);
      const int x = grid.x2idx(static_cast<float>(p.x()));
      const int y = grid.y2idx(static_cast<float>(p.y()));
      if (x == last_x && y == last_y) continue;
      grid.updateCell(x, y, kPassCertainty);
      last_x = x;
      last_y = y;
    }
  }
}

/// MRPT enlarges a grid to the farthest point a scan could have reached; this cuts it back.
mrpt::maps::COccupancyGridMap2D::Ptr cropped(const mrpt::maps::COccupancyGridMap2D& grid,
                                             const Eigen::AlignedBox2d& box) {
  const auto column = [&](double x) { return grid.x2idx(static_cast<float>(x)); };
  const auto row = [&](double y) { return grid.y2idx(static_cast<float>(y)); };
  const int left = std::max(column(box.min().x() - kMargin_m), 0);
  const int bottom = std::max(row(box.min().y() - kMargin_m), 0);
  const int right =
      std::min(column(box.max().x() + kMargin_m), static_cast<int>(grid.getSizeX()) - 1);
  const int top = std::min(row(box.max().y() + kMargin_m), static_cast<int>(grid.getSizeY()) - 1);
  const float cell = grid.getResolution();
  const auto edge = [&](float origin, int index) {
    return origin + static_cast<float>(index) * cell;
  };
  auto result = mrpt::maps::COccupancyGridMap2D::Create();
  result->setSize(edge(grid.getXMin(), left), edge(grid.getXMin(), right + 1),
                  edge(grid.getYMin(), bottom), edge(grid.getYMin(), top + 1), cell);
  for (int y = bottom; y <= top; ++y)
    for (int x = left; x <= right; ++x) result->setCell(x - left, y - bottom, grid.getCell(x, y));
  return result;
}

unsigned char shade(double occupancy) {
  if (occupancy >= kOccupiedFrom) return kOccupied;
  return occupancy <= kFreeUpTo ? kFree : kUnknown;
}

}  // namespace

mrpt::maps::COccupancyGridMap2D::Ptr buildGrid(const std::vector<KeyFrame>& key_frames,
                                               double resolution_m) {
  const auto box = extentOf(key_frames);
  const auto down = [&](double v) { return std::floor((v - kMargin_m) / resolution_m); };
  const auto up = [&](double v) { return std::ceil((v + kMargin_m) / resolution_m); };
  const auto metres = [&](double cells) { return static_cast<float>(cells * resolution_m); };
  mrpt::maps::COccupancyGridMap2D grid(metres(down(box.min().x())), metres(up(box.max().x())),
                                       metres(down(box.min().y())), metres(up(box.max().y())),
                                       static_cast<float>(resolution_m));
  auto& options = grid.insertionOptions;
  options.maxDistanceInsertion = key_frames.front().observation->maxRange;
  options.maxOccupancyUpdateCertainty = kHitCertainty;
  options.maxFreenessUpdateCertainty = kPassCertainty;
  options.considerInvalidRangesAsFreeSpace = false;
  for (const auto& key_frame : key_frames) {
    const auto& pose = key_frame.T_world_robot;
    const mrpt::poses::CPose3D robot(pose.x, pose.y, 0.0, pose.phi, 0.0, 0.0);
    grid.insertObservation(*key_frame.observation, robot);
    freeFloor(key_frame, grid);
  }
  return cropped(grid, box);
}

GridPicture toPicture(const mrpt::maps::COccupancyGridMap2D& grid) {
  GridPicture picture;
  picture.resolution_m = grid.getResolution();
  picture.p_world_corner = {grid.getXMin(), grid.getYMin()};
  const auto width = static_cast<int>(grid.getSizeX());
  const auto height = static_cast<int>(grid.getSizeY());
  picture.cells.create(height, width, CV_8UC1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      picture.cells.at<unsigned char>(height - 1 - y, x) = shade(1.0 - grid.getCell(x, y));
  return picture;
}

void writeNavigationMap(const std::filesystem::path& folder, const std::string& stem,
                        const GridPicture& grid) {
  std::vector<unsigned char> png;
  if (!cv::imencode(".png", grid.cells, png))
    throw Error((folder / (stem + ".png")).string() + ": the grid cannot be encoded");
  writeFileAtomically(folder / (stem + ".png"),
                      {reinterpret_cast<const char*>(png.data()), png.size()});
  // The resolution of the grid is single precision; six digits are all it has.
  const std::string yaml = "image: " + stem + ".png\n" +
                           "resolution: " + formatDouble(grid.resolution_m, 6) + "\n" +
                           "origin: [" + formatFixed(grid.p_world_corner.x(), 4) + ", " +
                           formatFixed(grid.p_world_corner.y(), 4) + ", 0.0]\n" + "negate: 0\n" +
                           "occupied_thresh: " + formatDouble(kOccupiedFrom) + "\n" +
                           "free_thresh: " + formatDouble(kFreeUpTo) + "\n";
  writeFileAtomically(folder / (stem + ".yaml"), yaml);
}

}  // namespace colonnade
