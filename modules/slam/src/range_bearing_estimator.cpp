// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/range_bearing_estimator.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "colonnade/base/error.hpp"
#include "range_bearing_alike.hpp"
#include "range_bearing_beam.hpp"
#include "range_bearing_joint.hpp"

namespace colonnade {
namespace {

/// MRPT's CRangeBearingKFSLAM2D has these where nobody states a sigma.
constexpr double kRangeSigma_m = 0.1;
constexpr double kBearingSigma = radians(0.5);
constexpr double kLongestRange_m = 1e4;
/// A frame with more readings is explained by the likeliest history alone.
constexpr std::size_t kMostBeamReadings = 64;

double firstPositive(double a, double b, double otherwise) {
  return a > 0.0 ? a : (b > 0.0 ? b : otherwise);
}

/// A reading in the plane of the robot: MRPT's pitch is positive downwards, as in CPose3D.
std::optional<Measurement> levelled(const RangeBearing& reading, const RangeBearingScan& scan,
                                    const RangeBearingOptions& options) {
  if (!std::isfinite(reading.yaw) || !std::isfinite(reading.pitch)) return std::nullopt;
  const bool ranged = !options.bearing_only;
  if (ranged && !(reading.range_m > 0.0 && reading.range_m < kLongestRange_m)) return std::nullopt;
  const Eigen::Vector3d ray(std::cos(reading.yaw) * std::cos(reading.pitch),
                            std::sin(reading.yaw) * std::cos(reading.pitch),
                            -std::sin(reading.pitch));
  const Eigen::Vector2d flat = (scan.T_robot_sensor.linear() * ray).head<2>();
  const double range_sigma =
      firstPositive(options.range_sigma_m, scan.range_sigma_m, kRangeSigma_m);
  const double bearing_sigma = firstPositive(options.bearing_sigma, scan.yaw_sigma, kBearingSigma);
  const Eigen::Index size = ranged ? 2 : 1;
  Measurement m;
  m.kind = LandmarkKind::kPillarEdge;
  m.p_robot_camera = scan.T_robot_sensor.translation().head<2>();
  const Eigen::Vector3d axis = scan.T_robot_sensor.linear().col(0);
  m.camera_direction = std::atan2(axis.y(), axis.x());
  m.z.resize(size);
  m.R.setZero(size, size);
  m.z(0) = std::atan2(flat.y(), flat.x());
  m.R(0, 0) = bearing_sigma * bearing_sigma;
  if (ranged) {
    m.z(1) = reading.range_m * flat.norm();
    m.R(1, 1) = range_sigma * range_sigma;
  }
  if (reading.covariance && options.bearing_sigma == 0.0 && options.range_sigma_m == 0.0) {
    const Eigen::Matrix2d& C = *reading.covariance;  // range first
    if (ranged)
      m.R << C(1, 1), C(1, 0), C(0, 1), C(0, 0);
    else
      m.R(0, 0) = C(1, 1);
  }
  return m.z.allFinite() && m.R.allFinite() && m.p_robot_camera.allFinite() ? std::optional(m)
                                                                            : std::nullopt;
}

Eigen::Matrix2d turnOf(const RangeBearingHypothesis& hypothesis) {
  return Eigen::Rotation2Dd(hypothesis.T_world_start.phi).toRotationMatrix();
}

}  // namespace

struct RangeBearingEstimator::Impl {
  explicit Impl(const RangeBearingOptions& o) : options(o) {
    if (options.bearing_only && !options.use_ids)
      throw Error("RangeBearing.bearing_only needs identities: leave use_ids = true",
                  ExitCode::kUsage);
  }

  RangeBearingOptions options;
  std::vector<RangeBearingHypothesis> hypotheses;  ///< likeliest first
  ReadingHistories histories;
  std::size_t frames = 0;
  double former_stamp_s = std::numeric_limits<double>::infinity();

  /// The readings that can be used, with their places in the scan.
  ReadingFrame take(double stamp_s, const RangeBearingScan& scan,
                    std::vector<std::size_t>& places) {
    ReadingFrame frame;
    frame.stamp_s = stamp_s;
    frame.index = frames;
    frame.noise_scale = correlatedNoiseScale(stamp_s - former_stamp_s, options.error_correlation_s);
    for (std::size_t i = 0; i < scan.readings.size(); ++i) {
      const RangeBearing& reading = scan.readings[i];
      const int identity = options.use_ids ? reading.id : -1;
      if (const auto measurement = levelled(reading, scan, options)) {
        if (options.bearing_only && identity < 0)
          throw Error(
              "RangeBearing.bearing_only needs identities, and this log has a reading "
              "without one (or use_ids is false)",
              ExitCode::kUsage);
        frame.readings.push_back({*measurement, identity});
        places.push_back(i);
      } else {
        for (auto& hypothesis : hypotheses)
          hypothesis.filter.health().refuse("reading not finite or out of range");
      }
    }
    return frame;
  }

