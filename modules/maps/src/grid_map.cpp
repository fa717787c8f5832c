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
constexpr float kUpdateCertainty = 0.7F;
constexpr double kOccupiedFrom = 0.65;
constexpr double kFreeUpTo = 0.196;
constexpr unsigned char kOccupied = 0;
constexpr unsigned char kFree = 254;
constexpr unsigned char kUnknown = 205;

Eigen::AlignedBox2d extentOf(const std::vector<KeyFrame>& key_frames) {
  Eigen::AlignedBox2d box;
  for (const auto& key_frame : key_frames) {
    box.extend(key_frame.T_world_robot.translation());
    const auto& scan = *key_frame.scan;
    const Pose2 T_robot_scan{scan.sensorPose.x(), scan.sensorPose.y(), scan.sensorPose.yaw()};
    const Pose2 T_world_scan = key_frame.T_world_robot * T_robot_scan;
    for (std::size_t i = 0; i < scan.getScanSize(); ++i) {
      if (!scan.getScanRangeValidity(i)) continue;
      const double angle = scan.getScanAngle(i);
      const Eigen::Vector2d ray(std::cos(angle), std::sin(angle));
      box.extend(transform(T_world_scan, scan.getScanRange(i) * ray));
    }
  }
  return box;
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
  auto grid = mrpt::maps::COccupancyGridMap2D::Create();
  const auto metres = [&](double cells) { return static_cast<float>(cells * resolution_m); };
  grid->setSize(metres(down(box.min().x())), metres(up(box.max().x())), metres(down(box.min().y())),
                metres(up(box.max().y())), static_cast<float>(resolution_m));
  auto& options = grid->insertionOptions;
  options.maxDistanceInsertion = key_frames.front().scan->maxRange;
  options.maxOccupancyUpdateCertainty = kUpdateCertainty;
  options.considerInvalidRangesAsFreeSpace = false;
  for (const auto& key_frame : key_frames) {
    const auto& pose = key_frame.T_world_robot;
    const mrpt::poses::CPose3D robot(pose.x, pose.y, 0.0, pose.phi, 0.0, 0.0);
    grid->insertObservation(*key_frame.scan, robot);
  }
  return grid;
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
