// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "colonnade/detectors/depth_slope_pixels.hpp"
#include "colonnade/detectors/detection.hpp"
#include "colonnade/detectors/geometry_options.hpp"
#include "colonnade/evaluation/measurement_score.hpp"
#include "colonnade/simulation/random.hpp"

namespace colonnade {

/// What `detect` is asked to compare its detections with.
struct DetectScoreRequest {
  bool score = false;            ///< against the simulator's truth beside the log
  std::filesystem::path labels;  ///< or against lines drawn by hand, in the same columns
  std::vector<double> thesis_thresholds;
  SlopePixelOptions thesis;
  bool any() const { return score || !labels.empty() || !thesis_thresholds.empty(); }
};

/// Compares what is detected, frame by frame, with what is there.
class DetectScore {
 public:
  /// Reads what lies beside the log of this stem. Throws Error.
  DetectScore(const DetectScoreRequest& request, const std::string& stem);

  void add(const Frame& frame, const Detections& detections);
  bool hasFrames() const { return frames_ > 0; }
  const std::filesystem::path& table() const { return table_; }
  void addTo(nlohmann::ordered_json& json) const;
  std::string text() const;

 private:
  struct Threshold {
    double value = 0.0;
    std::size_t good = 0, bad = 0;
    std::optional<double> share() const;
  };

  DetectScoreRequest request_;
  std::filesystem::path table_;
  TrueImageLines truth_;
  LandmarksInView places_;
  DetectionScore lines_;
  MeasurementScore measurements_;
  std::vector<Threshold> thresholds_;
  std::size_t frames_ = 0;
};

/// Puts frames wrong as [Geometry] says they may be: roll, pitch and height of the camera and the
/// offset of the disparity, drawn anew for every frame. A covariance is honest if it covers that.
class MountingErrors {
 public:
  MountingErrors(const GeometryOptions& options, std::uint64_t seed)
      : options_(options), random_(seed, "mounting errors") {}
  void apply(Frame& frame);

 private:
  GeometryOptions options_;
  Random random_;
};

}  // namespace colonnade
