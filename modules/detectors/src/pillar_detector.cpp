// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/pillar_detector.hpp"

#include <algorithm>
#include <cmath>

#include "colonnade/detectors/depth_noise.hpp"
#include "colonnade/detectors/levelled_camera.hpp"
#include "colonnade/detectors/pillar_pairs.hpp"
#include "colour_sampling.hpp"
#include "line_refinement.hpp"
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

/// Direction of the vertical plane through the optical centre and one pixel of the line: equation
/// 13 of the 2015 thesis for a levelled camera. A tilt error t turns it by t * tan(elevation).
Bearing bearingAt(const LevelledCamera& camera, const RefinedLine& line, double s,
                  const GeometryOptions& geometry) {
  const Eigen::Vector3d here = camera.ray(line.at(s));
  const Eigen::Vector3d beside = camera.ray(line.at(s) + Eigen::Vector2d(1.0, 0.0));
  const double angle = std::atan2(here.y(), here.x());
  const double per_pixel = wrapAngle(std::atan2(beside.y(), beside.x()) - angle);
  const double pixels = line.variance(s) + geometry.line_sigma_px * geometry.line_sigma_px;
  const double tilt = geometry.tilt_sigma * here.z() / here.head<2>().norm();
  return {angle, per_pixel * per_pixel * pixels + tilt * tilt};
}

/// The place of the extent where the bearing is best known: near the horizon and near the middle.
Bearing bestBearing(const LevelledCamera& camera, const RefinedLine& line,
                    const GeometryOptions& geometry) {
  constexpr int kPlaces = 16;
  Bearing best = bearingAt(camera, line, line.begin, geometry);
  for (int i = 1; i <= kPlaces; ++i) {
    const double s = line.begin + (line.end - line.begin) * i / kPlaces;
    const Bearing bearing = bearingAt(camera, line, s, geometry);
    if (bearing.variance < best.variance) best = bearing;
  }
  return best;
}

/// By which a line leans over from the projected vertical in the image, radians.
double lean(const LevelledCamera& camera, const RefinedLine& line) {
  const Eigen::Vector2d along = (line.at(line.end) - line.at(line.begin)).normalized();
  const Eigen::Vector2d down = camera.downDirection(line.at(0.5 * (line.begin + line.end)));
  return std::asin(std::clamp(along.x() * down.y() - along.y() * down.x(), -1.0, 1.0));
}

bool isCandidate(const LevelledCamera& camera, const RefinedLine& line,
                 const PillarOptions& options) {
  return line.steep && line.length() >= options.min_length_px &&
         std::abs(lean(camera, line)) <= options.vertical_tolerance;
}

/// Where the camera's roll is not quite right, all verticals of a frame lean over by the same;
/// where its pitch is not, by what is linear in the column. Theil and Sen's line through all of
/// them, where there are enough of them to tell.
class CommonLean {
 public:
  CommonLean(const LevelledCamera& camera, const RefinedLines& lines,
             const PillarOptions& options) {
    constexpr std::size_t kFewest = 5;
    constexpr double kApart_px = 60.0;
    std::vector<std::pair<double, double>> leans;  // by column
    for (const auto& line : lines)
      if (isCandidate(camera, line, options))
        leans.emplace_back(middleOf(line), lean(camera, line));
    if (leans.size() < kFewest) return;
    std::vector<double> slopes, offsets;
    for (std::size_t i = 0; i < leans.size(); ++i)
      for (std::size_t j = i + 1; j < leans.size(); ++j)
        if (std::abs(leans[i].first - leans[j].first) > kApart_px)
          slopes.push_back((leans[i].second - leans[j].second) / (leans[i].first - leans[j].first));
    per_px_ = medianOf(slopes);
    for (const auto& [column, angle] : leans) offsets.push_back(angle - per_px_ * column);
    at_0_ = medianOf(offsets);
    known_ = true;
  }
  bool known() const { return known_; }
  double of(const RefinedLine& line) const { return at_0_ + per_px_ * middleOf(line); }

 private:
  static double middleOf(const RefinedLine& line) {
    return line.across(0.5 * (line.begin + line.end));
  }
  double at_0_ = 0.0, per_px_ = 0.0;
  bool known_ = false;
};

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

/// Two pieces of one edge, one above the other, are one landmark: the longer piece speaks.
bool isSameLandmark(const Detection& a, const Detection& b, double separation) {
  const auto& m = a.measurement;
  const auto& n = b.measurement;
  if (a.appearance.gradient_sign != b.appearance.gradient_sign) return false;
  const double apart = std::abs(wrapAngle(m.z[0] - n.z[0]));
  if (apart > std::max(separation, 2.0 * std::sqrt(std::max(m.R(0, 0), n.R(0, 0))))) return false;
  if (!m.hasRange() || !n.hasRange()) return true;
  return std::abs(m.z[1] - n.z[1]) < 0.1 + 3.0 * std::sqrt(m.R(1, 1) + n.R(1, 1));
}

