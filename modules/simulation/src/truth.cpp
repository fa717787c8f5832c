// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/truth.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

constexpr double kSampleM = 0.05;    ///< distance of the samples along a landmark
constexpr double kSeenShare = 0.10;  ///< of the image's height that must be seen of a landmark
constexpr double kDepthTolerance = 0.02;

/// Is the surface nearest to pixel (u, v), give or take one pixel, at this depth?
bool unhidden(const cv::Mat& depth_m, double u, double v, double z) {
  const int column = static_cast<int>(std::lround(u)), row = static_cast<int>(std::lround(v));
  for (int r = std::max(0, row - 1); r <= std::min(depth_m.rows - 1, row + 1); ++r) {
    for (int c = std::max(0, column - 1); c <= std::min(depth_m.cols - 1, column + 1); ++c) {
      const double found = depth_m.at<float>(r, c);
      if (found > 0.0 && std::abs(found - z) < kDepthTolerance * z) return true;
    }
  }
  return false;
}

LandmarkRecord uprightRecord(const VerticalEdge& edge, LandmarkKind kind, std::size_t id) {
  LandmarkRecord record;
  record.id = LandmarkId{static_cast<std::int32_t>(id)};
  record.kind = kind;
  record.p_world = record.extent_a = record.extent_b = edge.p_world;
  record.hallway = edge.hallway;
  return record;
}

LandmarkRecord floorRecord(const FloorLine& line, std::size_t id) {
  LandmarkRecord record;
  record.id = LandmarkId{static_cast<std::int32_t>(id)};
  record.kind = LandmarkKind::kFloorEdge;
  record.p_world = 0.5 * (line.a + line.b);
  record.extent_a = line.a;
  record.extent_b = line.b;
  const Eigen::Vector2d d = line.b - line.a;
  double direction = std::atan2(d.y(), d.x());
  if (direction < 0.0) direction += kPi;
  record.direction = direction >= kPi ? 0.0 : direction;
  record.hallway = line.hallway;
  return record;
}

}  // namespace

Truth::Truth(const World& world, const Building& building)
    : camera_(world.camera.pinhole()), range_m_(world.depth.range_max_m) {
  const auto upright = [&](const VerticalEdge& edge) {
    const auto& p = edge.p_world;
    outlines_.push_back({{p.x(), p.y(), 0.0}, {p.x(), p.y(), edge.height_m}});
  };
  for (const auto& edge : building.edges) {
    landmarks_.push_back(uprightRecord(edge, LandmarkKind::kPillarEdge, landmarks_.size()));
    if (edge.partner) {
      landmarks_.back().pair_id = LandmarkId{static_cast<std::int32_t>(*edge.partner)};
    }
    upright(edge);
  }
  for (const auto& line : building.floor_lines) {
    landmarks_.push_back(floorRecord(line, landmarks_.size()));
    outlines_.push_back({{line.a.x(), line.a.y(), 0.0}, {line.b.x(), line.b.y(), 0.0}});
  }
  for (const auto& edge : building.edges) {
    if (!edge.slope) continue;
    landmarks_.push_back(uprightRecord(edge, LandmarkKind::kDepthSlope, landmarks_.size()));
    upright(edge);
  }
}

bool Truth::seen(const Outline& outline, const cv::Mat& depth_m,
                 const Eigen::Isometry3d& T_camera_world) const {
  const Eigen::Vector3d along = outline.b - outline.a;
  const int samples = std::max(2, static_cast<int>(std::lround(along.norm() / kSampleM)));
  double seen_px = 0.0;
  Eigen::Vector2d last = Eigen::Vector2d::Zero();
  bool last_seen = false;
  for (int i = 0; i <= samples; ++i) {
    const Eigen::Vector3d p = T_camera_world * (outline.a + along * i / samples);
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
    bool pixel_seen = false;
    if (p.z() > 0.1 && p.z() < range_m_) {
      pixel = {camera_.cx_px + camera_.fx_px * p.x() / p.z(),
               camera_.cy_px + camera_.fy_px * p.y() / p.z()};
      const bool inside = pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() <= depth_m.cols - 1 &&
                          pixel.y() <= depth_m.rows - 1;
      pixel_seen = inside && unhidden(depth_m, pixel.x(), pixel.y(), p.z());
    }
    if (pixel_seen && last_seen) seen_px += (pixel - last).norm();
    last = pixel;
    last_seen = pixel_seen;
  }
  return seen_px >= kSeenShare * camera_.height_px;
}

void Truth::observe(const cv::Mat& depth_m, const Eigen::Isometry3d& T_world_camera,
                    double stamp_s) {
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    if (!seen(outlines_[i], depth_m, T_camera_world)) continue;
    auto& landmark = landmarks_[i];
    if (landmark.observations++ == 0) landmark.first_stamp_s = stamp_s;
    landmark.last_stamp_s = stamp_s;
  }
}

}  // namespace colonnade
