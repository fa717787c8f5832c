// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/maps/levelled_scan.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

constexpr double kWidestHalfAperture = radians(85.0);

bool same(const PinholeCamera& a, const PinholeCamera& b) {
  return a.width_px == b.width_px && a.height_px == b.height_px && a.fx_px == b.fx_px &&
         a.fy_px == b.fy_px && a.cx_px == b.cx_px && a.cy_px == b.cy_px;
}

/// The heading of the optical axis; of the image's upper side for a camera that looks down.
double heading(const Eigen::Matrix3d& R_robot_camera) {
  Eigen::Vector3d axis = R_robot_camera.col(2);
  if (axis.head<2>().norm() < 1e-3) axis = -R_robot_camera.col(1);
  return std::atan2(axis.y(), axis.x());
}

/// How far behind its nearest pixels an obstacle's own depth noise may reach: Kinect-like sensors
/// are uncertain by about 0.002 r^2 metres (Khoshelham 2012); five of these and 5 cm of shape.
float noiseMargin(float range_m) { return 0.05F + 0.01F * range_m * range_m; }

/// The range of the nearest obstacle that enough pixels agree on; 0 if none. Sorts `ranges`.
float nearestObstacle(std::vector<float>& ranges, std::size_t min_pixels) {
  std::sort(ranges.begin(), ranges.end());
  const std::size_t needed = std::max(min_pixels, ranges.size() * 3 / 100);
  const auto endOfMargin = [&](std::size_t begin, std::size_t end) {
    const float limit = ranges[begin] + noiseMargin(ranges[begin]);
    while (end < ranges.size() && ranges[end] <= limit) ++end;
    return end;
  };
  std::size_t begin = 0;
  std::size_t end = 0;
  for (;; ++begin) {
    if (begin == ranges.size()) return 0.0F;
    end = endOfMargin(begin, end);
    if (end - begin >= needed) break;
  }
  // That may be a speckle and the near half of the obstacle: slide on to where most pixels agree.
  std::size_t best_begin = begin;
  std::size_t best_end = end;
  const std::size_t last = end;
  for (++begin; begin < last; ++begin) {
    end = endOfMargin(begin, end);
    if (end - begin <= best_end - best_begin) continue;
    best_begin = begin;
    best_end = end;
  }
  return ranges[(best_begin + best_end) / 2];
}

/// How far the floor is seen without a gap; 0 where it is not. Sorts `ranges`.
float endOfFloor(std::vector<float>& ranges, std::size_t min_pixels) {
  if (ranges.size() < min_pixels) return 0.0F;
  std::sort(ranges.begin(), ranges.end());
  // Rows of the image meet the floor farther and farther apart.
  const auto gap = [](float range) { return 0.15F + 0.02F * range * range; };
  std::size_t last = 0;
  while (last + 1 < ranges.size() && ranges[last + 1] - ranges[last] <= gap(ranges[last])) ++last;
  return last + 1 >= min_pixels ? ranges[last] : 0.0F;
}

}  // namespace

std::size_t LevelledScan::validBeams() const {
  return static_cast<std::size_t>(
      std::count_if(ranges_m.begin(), ranges_m.end(), [](float range) { return range > 0.0F; }));
}

void ScanCutter::prepare(const Frame& frame) {
  camera_ = frame.camera;
  depth_size_ = frame.depth_m.size();
  T_robot_camera_ = frame.T_robot_camera;
  const double yaw = heading(T_robot_camera_.linear());
  empty_.T_robot_scan = {T_robot_camera_.translation().x(), T_robot_camera_.translation().y(), yaw};
  const Eigen::Matrix3d R_scan_camera =
      Eigen::AngleAxisd(-yaw, Eigen::Vector3d::UnitZ()) * T_robot_camera_.linear();
  // The widest azimuth at the rim of the image decides how many beams there are.
  double half = 0.0;
  const int right = frame.depth_m.cols - 1;
  const int bottom = frame.depth_m.rows - 1;
  for (const int u : {0, right})
    for (const int v : {0, bottom / 2, bottom}) {
      const Eigen::Vector3d ray = R_scan_camera * camera_.ray(u, v);
      half = std::max(half, std::abs(std::atan2(ray.y(), ray.x())));
    }
  half = std::min(half, kWidestHalfAperture);
  const auto side = static_cast<std::int32_t>(std::ceil(half / options_.beam_width));
  const auto beams = static_cast<std::size_t>(2 * side + 1);
  empty_.step = options_.beam_width;
  empty_.first_angle = -side * options_.beam_width;
  empty_.ranges_m.assign(beams, 0.0F);
  empty_.free_m.assign(beams, 0.0F);
  obstacles_.resize(beams);
  floor_.resize(beams);
  pixels_.clear();
  for (int v = options_.row_step / 2; v <= bottom; v += options_.row_step)
    for (int u = options_.column_step / 2; u <= right; u += options_.column_step) {
      const Eigen::Vector3d ray = R_scan_camera * camera_.ray(u, v);
      const double azimuth = std::atan2(ray.y(), ray.x());
      const auto beam =
          static_cast<std::int32_t>(std::lround(azimuth / options_.beam_width)) + side;
      if (beam < 0 || beam >= 2 * side + 1) continue;
      pixels_.push_back({v * frame.depth_m.cols + u, beam, static_cast<float>(ray.head<2>().norm()),
                         static_cast<float>(ray.z())});
    }
}

std::optional<LevelledScan> ScanCutter::cut(const Frame& frame) {
  if (frame.depth_m.empty() || !frame.camera.isCalibrated()) return std::nullopt;
  if (depth_size_ != frame.depth_m.size() || !same(camera_, frame.camera) ||
      T_robot_camera_.matrix() != frame.T_robot_camera.matrix())
    prepare(frame);
  const cv::Mat depth = frame.depth_m.isContinuous() ? frame.depth_m : frame.depth_m.clone();
  const auto* depth_m = depth.ptr<float>();
  const auto z_camera = static_cast<float>(T_robot_camera_.translation().z());
  const auto z_min = static_cast<float>(options_.z_min_m);
  const auto z_max = static_cast<float>(options_.z_max_m);
  const auto min_range = static_cast<float>(options_.min_range_m);
  const auto max_range = static_cast<float>(options_.max_range_m);
  const auto rise = static_cast<float>(std::tan(options_.tilt_margin));
  for (auto& ranges : obstacles_) ranges.clear();
  for (auto& ranges : floor_) ranges.clear();
  for (const Pixel& pixel : pixels_) {
    const float d = depth_m[pixel.index];
    const float z = z_camera + d * pixel.rise_per_depth;
    const float range = d * pixel.range_per_depth;
    // Comparisons are false for NaN, so that an unmeasured pixel never passes.
    if (!(d > 0.0F && range >= min_range && range <= max_range && z <= z_max)) continue;
    const float floor_top = z_min + rise * range;
    const auto beam = static_cast<std::size_t>(pixel.beam);
    if (z >= floor_top)
      obstacles_[beam].push_back(range);
    else if (z >= -floor_top)
      floor_[beam].push_back(range);
  }
  LevelledScan scan = empty_;
  const auto min_pixels = static_cast<std::size_t>(options_.min_pixels);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    scan.ranges_m[i] = nearestObstacle(obstacles_[i], min_pixels);
    // A few pixels above the floor are no obstacle, but no reason to call the beam free either.
    if (obstacles_[i].size() < min_pixels) scan.free_m[i] = endOfFloor(floor_[i], min_pixels);
  }
  return scan;
}

}  // namespace colonnade