/// Does depth beside most of a line not show a surface at this range? Where depth is missing it does
/// not.
bool isElsewhere(const DepthView& depth, const RefinedLine& line, double range_m) {
  constexpr int kPlaces = 8;
  constexpr double kBeside_px = 5.0;
  const double tolerance_m = 0.1 + 3.0 * kinectDepthSigma(range_m);
  int here = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const double v = line.begin + (line.end - line.begin) * (i + 0.5) / kPlaces;
    const auto left = depth.at(line.at(v) - Eigen::Vector2d(kBeside_px, 0.0));
    const auto right = depth.at(line.at(v) + Eigen::Vector2d(kBeside_px, 0.0));
    if (!left && !right) continue;  // nothing where depth reaches
    const double nearer =
        std::min(left ? left->range_m : right->range_m, right ? right->range_m : left->range_m);
    here += std::abs(nearer - range_m) < tolerance_m ? 1 : 0;
  }
  return 2 * here < kPlaces;
}

/// The rows of a line and of all others that lie on it, above and below, with the same gradient.
/// Not what lies below the floor at the line's range, a joint or a reflection there, nor what depth
/// shows to be nearer or farther.
SeenSpan spanOf(const RefinedLine& line, const RefinedLines& lines, const LevelledCamera& camera,
                const DepthView& depth, std::optional<double> range_m) {
  constexpr double kBeside_px = 2.5;
  constexpr double kBelowFloor_m = 0.15;
  SeenSpan span{line.begin, line.end};
  for (const auto& other : lines) {
    if (!other.steep || other.gradient_sign != line.gradient_sign) continue;
    const auto apart = [&](double s) { return std::abs(other.across(s) - line.across(s)); };
    if (std::max(apart(other.begin), apart(other.end)) > kBeside_px) continue;
    const Eigen::Vector3d lowest = camera.ray(line.at(other.end));
    if (range_m &&
        camera.height() + *range_m * lowest.z() / lowest.head<2>().norm() < -kBelowFloor_m)
      continue;
    if (range_m && isElsewhere(depth, other, *range_m)) continue;
    span.top = std::min(span.top, other.begin);
    span.bottom = std::max(span.bottom, other.end);
  }
  return span;
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
  RefinedLines lines = given;
  const RefinedLines faint = faintUprights(frame.gray, camera, options_, lines_);
  lines.insert(lines.end(), faint.begin(), faint.end());
  lines = withoutDuplicates(std::move(lines), lines_.duplicate_px);
  const CommonLean common_lean(camera, lines, options_);
  for (const auto& line : lines) {  // longest first
    if (!isCandidate(camera, line, options_)) continue;
    const PillarRange range = measurePillarRange(depth, line, options_, geometry_);
    Detection detection;
    detection.measurement = toMeasurement(camera, bestBearing(camera, line, geometry_), range);
    detection.a_px = line.at(line.begin);
    detection.b_px = line.at(line.end);
    detection.appearance.gradient_sign = line.gradient_sign;
    detection.appearance.left = meanColourBeside(frame, line, line.begin, line.end, -1);
    detection.appearance.right = meanColourBeside(frame, line, line.begin, line.end, 1);
    detection.refusal = reasonToRefuse(range.verdict, line.length(), options_);
    if (detection.accepted() && common_lean.known() &&
        std::abs(lean(camera, line) - common_lean.of(line)) >
            options_.parallel_tolerance + 2.0 * std::sqrt(line.covariance(1, 1)))
      detection.refusal = "leans over";
    if (detection.accepted()) {
      const AcrossProfile profile(frame.gray, line);
      const auto seen_m = range.range_m > 0.0 ? std::optional(range.range_m) : std::nullopt;
      const SeenSpan span = spanOf(line, lines, camera, depth, seen_m);
      detection.refusal = profile.isShade() ? "a shade without an edge"
                                            : reasonAgainstSpan(frame.gray, depth, camera, line,
                                                                span, seen_m, options_);
      detection.on_surface =
          (range.smooth || !seen_m) && profile.isThinLine(thinWidth(frame, range)) &&
          !(seen_m && reachesFloor(camera, line.at(span.bottom), *seen_m, options_));
    }
    if (detection.accepted() &&
        std::any_of(detections.begin(), detections.end(), [&](const Detection& longer) {
          return longer.accepted() && isSameLandmark(detection, longer, options_.separation);
        })) {
      continue;
    }
    detections.push_back(detection);
  }
  refuseFalseEdges(detections, shade_);
  pairPillars(detections, options_, shade_);
  return detections;
}

}  // namespace colonnade
