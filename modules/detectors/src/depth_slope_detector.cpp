// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/depth_slope_detector.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "colonnade/detectors/depth_noise.hpp"
#include "colonnade/detectors/levelled_camera.hpp"
#include "plane_fit.hpp"

namespace colonnade {
namespace {

using Points = std::vector<Eigen::Vector2d>;

/// The valid columns of one profile, or of one of its bands, left to right.
Points validPoints(const DepthProfile& profile, int band) {
  Points points;
  points.reserve(profile.columns.size());
  for (const auto& column : profile.columns) {
    const double z = band < 0 ? column.z : column.band_z[static_cast<std::size_t>(band)];
    if (z > 0.0) points.emplace_back(column.slope * z, z);
  }
  return points;
}

struct Candidate {
  std::size_t index = 0;  ///< of the near point
  Eigen::Vector2d p_slice = Eigen::Vector2d::Zero();
  bool jump = false;
  bool far_on_right = false;
  double strength = 0.0;
  double turn = 0.0;     ///< corners: angle between both sides
  double sigma_m = 0.0;  ///< of the place, beyond one pixel and the depth noise
};

class Corners {
 public:
  Corners(const DepthProfile& profile, const DepthSlopeOptions& options)
      : profile_(profile), options_(options) {}

  double noise(double z) const { return kinectDepthSigma(z); }

  /// True when the surface does not go on from point i to its neighbour j.
  bool isJump(const Points& points, std::size_t i, std::size_t j) const {
    const double step = std::abs(points[j].y() - points[i].y());
    return step > options_.min_jump_m + 3.0 * noise(std::max(points[i].y(), points[j].y()));
  }

  /// The surface beside point i, within the window and up to the next jump.
  std::optional<SliceLine> side(const Points& points, std::size_t i, int direction,
                                int skip) const {
    Points window;
    std::size_t at = i;
    int left_out = skip;
    while (true) {
      if (direction < 0 && at == 0) break;
      const std::size_t next = direction < 0 ? at - 1 : at + 1;
      if (next >= points.size() || isJump(points, at, next)) break;
      at = next;
      if ((points[at] - points[i]).norm() > options_.window_m) break;
      if (left_out-- > 0) continue;
      window.push_back(points[at]);
    }
    if (static_cast<int>(window.size()) < options_.min_columns) return std::nullopt;
    const SliceLine line = fitSliceLine(window);
    if (line.spread_m2 < 1e-6) return std::nullopt;
    return line;
  }

  std::optional<Candidate> corner(const Points& points, std::size_t i) const {
    const auto left = side(points, i, -1, 1);
    const auto right = side(points, i, 1, 1);
    if (!left || !right) return std::nullopt;
    const double straight_m = 0.01 + 1.5 * noise(points[i].y());
    if (left->rms_m > straight_m || right->rms_m > straight_m) return std::nullopt;
    const double sine = left->along.x() * right->along.y() - left->along.y() * right->along.x();
    const double turn = std::asin(std::clamp(std::abs(sine), 0.0, 1.0));
    if (turn < options_.min_turn) return std::nullopt;
    static constexpr double kSteepest = 20.0;
    const auto slope = [](const SliceLine& line) {
      return std::clamp(line.along.y() / std::max(line.along.x(), 1e-9), -kSteepest, kSteepest);
    };
    const double change = slope(*right) - slope(*left);
    if (std::abs(change) < options_.min_slope_change) return std::nullopt;
    if (change < 0.0 && !options_.concave) return std::nullopt;  // z falls off towards the corner
    const Eigen::Vector2d between = right->centre - left->centre;
    const double t = (between.x() * right->along.y() - between.y() * right->along.x()) / sine;
    Candidate candidate;
    candidate.index = i;
    candidate.p_slice = left->centre + t * left->along;
    candidate.turn = turn;
    const auto sigma = [](const SliceLine& line, const Eigen::Vector2d& p, double noise_m) {
      const double reach = (p - line.centre).squaredNorm();
      constexpr double kShared = 6.0;  // neighbouring columns share their error
      const double error = std::max(line.rms_m, 0.3 * noise_m);
      return error * std::sqrt(kShared * (1.0 / line.points + reach / line.spread_m2));
    };
    const double n = noise(points[i].y());
    candidate.sigma_m =
        std::hypot(sigma(*left, candidate.p_slice, n), sigma(*right, candidate.p_slice, n)) /
        std::abs(sine);
    const double off_m = (candidate.p_slice - points[i]).norm();
    if (off_m > 0.04 + 2.0 * n + 3.0 * points[i].y() / profile_.focal_px) return std::nullopt;
    candidate.strength = turn / (1.0 + off_m / 0.02);
    return candidate;
  }

  std::optional<Candidate> jump(const Points& points, std::size_t i, std::size_t j) const {
    if (!isJump(points, i, j)) return std::nullopt;
    const bool right_is_far = points[j].y() > points[i].y();
    const std::size_t near = right_is_far ? i : j;
    const std::size_t far = right_is_far ? j : i;
    const auto surface = side(points, near, right_is_far ? -1 : 1, 0);
    if (!surface) return std::nullopt;
    if (surface->rms_m > 0.03 + 2.0 * noise(points[near].y())) return std::nullopt;
    // An oblique wall goes on where its continuation meets the far column.
    const Eigen::Vector2d ray = points[far].normalized();
    const double sine = surface->along.x() * ray.y() - surface->along.y() * ray.x();
    if (std::abs(sine) > 1e-3) {
      const double range =
          (surface->along.x() * surface->centre.y() - surface->along.y() * surface->centre.x()) /
          sine;
      if (range > 0.0 && std::abs(range - points[far].norm()) < options_.min_jump_m)
        return std::nullopt;
    }
    Candidate candidate;
    candidate.index = near;
    candidate.p_slice = points[near];
    candidate.jump = true;
    candidate.far_on_right = right_is_far;
    candidate.strength = 2.0 + std::abs(points[far].y() - points[near].y());
    candidate.sigma_m = 0.5 * noise(points[near].y());
    return candidate;
  }

