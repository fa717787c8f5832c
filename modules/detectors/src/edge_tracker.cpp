// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/edge_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace colonnade {
namespace {

double colourDistance(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return static_cast<double>((a - b).cwiseAbs().mean());
}

/// The width of the pair an edge belongs to: metres where both edges have range, else pixels.
std::pair<double, bool> widthOf(const Detections& all, const Detection& detection) {
  if (!detection.partner) return {0.0, false};
  if (detection.width_m > 0.0) return {detection.width_m, true};
  const Detection& other = all[*detection.partner];
  const auto sum = detection.a_px + detection.b_px - other.a_px - other.b_px;
  return {0.5 * std::abs(sum.x()), false};
}

}  // namespace

const char* name(EdgeTracker::Phase phase) {
  switch (phase) {
    case EdgeTracker::Phase::kLearning:
      return "learning";
    case EdgeTracker::Phase::kChecking:
      return "checking";
    case EdgeTracker::Phase::kConfirmed:
      return "confirmed";
  }
  return "";
}

const EdgeTracker::Track* EdgeTracker::find(int id) const {
  const auto found =
      std::find_if(tracks_.begin(), tracks_.end(), [&](const Track& t) { return t.id == id; });
  return found == tracks_.end() ? nullptr : &*found;
}

/// Where a static line appears after the motion. Without range its bearing turns with the robot
/// and may change by what the way does to the nearest possible line.
void EdgeTracker::predict(Track& track, const Pose2& T_previous_robot) const {
  track.moved += T_previous_robot.translation().norm();
  Measurement& m = track.seen;
  if (!m.hasRange()) {
    m.z[0] = wrapAngle(m.z[0] - T_previous_robot.phi);
    return;
  }
  const Eigen::Vector2d p_previous =
      m.p_robot_camera + m.z[1] * Eigen::Vector2d(std::cos(m.z[0]), std::sin(m.z[0]));
  const Eigen::Vector2d offset =
      transform(T_previous_robot.inverse(), p_previous) - m.p_robot_camera;
  m.z[0] = std::atan2(offset.y(), offset.x());
  m.z[1] = offset.norm();
}

/// How badly a detection fits, 0 to 1; nothing: not at all.
std::optional<double> EdgeTracker::mismatch(const Track& track, const Detection& detection) const {
  const Measurement &m = track.seen, &n = detection.measurement;
  if (detection.appearance.gradient_sign != track.appearance.gradient_sign) return std::nullopt;
  double gate = options_.gate + 3.0 * std::sqrt(m.R(0, 0) + n.R(0, 0));
  if (!m.hasRange()) gate += track.moved / options_.nearest_m;
  const double off = std::abs(wrapAngle(m.z[0] - n.z[0])) / gate;
  const double colour =
      std::max(colourDistance(track.appearance.left, detection.appearance.left),
               colourDistance(track.appearance.right, detection.appearance.right)) /
      options_.colour_tolerance;
  double range = 0.0;
  if (m.hasRange() && n.hasRange())
    range = std::abs(m.z[1] - n.z[1]) / (options_.gate_m + 3.0 * std::sqrt(m.R(1, 1) + n.R(1, 1)));
  const double worst = std::max({off, colour, range});
  if (worst > 1.0) return std::nullopt;
  return (off + colour + range) / 3.0;
}

bool EdgeTracker::agreesInWidth(const Track& track, const Detections& all,
                                const Detection& detection) const {
  const auto [width, in_metres] = widthOf(all, detection);
  if (width <= 0.0 || track.width <= 0.0 || in_metres != track.width_in_metres) return true;
  return std::abs(width - track.width) < options_.width_tolerance * track.width;
}

/// While learning every sighting counts alike, later the mean forgets slowly.
void EdgeTracker::take(Track& track, const Detections& all, const Detection& detection) const {
  ++track.seen_frames;
  track.seen = detection.measurement;
  track.missed = 0;
  track.moved = 0.0;
  const int weight = std::min(track.seen_frames, options_.learning_frames);
  const auto blend = [&](Eigen::Vector3f& mean, const Eigen::Vector3f& now) {
    mean += (now - mean) / static_cast<float>(weight);
  };
  blend(track.appearance.left, detection.appearance.left);
  blend(track.appearance.right, detection.appearance.right);
  const auto [width, in_metres] = widthOf(all, detection);
  if (width <= 0.0) return;
  if (track.width <= 0.0 || in_metres != track.width_in_metres) track.width = width;
  track.width_in_metres = in_metres;
  track.width += (width - track.width) / weight;
}

void EdgeTracker::advance(Track& track, int learning, int checking) const {
  ++track.age;
  ++track.in_phase;
  const auto begin = [&](Phase phase) {
    track.phase = phase;
    track.in_phase = track.hits = track.misses = 0;
  };
  if (track.phase == Phase::kLearning && track.in_phase >= learning) {
    begin(Phase::kChecking);
  } else if (track.phase == Phase::kChecking && track.in_phase >= checking) {
    begin(track.hits > track.misses ? Phase::kConfirmed : Phase::kLearning);
  }
}

std::vector<std::optional<int>> EdgeTracker::step(const Detections& detections,
                                                  const Pose2& T_previous_robot, double elapsed_s) {
  const double speed_m_s =
      elapsed_s > 0.0 ? T_previous_robot.translation().norm() / elapsed_s : 0.0;
  const double scale = std::min(1.0, options_.cycle_speed_m_s / std::max(speed_m_s, 1e-9));
  const auto scaled = [&](int frames) {
    return std::max(options_.least_frames, static_cast<int>(std::lround(scale * frames)));
  };
  std::vector<std::optional<int>> ids(detections.size());
  std::vector<std::tuple<double, std::size_t, std::size_t>> fits;
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    predict(tracks_[t], T_previous_robot);
    for (std::size_t d = 0; d < detections.size(); ++d) {
      const auto& detection = detections[d];
      if (!detection.accepted() || detection.kind() != LandmarkKind::kPillarEdge) continue;
      if (const auto bad = mismatch(tracks_[t], detection)) fits.emplace_back(*bad, t, d);
    }
  }
  std::sort(fits.begin(), fits.end());
  std::vector<bool> followed(tracks_.size(), false);
  for (const auto& [bad, t, d] : fits) {
    if (followed[t] || ids[d]) continue;
    Track& track = tracks_[t];
    followed[t] = true;
    ids[d] = track.id;
    ++(agreesInWidth(track, detections, detections[d]) ? track.hits : track.misses);
    take(track, detections, detections[d]);
  }
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    if (!followed[t]) ++tracks_[t].misses, ++tracks_[t].missed;
    advance(tracks_[t], scaled(options_.learning_frames), scaled(options_.checking_frames));
  }
  std::erase_if(tracks_, [&](const Track& track) { return track.missed > options_.max_missed; });
  for (std::size_t d = 0; d < detections.size(); ++d) {
    const auto& detection = detections[d];
    if (ids[d] || !detection.accepted() || detection.kind() != LandmarkKind::kPillarEdge) continue;
    Track track;
    track.id = next_id_++;
    track.appearance = detection.appearance;
    track.hits = 1;
    take(track, detections, detection);
    advance(track, scaled(options_.learning_frames), scaled(options_.checking_frames));
    ids[d] = track.id;
    tracks_.push_back(track);
  }
  return ids;
}

}  // namespace colonnade
