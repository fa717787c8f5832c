// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "special_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace colonnade {
namespace {

constexpr double kNearM = 0.1;
constexpr double kInFrontM = 0.01;     ///< what is nearer than a pane by more hides it
constexpr double kBodyRadiusM = 0.48;  ///< of a walker of 1.75 m with swinging arms and legs
constexpr double kAboveFloorM = 0.03;
constexpr int kFewestPixels = 12;

/// Collects the visible pixels of one thing.
struct Box {
  int left = std::numeric_limits<int>::max(), right = -1;
  int top = std::numeric_limits<int>::max(), bottom = -1;
  int pixels = 0;
  double nearest_m = std::numeric_limits<double>::infinity();

  void add(int row, int column, double range_m) {
    left = std::min(left, column), right = std::max(right, column);
    top = std::min(top, row), bottom = std::max(bottom, row);
    ++pixels;
    nearest_m = std::min(nearest_m, range_m);
  }

  void report(const char* kind, int id, std::vector<SeenColumn>& seen) const {
    if (pixels < kFewestPixels) return;
    SeenColumn column;
    column.kind = kind;
    column.id = id;
    column.from = {left, top};
    column.to = {right, bottom};
    column.length_px = bottom - top + 1;
    column.range_m = nearest_m;
    seen.push_back(column);
  }
};

/// The pixels in which points may appear; the whole image when one is behind the camera.
cv::Rect boundsOf(const std::vector<Eigen::Vector3d>& points_camera, const PinholeCamera& camera) {
  const cv::Rect image(0, 0, camera.width_px, camera.height_px);
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
  int behind = 0;
  for (const auto& p : points_camera) {
    if (p.z() < kNearM) {
      ++behind;
      continue;
    }
    const double u = camera.cx_px + camera.fx_px * p.x() / p.z();
    const double v = camera.cy_px + camera.fy_px * p.y() / p.z();
    left = std::min(left, u), right = std::max(right, u);
    top = std::min(top, v), bottom = std::max(bottom, v);
  }
  if (behind == static_cast<int>(points_camera.size())) return {};
  if (behind > 0) return image;
  const auto pixel = [](double x) {
    return static_cast<int>(std::floor(std::clamp(x, -2e4, 2e4)));
  };
  return cv::Rect(cv::Point(pixel(left), pixel(top)),
                  cv::Point(pixel(right) + 2, pixel(bottom) + 2)) &
         image;
}

}  // namespace

SpecialSurfaces::SpecialSurfaces(const World& world, const Building& building)
    : camera_(world.camera.pinhole()), walkers_(world.walkers) {
  for (const auto& face : building.faces) {
    if (face.surface != Surface::kOpaque) faces_.push_back(face);
  }
}

SpecialView SpecialSurfaces::look(const cv::Mat& depth_m, const Eigen::Isometry3d& T_world_camera,
                                  double time_s) const {
  SpecialView view;
  if (!faces_.empty()) view.no_return = cv::Mat::zeros(depth_m.size(), CV_8UC1);
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  for (const auto& face : faces_) lookAtFace(face, depth_m, T_camera_world, view);
  for (std::size_t i = 0; i < walkers_.size(); ++i) {
    lookAtWalker(i, depth_m, T_world_camera, time_s, view);
  }
  return view;
}

/// A pixel's ray meets the face's plane at depth z; it is seen where the renderer found nothing
/// nearer (it may have drawn what is behind the glass).
void SpecialSurfaces::lookAtFace(const Face& face, const cv::Mat& depth_m,
                                 const Eigen::Isometry3d& T_camera_world, SpecialView& view) const {
  const Eigen::Vector3d origin = T_camera_world * face.origin;
  const Eigen::Vector3d along = T_camera_world.linear() * face.along;
  const Eigen::Vector3d up = T_camera_world.linear() * face.up;
  const cv::Rect bounds =
      boundsOf({origin, origin + along, origin + up, origin + along + up}, camera_);
  const Eigen::Vector3d normal = along.cross(up);
  const double distance = normal.dot(origin);
  Box box;
  for (int row = bounds.y; row < bounds.br().y; ++row) {
    for (int column = bounds.x; column < bounds.br().x; ++column) {
      const Eigen::Vector3d ray = camera_.ray(column, row);
      const double z = distance / normal.dot(ray);
      if (!(z > kNearM) || !std::isfinite(z)) continue;
      const double found = depth_m.at<float>(row, column);
      if (found > 0.0 && found < z - kInFrontM - 0.002 * z) continue;
      const Eigen::Vector3d p = z * ray - origin;
      const double s = p.dot(along) / along.squaredNorm(), t = p.dot(up) / up.squaredNorm();
      if (s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0) continue;
      view.no_return.at<unsigned char>(row, column) = 255;
      box.add(row, column, (z * ray).norm());
    }
  }
  const auto index = static_cast<int>(&face - faces_.data());
  box.report(face.surface == Surface::kGlass ? "glass" : "mirror", index, view.seen);
}

/// Everything seen within an upright cylinder around the walker is the walker.
void SpecialSurfaces::lookAtWalker(std::size_t index, const cv::Mat& depth_m,
                                   const Eigen::Isometry3d& T_world_camera, double time_s,
                                   SpecialView& view) const {
  const Walker& walker = walkers_[index];
  const Eigen::Vector2d centre = walker.poseAt(time_s).translation();
  const double radius = kBodyRadiusM * walker.height_m / 1.75;
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  std::vector<Eigen::Vector3d> corners;
  for (const double x : {-radius, radius})
    for (const double y : {-radius, radius})
      for (const double z : {0.0, walker.height_m})
        corners.push_back(T_camera_world * Eigen::Vector3d(centre.x() + x, centre.y() + y, z));
  const cv::Rect bounds = boundsOf(corners, camera_);
  Box box;
  for (int row = bounds.y; row < bounds.br().y; ++row) {
    for (int column = bounds.x; column < bounds.br().x; ++column) {
      const double z = depth_m.at<float>(row, column);
      if (z <= 0.0) continue;
      const Eigen::Vector3d p_camera = z * camera_.ray(column, row);
      const Eigen::Vector3d p = T_world_camera * p_camera;
      if (p.z() < kAboveFloorM || p.z() > walker.height_m + kAboveFloorM) continue;
      if ((p.head<2>() - centre).norm() < radius) box.add(row, column, p_camera.norm());
    }
  }
  box.report("person", static_cast<int>(index), view.seen);
}

}  // namespace colonnade
