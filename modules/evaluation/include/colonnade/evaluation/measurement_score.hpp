// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/measurement.hpp"
#include "colonnade/base/trajectory.hpp"
#include "colonnade/evaluation/detection_score.hpp"
#include "colonnade/filter/landmark_map.hpp"

namespace colonnade {

/// One accepted floor edge or corner; floor edges with the ends of the seen part, robot's axes.
struct MeasuredLandmark {
  Measurement measurement;
  Eigen::Vector2d p_robot_a = Eigen::Vector2d::Zero();
  Eigen::Vector2d p_robot_b = Eigen::Vector2d::Zero();
};

/// A true landmark in view, in the robot's axes; the ends of a corner are one point.
struct LandmarkInView {
  LandmarkKind kind = LandmarkKind::kDepthSlope;
  Eigen::Vector2d p_robot_a = Eigen::Vector2d::Zero();
  Eigen::Vector2d p_robot_b = Eigen::Vector2d::Zero();
};

/// What of STEM_landmarks.csv, STEM_ground_truth.tum and STEM_columns.csv each frame shows, by
/// stamp in microseconds.
using LandmarksInView = std::map<std::int64_t, std::vector<LandmarkInView>>;
LandmarksInView landmarksInView(const LandmarkMap& landmarks, const Trajectory& truth,
                                const TrueImageLines& columns);

struct MeasurementScoreOptions {
  double gate_m = 0.2;                        ///< a corner farther from every true one is false
  double gate = radians(5.0);                 ///< between the directions of floor edges
  double near_min_m = 1.5, near_max_m = 2.5;  ///< "at 2 m"
  double far_min_m = 3.4, far_max_m = 4.0;    ///< "at 3.7 m"
};

/// Scores the measurements of floor edges and depth-slope corners in metres against a simulated
/// log's truth: how far off, and whether the covariance says so.
///   nees: mean of e' R^-1 e over matched measurements, divided by their two numbers
class MeasurementScore {
 public:
  explicit MeasurementScore(const MeasurementScoreOptions& options = {}) : options_(options) {}

  void add(const std::vector<MeasuredLandmark>& measured,
           const std::vector<LandmarkInView>& in_view);

  struct Sum {
    double squares = 0.0;
    std::size_t count = 0;
    void add(double error) {
      squares += error * error;
      ++count;
    }
    std::optional<double> rms() const;
  };
  struct Kind {
    std::size_t measured = 0, matched = 0;
    Sum place, place_near, place_far;  ///< corners: distance from the true one; floor edges: of z
    Sum direction;                     ///< corners: bearing; floor edges: of the normal
    double nees_sum = 0.0;
    std::optional<double> precision() const;
    std::optional<double> nees() const;  ///< 1 when the covariance is honest
  };
  const Kind& of(LandmarkKind kind) const { return kinds_[static_cast<std::size_t>(kind)]; }

 private:
  MeasurementScoreOptions options_;
  std::array<Kind, kLandmarkKinds> kinds_{};
};

nlohmann::ordered_json toJson(const MeasurementScore& score);
std::string toText(const MeasurementScore& score);

}  // namespace colonnade
