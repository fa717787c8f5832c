// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/pillar_detector.hpp"

#include <algorithm>
#include <cmath>

#include "across_profile.hpp"
#include "colonnade/detectors/depth_noise.hpp"
#include "colonnade/detectors/levelled_camera.hpp"
#include "colonnade/detectors/pillar_pairs.hpp"
#include "colour_sampling.hpp"
#include "line_refinement.hpp"
#include "pillar_consensus.hpp"
#include "pillar_range.hpp"
#include "pillar_seeds.hpp"
#include "pillar_span.hpp"
#include "statistics.hpp"

namespace colonnade {
namespace {

struct Bearing {
  double angle = 0.0;
  double variance = 0.0;
};

/// Gray levels per pixel: no shade on a surface rises so steeply. What does and is wide all the
/// same are two edges side by side, such as those of a frame.
constexpr double kSteepest = 9.0;

/// Variance of the bearing through one pixel of the line: a pixel aside turns it, and a tilt error
/// t by t * tan(elevation).
double bearingVariance(const LevelledCamera& camera, const RefinedLine& line, double s,
                       const GeometryOptions& geometry) {
  const Eigen::Vector3d here = camera.ray(line.at(s));
  const Eigen::Vector3d beside = camera.ray(line.at(s) + Eigen::Vector2d(1.0, 0.0));
  const double per_pixel = std::atan2(here.x() * beside.y() - here.y() * beside.x(),
                                      here.x() * beside.x() + here.y() * beside.y());
  const double pixels = line.variance(s) + geometry.line_sigma_px * geometry.line_sigma_px;
  const double tilt = geometry.tilt_sigma * here.z() / here.head<2>().norm();
  return per_pixel * per_pixel * pixels + tilt * tilt;
}

/// Direction of the vertical plane through the optical centre and the line: equation 13 of the 2015
/// thesis for a levelled camera. It is taken from the pixel of the extent where it is best known:
/// near the horizon and near the middle.
Bearing bestBearing(const LevelledCamera& camera, const RefinedLine& line,
                    const GeometryOptions& geometry) {
  constexpr int kPlaces = 16;
  double best = line.begin;
  double least = bearingVariance(camera, line, best, geometry);
  for (int i = 1; i <= kPlaces; ++i) {
    const double s = line.begin + (line.end - line.begin) * i / kPlaces;
    const double variance = bearingVariance(camera, line, s, geometry);
    if (variance >= least) continue;
    least = variance;
    best = s;
  }
  const Eigen::Vector3d ray = camera.ray(line.at(best));
  return {std::atan2(ray.y(), ray.x()), least};
}

RefinedLines candidatesAmong(const RefinedLines& lines, const LevelledCamera& camera,
                             const PillarOptions& options) {
  RefinedLines candidates;
  for (const auto& line : lines)
    if (line.steep && line.length() >= options.min_length_px &&
        std::abs(leanOf(camera, line)) <= options.vertical_tolerance)
      candidates.push_back(line);
  return candidates;
}

Measurement toMeasurement(const LevelledCamera& camera, const Bearing& bearing,
                          const PillarRange& range) {
  Measurement m;
  m.kind = LandmarkKind::kPillarEdge;
  m.p_robot_camera = camera.centre().head<2>();
  const bool has_range = range.verdict == PillarRange::Verdict::kMeasured;
  m.z.resize(has_range ? 2 : 1);
  m.R.setZero(m.z.size(), m.z.size());
  m.z[0] = bearing.angle;
  m.R(0, 0) = bearing.variance;
  if (has_range) {
    m.z[1] = range.range_m;
    m.R(1, 1) = range.sigma_m * range.sigma_m;
  }
  return m;
}

/// Do two lines run beside each other rather than one above the other?
bool areSideBySide(const Detection& a, const Detection& b) {
  constexpr double kShared = 0.4;  // of the rows of the shorter one
  const double top = std::max(a.a_px.y(), b.a_px.y()), bottom = std::min(a.b_px.y(), b.b_px.y());
  return bottom - top > kShared * std::min((a.b_px - a.a_px).y(), (b.b_px - b.a_px).y());
}

/// Two pieces of one edge, one above the other, are one landmark: the longer piece speaks. What
/// runs beside it, as the second edge of a frame does, is another one.
bool isSameLandmark(const Detection& a, const Detection& b, double separation) {
  const auto& m = a.measurement;
  const auto& n = b.measurement;
  if (a.appearance.gradient_sign != b.appearance.gradient_sign || areSideBySide(a, b)) return false;
  const double apart = std::abs(wrapAngle(m.z[0] - n.z[0]));
  if (apart > std::max(separation, 2.0 * std::sqrt(std::max(m.R(0, 0), n.R(0, 0))))) return false;
  if (!m.hasRange() || !n.hasRange()) return true;
  return std::abs(m.z[1] - n.z[1]) < 0.1 + 3.0 * std::sqrt(m.R(1, 1) + n.R(1, 1));
}

/// Is it seen down to the floor, as a joint over a wall's whole height is?
bool reachesFloor(const LevelledCamera& camera, const Eigen::Vector2d& end_px, double range_m,
                  const PillarOptions& options) {
  const Eigen::Vector3d ray = camera.ray(end_px);
  return camera.height() + range_m * ray.z() / ray.head<2>().norm() <= options.max_foot_m;
}

/// How wide a line of paint or a joint may seem, px with what blur adds.
int thinWidth(const Frame& frame, const PillarRange& range) {
  constexpr double kWidest_m = 0.03;
  constexpr int kUnranged_px = 4;  // out of the reach of depth all of them are so thin
  if (range.range_m <= 0.0) return kUnranged_px;
  const double across_m = range.range_m / frame.camera.fx_px;  // per px
  return std::max(3, 1 + static_cast<int>(kWidest_m / std::hypot(across_m, range.slope_m_per_px)));
}

std::string reasonToRefuse(PillarRange::Verdict verdict, double length_px,
                           const PillarOptions& options) {
  switch (verdict) {
    case PillarRange::Verdict::kNotUpright:
      return "not upright in space";
    case PillarRange::Verdict::kOnFloor:
      return "lies on the floor";
    case PillarRange::Verdict::kUnknown:
      return length_px < options.min_length_bearing_only_px ? "short and without depth" : "";
    case PillarRange::Verdict::kMeasured:
      break;
  }
  return "";
}

}  // namespace

Detections PillarDetector::detect(const Frame& frame, const EdgeLines& edges) const {
  return detect(frame, refineLines(frame.gray, edges, lines_));
}

Detections PillarDetector::detect(const Frame& frame, const RefinedLines& given) const {
  Detections detections;
  if (frame.gray.empty()) return detections;
  const LevelledCamera camera(frame);
  const DepthView depth(frame, camera);
  const double reach_m = depth.farthest_m();
  RefinedLines lines = given;
  const RefinedLines faint = faintUprights(frame.gray, camera, options_, lines_);
  lines.insert(lines.end(), faint.begin(), faint.end());
  lines = withoutDuplicates(std::move(lines), lines_.duplicate_px);
  const RefinedLines candidates = candidatesAmong(lines, camera, options_);  // longest first
  std::vector<AcrossProfile> profiles;
  for (const auto& line : candidates) profiles.emplace_back(frame.gray, line);
  const CommonLean common_lean(camera, candidates);
  const CommonWidth common_width(profiles);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto& line = candidates[i];
    const PillarRange range = measurePillarRange(depth, line, options_, geometry_);
    Detection detection;
    detection.measurement = toMeasurement(camera, bestBearing(camera, line, geometry_), range);
    detection.a_px = line.at(line.begin);
    detection.b_px = line.at(line.end);
    detection.appearance.gradient_sign = line.gradient_sign;
    detection.refusal = reasonToRefuse(range.verdict, line.length(), options_);
    if (detection.accepted() && common_lean.known() &&
        std::abs(leanOf(camera, line) - common_lean.of(line)) >
            options_.parallel_tolerance + 2.0 * std::sqrt(line.covariance(1, 1)))
      detection.refusal = "leans over";
    const AcrossProfile& profile = profiles[i];
    const bool steep = range.range_m > 0.0 && profile.steepest() > kSteepest;
    if (detection.accepted() && !steep && profile.width() > common_width.limit())
      detection.refusal = "a shade without an edge";
    if (detection.accepted()) {
      const auto seen_m = range.range_m > 0.0 ? std::optional(range.range_m) : std::nullopt;
      const bool thin = profile.isThinLine(thinWidth(frame, range));
      const UprightEdge edge{.gray = frame.gray,
                             .depth = depth,
                             .reach_m = reach_m,
                             .camera = camera,
                             .line = line,
                             .range_m = seen_m,
                             .one_sided = range.one_sided,
                             .may_fade = range.smooth && !thin,
                             .options = options_,
                             .contrast = contrastOf(frame.gray, line)};
      const SeenSpan span = seenSpan(edge, lines);
      const SpanVerdict verdict = judgeSpan(edge, span);
      detection.refusal = verdict.refusal;
      // The lines around a door's panels end below the head too, and stand beside its frame.
      const bool low = verdict.height == UprightHeight::kLow;
      detection.height = low && thin ? UprightHeight::kUnknown : verdict.height;
      detection.range_m = range.range_m;
      detection.on_surface =
          detection.accepted() && thin && (range.smooth || range.one_sided || !seen_m) &&
          !(seen_m && reachesFloor(camera, line.at(span.bottom), *seen_m, options_) &&
            !hasGapInside(edge, span));
    }
    if (detection.accepted() &&
        std::any_of(detections.begin(), detections.end(), [&](const Detection& longer) {
          return longer.accepted() && isSameLandmark(detection, longer, options_.separation);
        })) {
      continue;
    }
    if (detection.accepted()) {
      const BesideColours colours = coloursBeside(frame, line, line.begin, line.end);
      detection.appearance.left = colours.before;
      detection.appearance.right = colours.behind;
    }
    detections.push_back(std::move(detection));
  }
  refuseFalseEdges(detections, shade_);
  pairPillars(detections, options_, shade_);
  return detections;
}

}  // namespace colonnade
