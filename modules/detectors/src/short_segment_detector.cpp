// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/short_segment_detector.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "colonnade/detectors/depth_noise.hpp"
#include "colonnade/detectors/levelled_camera.hpp"
#include "depth_view.hpp"
#include "statistics.hpp"
#include "upright_segments.hpp"

namespace colonnade {
namespace {

/// A leg between two edges: where it stands and how thick it is.
struct Leg {
  double range_m;
  double depth_m;
  double width_m;
};

/// Median range of the pixels between two columns over the rows both segments have.
std::optional<SeenPoint> middleOf(const DepthView& depth, const UprightSegment& left,
                                  const UprightSegment& right, double shift_px, int top,
                                  int bottom) {
  std::vector<double> ranges;
  SeenPoint point{};
  int rows = 0;
  for (int v = top; v <= bottom; ++v) {
    ++rows;
    const double u = 0.5 * (left.across(v) + right.across(v)) + shift_px;
    if (const auto seen = depth.at(static_cast<int>(std::lround(u)), v)) {
      ranges.push_back(seen->range_m);
      point = *seen;
    }
  }
  if (ranges.size() < 4 || 3 * static_cast<int>(ranges.size()) < rows) return std::nullopt;
  const double scale = medianOf(ranges) / point.range_m;
  point.depth_m *= scale;
  point.range_m *= scale;
  return point;
}

std::optional<Leg> legBetween(const DepthView& depth, const LevelledCamera& camera,
                              const PinholeCamera& pinhole, const UprightSegment& left,
                              const UprightSegment& right, const ShortSegmentOptions& options) {
  const int top = std::max(left.top, right.top);
  const int bottom = std::min(left.bottom, right.bottom);
  const double middle_row = 0.5 * (top + bottom);
  const double width_px = right.across(middle_row) - left.across(middle_row);
  const auto on = middleOf(depth, left, right, 0.0, top, bottom);
  if (!on || on->range_m > options.max_range_m) return std::nullopt;
  const Leg leg{on->range_m, on->depth_m, width_px * on->depth_m / pinhole.fx_px};
  if (leg.width_m < options.min_width_m || leg.width_m > options.max_width_m) return std::nullopt;
  if ((bottom - top) * on->depth_m / pinhole.fy_px < options.min_length_m) return std::nullopt;
  for (const double side : {-1.0, 1.0}) {
    // Beyond the shadow that a near thing casts into structured light.
    const double beside_px = 0.5 * width_px + 0.06 * pinhole.fx_px / on->depth_m;
    const auto beside = middleOf(depth, left, right, side * beside_px, top, bottom);
    if (beside && beside->range_m < on->range_m + options.stands_out_m) return std::nullopt;
  }
  const double foot_row = std::max(left.bottom, right.bottom);
  const Eigen::Vector3d foot = camera.ray(left.across(foot_row), foot_row);
  const double height_m = camera.height() + foot.z() * leg.range_m / foot.head<2>().norm();
  if (std::abs(height_m) > options.max_foot_m) return std::nullopt;
  return leg;
}

Detection toDetection(const LevelledCamera& camera, const PinholeCamera& pinhole,
                      const UprightSegment& edge, const Leg& leg, const GeometryOptions& geometry) {
  Detection detection;
  detection.a_px = {edge.across(edge.top), edge.top};
  detection.b_px = {edge.across(edge.bottom), edge.bottom};
  const Eigen::Vector3d ray = camera.ray(0.5 * (detection.a_px + detection.b_px));
  const double tilt = geometry.tilt_sigma * ray.z() / ray.head<2>().norm();
  const double pixel = geometry.line_sigma_px / pinhole.fx_px;
  const double axial_m =
      std::hypot(kinectDepthSigma(leg.depth_m),
                 depthBiasSigma(leg.depth_m, geometry.depth_bias_per_m2), 0.5 * leg.width_m);
  auto& m = detection.measurement;
  m.kind = LandmarkKind::kPillarEdge;
  m.p_robot_camera = camera.centre().head<2>();
  m.z.resize(2);
  m.z << std::atan2(ray.y(), ray.x()), leg.range_m;
  m.R.setZero(2, 2);
  m.R.diagonal() << pixel * pixel + tilt * tilt, axial_m * axial_m;
  detection.appearance.gradient_sign = edge.sign;
  detection.width_m = leg.width_m;
  return detection;
}

double fromVertical(const LevelledCamera& camera, const UprightSegment& edge) {
  const Eigen::Vector2d along = Eigen::Vector2d(edge.slope, 1.0).normalized();
  const double row = 0.5 * (edge.top + edge.bottom);
  return std::acos(std::clamp(along.dot(camera.downDirection({edge.across(row), row})), -1.0, 1.0));
}

}  // namespace

Detections ShortSegmentDetector::detect(const Frame& frame, const EdgeLines& edges) const {
  Detections detections;
  if (frame.gray.empty() || edges.edges.size() != frame.gray.size()) return detections;
  const LevelledCamera camera(frame);
  const DepthView depth(frame, camera);
  if (depth.empty()) return detections;
  std::vector<UprightSegment> upright;
  for (const UprightSegment& edge : uprightSegments(edges.edges, options_))
    if (fromVertical(camera, edge) <= options_.vertical_tolerance) upright.push_back(edge);
  std::vector<bool> taken(upright.size(), false);
  const double widest_px = options_.max_width_m * frame.camera.fx_px / geometry_.min_depth_m;
  for (std::size_t i = 0; i < upright.size(); ++i) {
    std::optional<std::size_t> partner;
    std::optional<Leg> best;
    for (std::size_t j = 0; j < upright.size() && !taken[i]; ++j) {
      const UprightSegment &left = upright[i], &right = upright[j];
      if (taken[j] || left.sign == right.sign) continue;
      const int common = std::min(left.bottom, right.bottom) - std::max(left.top, right.top);
      if (common < 0.6 * std::min(left.length(), right.length())) continue;
      const double row = std::max(left.top, right.top) + 0.5 * common;
      const double width_px = right.across(row) - left.across(row);
      if (width_px < 1.5 || width_px > widest_px) continue;
      const auto leg = legBetween(depth, camera, frame.camera, left, right, options_);
      if (!leg || (best && leg->width_m >= best->width_m)) continue;
      best = leg;
      partner = j;
    }
    if (!partner) continue;
    taken[i] = taken[*partner] = true;
    for (const std::size_t k : {i, *partner}) {
      detections.push_back(toDetection(camera, frame.camera, upright[k], *best, geometry_));
      detections.back().partner = detections.size() - 1 + (k == i ? 1 : -1);
    }
  }
  return detections;
}

}  // namespace colonnade