  /// The same corner in one band of heights: near in place and, for corners, in turn.
  bool agrees(const Points& band, const Candidate& candidate) const {
    const double reach_m =
        0.05 + 2.0 * noise(candidate.p_slice.y()) + 3.0 * candidate.p_slice.y() / profile_.focal_px;
    for (std::size_t i = 0; i < band.size(); ++i) {
      if ((band[i] - candidate.p_slice).norm() > reach_m) continue;
      if (candidate.jump) {
        const std::size_t j = candidate.far_on_right ? i + 1 : i - 1;
        if (j < band.size() && isJump(band, i, j) && band[j].y() > band[i].y()) return true;
      } else if (const auto other = corner(band, i)) {
        if ((other->p_slice - candidate.p_slice).norm() < reach_m &&
            std::abs(other->turn - candidate.turn) < radians(25.0)) {
          return true;
        }
      }
    }
    return false;
  }

  std::vector<Candidate> find(const Points& points) const {
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double range_m = points[i].norm();
      if (range_m < options_.min_range_m || range_m > options_.max_range_m) continue;
      std::optional<Candidate> best;
      if (options_.occlusions) {
        if (i + 1 < points.size()) best = jump(points, i, i + 1);
        if (best && best->index != i) best.reset();
        if (!best && i > 0) best = jump(points, i - 1, i);
        if (best && best->index != i) best.reset();
      }
      if (!best) best = corner(points, i);
      if (best) candidates.push_back(*best);
    }
    return candidates;
  }

 private:
  const DepthProfile& profile_;
  const DepthSlopeOptions& options_;
};

/// The strongest candidate of each neighbourhood.
std::vector<Candidate> strongest(std::vector<Candidate> candidates, double separation_m) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.strength > b.strength; });
  std::vector<Candidate> kept;
  for (const auto& candidate : candidates) {
    if (std::none_of(kept.begin(), kept.end(), [&](const Candidate& better) {
          return (better.p_slice - candidate.p_slice).norm() < separation_m;
        })) {
      kept.push_back(candidate);
    }
  }
  return kept;
}

Detection toDetection(const DepthProfile& profile, const Candidate& candidate,
                      const LevelledCamera& camera, const DepthProfileOptions& slice,
                      const GeometryOptions& geometry) {
  const Eigen::Vector2d offset = profile.R_robot_slice * candidate.p_slice;
  const double range_m = offset.norm();
  // Depth edges of structured light wander by pixels, intersections of surfaces do not.
  const double pixels = candidate.jump ? 2.0 : 0.7;
  const double lateral_m = std::hypot(pixels / profile.focal_px * range_m, candidate.sigma_m,
                                      0.3 * geometry.tilt_sigma * range_m);
  const double axial_m =
      std::hypot(std::hypot(0.7 * kinectDepthSigma(candidate.p_slice.y()), candidate.sigma_m),
                 depthBiasSigma(candidate.p_slice.y(), geometry.depth_bias_per_m2), 0.01);
  Detection detection;
  auto& m = detection.measurement;
  m.kind = LandmarkKind::kDepthSlope;
  m.p_robot_camera = profile.p_robot_camera;
  m.z.resize(2);
  m.z << std::atan2(offset.y(), offset.x()), range_m;
  m.R.setZero(2, 2);
  m.R.diagonal() << lateral_m * lateral_m / (range_m * range_m), axial_m * axial_m;
  const Eigen::Vector2d p_robot = profile.p_robot_camera + offset;
  const auto top = camera.project({p_robot.x(), p_robot.y(), slice.max_height_m});
  const auto bottom = camera.project({p_robot.x(), p_robot.y(), slice.min_height_m});
  if (top) detection.a_px = *top;
  if (bottom) detection.b_px = *bottom;
  return detection;
}

}  // namespace

Detections DepthSlopeDetector::detect(const Frame& frame, const EdgeLines& /*edges*/) const {
  return detect(frame, makeDepthProfile(frame, profile_));
}

Detections DepthSlopeDetector::detect(const Frame& frame, const DepthProfile& profile) const {
  Detections detections;
  if (profile.empty()) return detections;
  const LevelledCamera camera(frame);
  const Corners corners(profile, options_);
  const Points points = validPoints(profile, -1);
  Points bands[DepthProfile::kBands];
  for (int band = 0; band < DepthProfile::kBands; ++band) bands[band] = validPoints(profile, band);
  for (const auto& candidate : strongest(corners.find(points), options_.separation_m)) {
    Detection detection = toDetection(profile, candidate, camera, profile_, geometry_);
    const auto agreeing =
        std::count_if(std::begin(bands), std::end(bands),
                      [&](const Points& band) { return corners.agrees(band, candidate); });
    if (agreeing < options_.min_bands) detection.refusal = "not the same at all heights";
    detections.push_back(std::move(detection));
  }
  return detections;
}

}  // namespace colonnade
