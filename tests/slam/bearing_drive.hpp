// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <random>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/slam/association.hpp"
#include "colonnade/slam/initializer.hpp"

namespace colonnade {

/// A robot with a forward camera that measures bearings alone, on its way between pillars. Errors
/// are white, so the filter is told that they are.
class BearingDrive {
 public:
  struct Noise {
    double bearing = radians(0.3);
    double step_m = 0.004;  ///< standard deviations of one step of 0.1 m
    double step_turn = radians(0.1);
  };

  BearingDrive(const InitializationOptions& options, const AssociationOptions& association,
               Noise noise, unsigned seed)
      : filter_(whiteErrors()),
        associator_(association),
        initializer_(options),
        noise_(noise),
        generator_(seed) {}

  /// One step of the robot and one picture. `outliers`: bearings of nothing.
  void step(const Pose2& u, const std::vector<Eigen::Vector2d>& pillars, int outliers = 0) {
    truth_ = truth_ * Pose2{u.x + noise_.step_m * normal(), u.y + noise_.step_m * normal(),
                            u.phi + noise_.step_turn * normal()};
    const double way2 = noise_.step_m * noise_.step_m;
    filter_.predict(u,
                    Eigen::Vector3d(way2, way2, noise_.step_turn * noise_.step_turn).asDiagonal());
    Detections detections;
    for (const Eigen::Vector2d& pillar : pillars)
      if (const auto bearing = seen(pillar, pillars))
        detections.push_back(detection(*bearing + noise_.bearing * normal()));
    std::uniform_real_distribution<double> anywhere(-radians(35.0), radians(35.0));
    for (int i = 0; i < outliers; ++i) detections.push_back(detection(anywhere(generator_)));
    process(detections);
  }

  void process(const Detections& detections) {
    Frame frame;
    frame.index = index_++;
    frame.stamp_s = 0.1 * static_cast<double>(frame.index);
    last_ = associator_.match(detections, filter_, book_);
    const auto used = filter_.update(last_.matches);
    for (std::size_t i = 0; i < used.size(); ++i)
      if (used[i])
        book_.observe(last_.matches[i].landmark, detections[last_.detection_of_match[i]],
                      frame.stamp_s, filter_);
    initializer_.step(frame, detections, last_, filter_, book_, events_);
    filter_.settleInverseDepths();
  }

  Detection detection(double bearing) const {
    Detection d;
    d.measurement.kind = LandmarkKind::kPillarEdge;
    d.measurement.z.resize(1);
    d.measurement.R.resize(1, 1);
    d.measurement.z << bearing;
    d.measurement.R << std::max(noise_.bearing, radians(0.05)) *
                           std::max(noise_.bearing, radians(0.05));
    d.appearance.gradient_sign = 1;
    return d;
  }

  const EkfSlam& filter() const { return filter_; }
  const Pose2& truth() const { return truth_; }
  const std::vector<Event>& events() const { return events_; }
  const Association& last() const { return last_; }

 private:
  static FilterOptions whiteErrors() {
    FilterOptions options;
    options.error_correlation_s = 0.0;
    return options;
  }
  /// The bearing of a pillar in view that no nearer one covers or runs along.
  std::optional<double> seen(const Eigen::Vector2d& pillar,
                             const std::vector<Eigen::Vector2d>& all) const {
    const auto polar = [&](const Eigen::Vector2d& p_world) {
      const Eigen::Vector2d p = transform(truth_.inverse(), p_world);
      return std::pair(std::atan2(p.y(), p.x()), p.norm());
    };
    const auto [bearing, distance] = polar(pillar);
    if (std::abs(bearing) > radians(35.0) || distance > 12.0 || distance < 0.5) return {};
    for (const Eigen::Vector2d& other : all) {
      const auto [direction, near] = polar(other);
      if (near < distance && std::abs(direction - bearing) < 0.15 / near + radians(1.0)) return {};
    }
    return bearing;
  }
  double normal() { return normal_(generator_); }

  EkfSlam filter_;
  LandmarkBook book_;
  Associator associator_;
  Initializer initializer_;
  Noise noise_;
  std::mt19937 generator_;
  std::normal_distribution<double> normal_;
  Pose2 truth_;
  std::size_t index_ = 0;
  std::vector<Event> events_;
  Association last_;
};

}  // namespace colonnade
