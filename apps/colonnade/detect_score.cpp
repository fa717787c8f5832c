// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "detect_score.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "colonnade/base/text.hpp"
#include "colonnade/maps/landmark_csv.hpp"

namespace colonnade {
namespace {

namespace fs = std::filesystem;

std::vector<ImageLine> acceptedLines(const Frame& frame, const Detections& detections) {
  std::vector<ImageLine> lines;
  for (const Detection& d : detections) {
    if (!d.accepted() || d.on_surface) continue;  // no pillar edge, and said to be none
    const bool ranged = d.measurement.hasRange();
    const auto inside = clipped(
        {d.kind(), d.a_px, d.b_px, ranged ? std::optional(d.measurement.z(1)) : std::nullopt},
        frame.camera.width_px, frame.camera.height_px);
    if (inside) lines.push_back(*inside);
  }
  return lines;
}

std::vector<MeasuredLandmark> acceptedMeasurements(const Detections& detections) {
  std::vector<MeasuredLandmark> measured;
  for (const Detection& d : detections)
    if (d.accepted()) measured.push_back({d.measurement, d.p_robot_a, d.p_robot_b});
  return measured;
}

/// Empty where the map or the trajectory does not lie beside the log.
LandmarksInView landmarksBeside(const std::string& stem, const TrueImageLines& columns) {
  const fs::path map = stem + "_landmarks.csv", trajectory = stem + "_ground_truth.tum";
  if (!fs::exists(map) || !fs::exists(trajectory)) return {};
  return landmarksInView(readLandmarksCsv(map), readTum(trajectory), columns);
}

/// Whether a pixel lies on a vertical edge of the building.
bool liesOnEdge(const SlopePixel& pixel, const std::vector<TrueImageLine>& there,
                double tolerance_px) {
  return std::any_of(there.begin(), there.end(), [&](const TrueImageLine& line) {
    if (line.kind == LandmarkKind::kFloorEdge || line.true_class == TrueClass::kPane) return false;
    const Eigen::Vector2d way = line.b_px - line.a_px;
    const double low = std::min(line.a_px.y(), line.b_px.y());
    const double high = std::max(line.a_px.y(), line.b_px.y());
    if (pixel.v < low - tolerance_px || pixel.v > high + tolerance_px) return false;
    const double t = std::abs(way.y()) > 1e-6 ? (pixel.v - line.a_px.y()) / way.y() : 0.5;
    return std::abs(line.a_px.x() + t * way.x() - pixel.u) <= tolerance_px;
  });
}

}  // namespace

std::optional<double> DetectScore::Threshold::share() const {
  if (good + bad == 0) return std::nullopt;
  return static_cast<double>(good) / static_cast<double>(good + bad);
}

DetectScore::DetectScore(const DetectScoreRequest& request, const std::string& stem)
    : request_(request),
      table_(request.labels.empty() ? fs::path(stem + "_columns.csv") : request.labels),
      truth_(readColumnsCsv(table_)) {
  if (request.labels.empty()) places_ = landmarksBeside(stem, truth_);
  for (const double value : request.thesis_thresholds) thresholds_.push_back({value});
}

void DetectScore::add(const Frame& frame, const Detections& detections) {
  const std::int64_t stamp = microseconds(frame.stamp_s);
  const auto there = truth_.find(stamp);
  frames_ += there != truth_.end() ? 1 : 0;
  // Of labelled logs most frames have no labels. A simulated frame that shows nothing true has no
  // row: whatever is detected in it is false.
  if (there == truth_.end() && !request_.labels.empty()) return;
  static const std::vector<TrueImageLine> kNothing;
  const auto& lines = there != truth_.end() ? there->second : kNothing;
  lines_.add(acceptedLines(frame, detections), lines);
  if (!places_.empty()) measurements_.add(acceptedMeasurements(detections), places_[stamp]);
  for (auto& threshold : thresholds_)
    for (const auto& pixel : findSlopePixels(frame, threshold.value, request_.thesis))
      ++(liesOnEdge(pixel, lines, lines_.options().tolerance_px) ? threshold.good : threshold.bad);
}

void DetectScore::addTo(nlohmann::ordered_json& json) const {
  json["score"] = toJson(lines_);
  if (!places_.empty()) json["measurements"] = toJson(measurements_);
  for (const auto& threshold : thresholds_) {
    const auto share = threshold.share();
    json["thesis_thresholds"].push_back(
        {{"threshold", threshold.value},
         {"good", threshold.good},
         {"bad", threshold.bad},
         {"good_share", share ? nlohmann::ordered_json(*share) : nlohmann::ordered_json()}});
  }
}

std::string DetectScore::text() const {
  std::string text = toText(lines_);
  if (!places_.empty()) text += toText(measurements_);
  if (!thresholds_.empty())
    text += "the rule of the 2012 thesis, pixels on a vertical edge and not, " +
            std::to_string(frames_) + " frames\n";
  for (const auto& threshold : thresholds_) {
    const auto share = threshold.share();
    text += "threshold   " + formatFixed(threshold.value, 0) + ": " +
            std::to_string(threshold.good) + " good, " + std::to_string(threshold.bad) + " bad, " +
            (share ? formatFixed(100.0 * *share, 1) + " % good" : std::string("-")) + "\n";
  }
  return text;
}

void MountingErrors::apply(Frame& frame) {
  const double roll = options_.tilt_sigma * random_.normal();
  const double pitch = options_.tilt_sigma * random_.normal();
  const double up_m = options_.height_sigma_m * random_.normal();
  const double offset = options_.depth_bias_per_m2 * random_.normal();  // of inverse depth
  frame.T_robot_camera.linear() = Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()) *
                                  Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                                  frame.T_robot_camera.linear();
  frame.T_robot_camera.translation().z() += up_m;
  if (frame.depth_m.type() != CV_32FC1) return;
  frame.depth_m = frame.depth_m.clone();
  for (int v = 0; v < frame.depth_m.rows; ++v) {
    auto* z_m = frame.depth_m.ptr<float>(v);
    for (int u = 0; u < frame.depth_m.cols; ++u) {
      const auto z = static_cast<double>(z_m[u]);
      const double inverse = 1.0 / z + offset;
      if (z > 0.0 && inverse > 0.0) z_m[u] = static_cast<float>(1.0 / inverse);
    }
  }
}

}  // namespace colonnade