  /// Whether the likeliest history's filter took the motion.
  bool predict(const MotionIncrement& motion) {
    bool taken = false;
    for (auto& hypothesis : hypotheses) {
      const auto& blocks = hypothesis.filter.state().blocks;
      const bool any = std::any_of(blocks.begin(), blocks.end(),
                                   [](const Block& block) { return block.isLandmark(); });
      const bool moves = (any || !options.wait_for_landmark) &&
                         hypothesis.filter.predict(motion.T_previous_robot, motion.covariance);
      taken = taken || (moves && &hypothesis == &hypotheses.front());
    }
    return taken;
  }
};

RangeBearingEstimator::RangeBearingEstimator(const RangeBearingOptions& options,
                                             const FilterOptions& filter_options)
    : impl_(std::make_unique<Impl>(options)) {
  impl_->hypotheses.emplace_back(impl_->options, filter_options);
}
RangeBearingEstimator::RangeBearingEstimator(const RangeBearingOptions& options,
                                             const FilterOptions& filter_options,
                                             const Resumption& from)
    : impl_(std::make_unique<Impl>(options)) {
  if (from.map.source != SavedMap::Source::kReadings)
    throw Error("the map was made from cameras, and the log holds landmark readings",
                ExitCode::kUsage);
  if (from.anywhere)
    throw Error("a start anywhere is found by a session, not by the filter alone",
                ExitCode::kUsage);
  impl_->hypotheses.emplace_back(impl_->options, filter_options, from);
}
RangeBearingEstimator::~RangeBearingEstimator() = default;
RangeBearingEstimator::RangeBearingEstimator(RangeBearingEstimator&&) noexcept = default;
RangeBearingEstimator& RangeBearingEstimator::operator=(RangeBearingEstimator&&) noexcept = default;

RangeBearingReport RangeBearingEstimator::step(double stamp_s, const MotionIncrement& motion,
                                               const RangeBearingScan& scan) {
  Impl& self = *impl_;
  std::vector<std::size_t> places;
  const ReadingFrame frame = self.take(stamp_s, scan, places);
  self.former_stamp_s = stamp_s;
  ++self.frames;
  const bool moved = self.predict(motion);
  for (auto& hypothesis : self.hypotheses) hypothesis.focus(frame);

  const bool open = std::any_of(frame.readings.begin(), frame.readings.end(),
                                [](const auto& reading) { return reading.identity < 0; });
  const bool crowded = frame.readings.size() > kMostBeamReadings;
  if (crowded) self.hypotheses.erase(self.hypotheses.begin() + 1, self.hypotheses.end());
  const bool beam =
      !crowded && self.options.association == "hypotheses" && (open || self.hypotheses.size() > 1);
  const ReadingDecisions decisions =
      beam ? decideByHypotheses(frame, self.options, self.hypotheses)
           : decideJointly(frame, self.options, self.hypotheses.front());

  RangeBearingReport report;
  report.events = decisions.events;
  report.landmarks.assign(scan.readings.size(), std::nullopt);
  report.founded.assign(scan.readings.size(), false);
  report.measurements.assign(scan.readings.size(), std::nullopt);
  if (moved) {
    report.T_previous_robot = motion.T_previous_robot;
    report.motion_covariance = motion.covariance;
  }
  if (decisions.lost) report.motion_covariance += lostCovariance();
  for (std::size_t i = 0; i < places.size(); ++i) {
    report.landmarks[places[i]] = decisions.landmarks.front()[i];
    report.founded[places[i]] = decisions.founded[i];
    Measurement measurement = frame.readings[i].measurement;
    measurement.R *= frame.noise_scale;
    report.measurements[places[i]] = measurement;
  }
  for (std::size_t h = 0; h < self.hypotheses.size(); ++h) {
    std::vector<std::optional<LandmarkId>> all(scan.readings.size());
    for (std::size_t i = 0; i < places.size(); ++i) all[places[i]] = decisions.landmarks[h][i];
    auto& leaf = self.hypotheses[h].leaf;
    for (const auto& landmark : all) leaf = self.histories.add(leaf, landmark);
  }
  if (beam) mergeAlike(self.histories, self.hypotheses);
  std::vector<ReadingHistories::Leaf> leaves;
  for (const auto& hypothesis : self.hypotheses) leaves.push_back(hypothesis.leaf);
  self.histories.tidy(leaves);
  for (std::size_t h = 0; h < leaves.size(); ++h) self.hypotheses[h].leaf = leaves[h];
  return report;
}

const EkfSlam& RangeBearingEstimator::filter() const { return impl_->hypotheses.front().filter; }
Pose2 RangeBearingEstimator::pose() const {
  const auto& hypothesis = impl_->hypotheses.front();
  return hypothesis.T_world_start * hypothesis.filter.pose();
}
Pose2 RangeBearingEstimator::worldOrigin() const { return impl_->hypotheses.front().T_world_start; }
Eigen::Matrix3d RangeBearingEstimator::poseCovariance() const {
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J.topLeftCorner<2, 2>() = turnOf(impl_->hypotheses.front());
  return J * filter().poseCovariance() * J.transpose();
}
LandmarkMap RangeBearingEstimator::map() const {
  return moved(filter().landmarkMap(), impl_->hypotheses.front().T_world_start);
}
SavedMap RangeBearingEstimator::savedMap() const { return impl_->hypotheses.front().savedMap(); }
std::optional<Eigen::Vector2d> RangeBearingEstimator::placeOf(LandmarkId landmark) const {
  const auto place = filter().placeOf(landmark);
  if (!place) return std::nullopt;
  return transform(impl_->hypotheses.front().T_world_start, *place);
}
std::optional<int> RangeBearingEstimator::identityOf(LandmarkId landmark) const {
  return impl_->hypotheses.front().identityOf(landmark);
}
std::vector<std::optional<LandmarkId>> RangeBearingEstimator::decisions() const {
  return impl_->histories.path(impl_->hypotheses.front().leaf);
}
std::size_t RangeBearingEstimator::histories() const { return impl_->hypotheses.size(); }

}  // namespace colonnade
