// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/sensor_errors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <map>
#include <random>

#include "colonnade/base/angle.hpp"
#include "colonnade/filter/ekf_slam.hpp"
#include "colonnade/filter/smoother.hpp"
#include "normal_equations.hpp"
#include "numeric_jacobian.hpp"
#include "simulated_drive.hpp"

namespace colonnade {
namespace {

constexpr double kGate = 0.999999;
const SensorErrors kSigmas{0.05, 0.02, 0.03, 0.02, 0.02};
const SensorErrors kSkewed{0.06, 0.015, -0.05, 0.02, 0.02};

/// The same drive with another sensor.
testing::SimulatedDrive readBy(const SensorErrors& e, testing::SimulatedDrive drive) {
  for (Drive* of : {&drive.truth, &drive.start})
    for (Drive::Sighting& sighting : of->sightings) {
      MeasurementVector& z = sighting.measurement.z;
      if (z.size() == 2)
        z(1) = (1.0 + e.range_scale + e.range_skew * z(0)) * z(1) + e.range_offset_m;
      z(0) += e.bearing_offset + e.bearing_scale * z(0);
    }
  return drive;
}

/// Through the filter, identities known; landmarks start with their first sighting.
EkfSlam filtered(const Drive& drive, const FilterOptions& options,
                 const std::optional<SensorErrors>& sigmas) {
  EkfSlam filter(options);
  if (sigmas) filter.addSensor(*sigmas);
  std::map<std::size_t, LandmarkId> landmarks;
  auto sighting = drive.sightings.begin();
  for (std::size_t k = 0; k < drive.motions.size(); ++k) {
    filter.predict(drive.motions[k].T_previous_robot, drive.motions[k].covariance);
    std::vector<LandmarkId> needed;
    std::vector<Match> matches;
    std::vector<Drive::Sighting> open;
    for (; sighting != drive.sightings.end() && sighting->pose == k; ++sighting)
      if (const auto known = landmarks.find(sighting->point); known == landmarks.end()) {
        open.push_back(*sighting);
      } else {
        needed.push_back(known->second);
        matches.push_back({known->second, sighting->measurement});
      }
    filter.focus(needed);
    filter.update(matches);
    for (const Drive::Sighting& first : open)
      landmarks.emplace(first.point, *filter.addLandmark(first.measurement));
  }
  return filter;
}

double offBy(const Pose2& a, const Pose2& b) { return (a.translation() - b.translation()).norm(); }

TEST(SensorErrors, JacobiansAgreeWithNumericOnes) {
  for (const bool ranged : {true, false}) {
    Measurement like;
    like.z = ranged ? MeasurementVector(Eigen::Vector2d(0.4, 3.0))
                    : MeasurementVector(MeasurementVector::Constant(1, 0.4));
    like.R = MeasurementCovariance::Identity(like.z.size(), like.z.size()) * 1e-4;
    like.p_robot_camera << 0.2, -0.1;
    like.camera_direction = 3.0;  // across the cut of angles
    const auto read = [&](const Eigen::VectorXd& pose, const Eigen::VectorXd& point,
                          const Eigen::VectorXd& errors) {
      auto predicted =
          predictMeasurement({pose(0), pose(1), pose(2)}, BlockKind::kPoint, point, like);
      const SensorJacobian J = readWith(SensorErrors::of(errors), like, predicted);
      return std::pair(predicted, J);
    };
    const Eigen::Vector3d pose(0.3, -0.2, 0.5);
    const Eigen::Vector2d point(3.1, 2.4);
    const Eigen::VectorXd errors = kSkewed.vector();
    const auto [predicted, J_errors] = read(pose, point, errors);
    const auto differs = [](const Eigen::MatrixXd& J, const auto& f, const Eigen::VectorXd& x) {
      return (J - testing::numericJacobian(f, x)).cwiseAbs().maxCoeff();
    };
    using Vector = Eigen::VectorXd;
    EXPECT_LT(differs(
                  predicted.H_robot,
                  [&](const Vector& v) -> Vector { return read(v, point, errors).first.z; }, pose),
              1e-7);
    EXPECT_LT(differs(
                  predicted.H_block,
                  [&](const Vector& v) -> Vector { return read(pose, v, errors).first.z; }, point),
              1e-7);
    EXPECT_LT(differs(
                  J_errors, [&](const Vector& v) -> Vector { return read(pose, point, v).first.z; },
                  errors),
              1e-7);

    const auto freed = freedOf(kSkewed, like);
    EXPECT_LT(differs(
                  freed.J_z,
                  [&](const Vector& z) -> Vector {
                    Measurement other = like;
                    other.z = z;
                    return freedOf(kSkewed, other).measurement.z;
                  },
                  like.z),
              1e-7);
    EXPECT_LT(differs(
                  freed.J_errors,
                  [&](const Vector& e) -> Vector {
                    return freedOf(SensorErrors::of(e), like).measurement.z;
                  },
                  errors),
              1e-7);
    EXPECT_LT((freed.measurement.R - freed.J_z * like.R * freed.J_z.transpose()).norm(), 1e-15);
    // There and back.
    PredictedMeasurement ideal;
    ideal.z = freed.measurement.z;
    ideal.H_robot.setZero(ideal.z.size(), 3);
    ideal.H_block.setZero(ideal.z.size(), 2);
    readWith(kSkewed, like, ideal);
    EXPECT_LT((ideal.z - like.z).norm(), 1e-12);
  }
}

/// Landmarks hang together with the sensor that founded them as the place they are given depends on
/// its errors: by a range, by two bearings, by a bearing and a guess.
TEST(SensorErrors, FoundedLandmarksKnowThem) {
  Measurement reading, bearing;
  reading.z = Eigen::Vector2d(0.3, 2.5);
  reading.R = Eigen::Vector2d(1e-4, 1e-3).asDiagonal();
  bearing.z = MeasurementVector::Constant(1, 0.3);
  bearing.R = MeasurementCovariance::Constant(1, 1, 1e-4);
  Measurement later = bearing;
  later.z(0) = 0.55;
  const auto found = [&](int how, const SensorErrors::Vector& errors) {
    EkfSlam filter({});
    filter.addSensor(kSigmas);
    State state = filter.state();
    state.x.tail<5>() = errors;
    state.sensor = filter.state().sensor;
    EkfSlam with({}, state);
    const LandmarkId clone = with.addPoseClone();
    const bool moves = with.predict({0.6, -0.4, 0.1}, Eigen::Matrix3d::Zero());
    EXPECT_TRUE(moves);
    const auto id = how == 0   ? with.addLandmark(reading)
                    : how == 1 ? with.addLandmark(clone, bearing, later)
                               : with.addLandmarkOnRay(clone, bearing, 0.4, 0.1);
    return std::pair(with, *id);
  };
  for (const int how : {0, 1, 2}) {
    const auto valuesAt = [&](const Eigen::VectorXd& errors) -> Eigen::VectorXd {
      const auto [filter, id] = found(how, errors);
      return filter.state().values(*filter.state().find(id));
    };
    const auto [filter, id] = found(how, kSkewed.vector());
    const State& state = filter.state();
    const Block &landmark = *state.find(id), &sensor = *state.find(*state.sensor);
    // P_landmark,sensor = J P_sensor, for nothing else is unsure.
    const Eigen::MatrixXd J = state.P.block(landmark.offset, sensor.offset, landmark.size(), 5) *
                              kSigmas.vector().cwiseAbs2().cwiseInverse().asDiagonal();
    const Eigen::MatrixXd numeric = testing::numericJacobian(valuesAt, kSkewed.vector());
    EXPECT_LT((J - numeric).cwiseAbs().maxCoeff(), 1e-6) << how;
    EXPECT_GT(numeric.cwiseAbs().maxCoeff(), 0.3) << how;
  }
}

/// A landmark that a reading may be of, as unsure as the sensor is, is neither ruled out by a look
/// at its place nor left to rest.
TEST(SensorErrors, MayBeWhyAReadingIsFarOff) {
  FilterOptions options;
  options.active_landmarks = 4;
  EkfSlam filter(options);
  filter.addSensor({0.5, 0.0, 0.0, 0.0, 0.0});
  Measurement m;
  m.R = Eigen::Vector2d(1e-6, 1e-6).asDiagonal();
  std::vector<LandmarkId> posts;
  for (int i = 0; i < 20; ++i) {  // read off by what the offset may be, here and from elsewhere
    m.z = Eigen::Vector2d(-1.0 + 0.1 * i, 3.0 + 2.0 * i);
    posts.push_back(*filter.addLandmark(m));
  }
  filter.predict({-2.0, 0.0, kPi / 2.0}, Eigen::Vector3d(1e-8, 1e-8, 1e-8).asDiagonal());
  const Pose2 T_robot_world = filter.pose().inverse();
  const auto readingOf = [&](LandmarkId id) {
    const State all = filter.fullState();
    // Were ranges 0.5 m long, the post would be that much nearer to where it was founded from.
    const Eigen::Vector2d p_founded = all.values(*all.find(id));
    const Eigen::Vector2d p = transform(T_robot_world, p_founded - 0.5 * p_founded.normalized());
    Measurement reading = m;
    reading.z << std::atan2(p.y(), p.x()), p.norm() + 0.5;
    return reading;
  };
  filter.focus({});
  std::size_t resting = 0;
  for (const LandmarkId id : posts) {
    if (!filter.isResting(id)) continue;
    ++resting;
    const Measurement reading = readingOf(id);
    const auto near = filter.restingNear({&reading, 1});
    EXPECT_NE(std::find(near.begin(), near.end(), id), near.end()) << number(id);
  }
  EXPECT_GT(resting, 10u);
}

/// Nor where all but the sensor is known.
TEST(SensorErrors, MayBeWhyAReadingOfAKnownLandmarkIsFarOff) {
  State known;
  known.blocks.push_back({LandmarkId{0}, BlockKind::kPoint, LandmarkKind::kPillarEdge, 3, {}});
  known.x.resize(5);
  known.x << 0.0, 0.0, 0.0, 3.0, 0.0;
  known.P = 1e-6 * Eigen::MatrixXd::Identity(5, 5);
  Measurement m;
  m.z = Eigen::Vector2d(0.0, 3.6);
  m.R = Eigen::Vector2d(1e-6, 1e-6).asDiagonal();
  for (const bool is_estimated : {true, false}) {
    EkfSlam filter({}, known);
    filter.fixMap();
    if (is_estimated) filter.addSensor({0.5, 0.0, 0.0, 0.0, 0.0});
    EXPECT_EQ(filter.mayBeWithin(LandmarkId{0}, m, 10.0), is_estimated);
    EXPECT_EQ(filter.innovation(LandmarkId{0}, m)->within_gate, is_estimated);
    const Match match{LandmarkId{0}, m};
    EXPECT_EQ(filter.update({&match, 1}).front(), is_estimated);
    EXPECT_EQ(filter.state().x(3), 3.0);
    if (!is_estimated) continue;
    EXPECT_NEAR(filter.sensor()->errors.range_offset_m, 0.6, 0.01);
  }
}

TEST(SensorErrors, OfARightSensorChangeNothing) {
  Measurement m;
  m.z = Eigen::Vector2d(0.37, 2.9);
  m.R = Eigen::Vector2d(1e-4, 2.5e-3).asDiagonal();
  const auto freed = freedOf(SensorErrors{}, m);
  EXPECT_EQ(freed.measurement.z, m.z);
  EXPECT_EQ(freed.measurement.R, m.R);
}

/// Estimated beside pose and map the errors are found, nearly as well as the filter says: bearings
/// end 0.6 % too narrow here, since what multiplies their scale is taken where the filter expects
/// it, and expectation and innovation err together. Smoothing is free of that.
TEST(SensorErrors, AreFoundByTheFilter) {
  std::mt19937 random(11);
  std::normal_distribution<double> gauss;
  double sensor_nees = 0.0, pose_nees = 0.0, off_m = 0.0, off_without_m = 0.0, scale_off = 0.0;
  constexpr int kRuns = 60;
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    SensorErrors::Vector errors = kSigmas.vector();
    for (double& e : errors) e *= gauss(random);
    const auto drive = readBy(SensorErrors::of(errors), testing::simulatedDrive(seed));
    const EkfSlam filter = filtered(drive.truth, {}, kSigmas);
    const Pose2& truth = drive.truth.T_world_robot.back();
    const auto sensor = *filter.sensor();
    const SensorErrors::Vector wrong = sensor.errors.vector() - errors;
    sensor_nees += wrong.dot(sensor.covariance.ldlt().solve(wrong)) / 5.0 / kRuns;
    scale_off += wrong(4) / kRuns;
    Eigen::Vector3d pose = filter.pose().vector() - truth.vector();
    pose(2) = wrapAngle(pose(2));
    pose_nees += pose.dot(filter.poseCovariance().ldlt().solve(pose)) / 3.0 / kRuns;
    off_m += offBy(filter.pose(), truth) / kRuns;
    off_without_m += offBy(filtered(drive.truth, {}, {}).pose(), truth) / kRuns;
  }
  std::printf("NEES of the sensor %.2f, of the pose %.2f; bearing scale off by %.4f\n", sensor_nees,
              pose_nees, scale_off);
  EXPECT_GT(sensor_nees, 0.75);
  EXPECT_LT(sensor_nees, 1.9);
  EXPECT_GT(pose_nees, 0.7);
  EXPECT_LT(pose_nees, 1.35);
  EXPECT_LT(off_m, 0.8 * off_without_m);
}

/// An error that is known not to be there stays at none.
TEST(SensorErrors, AreAsKnownBeforehand) {
  const auto drive = readBy(kSkewed, testing::simulatedDrive(2));
  SensorErrors known = kSigmas;
  known.range_scale = 0.0;
  EXPECT_EQ(filtered(drive.truth, {}, known).sensor()->errors.range_scale, 0.0);
  Drive smoothed = drive.start;
  smoothed.sensor = {{}, known};
  EXPECT_TRUE(smooth(smoothed, kGate).converged);
  EXPECT_LT(std::abs(smoothed.sensor->errors.range_scale), 1e-5);
  EXPECT_NEAR(smoothed.sensor->errors.range_skew, kSkewed.range_skew, 0.01);
}

/// A filter in which landmarks rest has the same sensor as the full one.
TEST(SensorErrors, AreTheSameWhereLandmarksRest) {
  const auto drive = readBy(kSkewed, testing::simulatedDrive(4));
  FilterOptions full, resting;
  full.invariant = resting.invariant = false;
  resting.active_landmarks = 3;
  resting.negligible_gain = 0.0;
  const auto a = *filtered(drive.truth, full, kSigmas).sensor();
  const EkfSlam filter = filtered(drive.truth, resting, kSigmas);
  EXPECT_FALSE(filter.resting().empty());
  EXPECT_LT((a.errors.vector() - filter.sensor()->errors.vector()).norm(), 1e-9);
  EXPECT_LT((a.covariance - filter.sensor()->covariance).norm(), 1e-9);
}

TEST(SensorErrors, ARangeShorterThanWhatTheSensorAddsFoundsNothing) {
  const SensorErrors far{0.4, 0.0, 0.0, 0.0, 0.0};
  EkfSlam filter = filtered(readBy(far, testing::simulatedDrive(3)).truth, {}, far);
  EXPECT_GT(filter.sensor()->errors.range_offset_m, 0.3);
  Measurement m;
  m.z = Eigen::Vector2d(0.0, 0.2);
  m.R = Eigen::Vector2d(1e-4, 1e-4).asDiagonal();
  const State before = filter.state();
  EXPECT_FALSE(filter.addLandmark(m));
  EXPECT_EQ(filter.state().P, before.P);
}

TEST(Smoother, FindsWhatTheSensorIsOffByAndHonestly) {
  double off_m = 0.0, off_without_m = 0.0, nees = 0.0;
  constexpr int kRuns = 20;
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    const auto drive = readBy(kSkewed, testing::simulatedDrive(seed));
    Drive with = drive.start, without = drive.start;
    with.sensor = {{}, kSigmas};
    const Smoothing how = smooth(with, kGate);
    ASSERT_TRUE(how.converged);
    const Smoothing without_how = smooth(without, kGate);
    const SensorErrors::Vector wrong = with.sensor->errors.vector() - kSkewed.vector();
    const auto covariance = sensorFit(with, kSigmas)->estimate.covariance;
    nees += wrong.dot(covariance.ldlt().solve(wrong)) / 5.0 / kRuns;
    EXPECT_LT(std::sqrt(covariance(2, 2)), 0.01);
    // Near enough from where they were taken to be none.
    const SensorFit seen = *sensorFit(without, kSigmas);
    EXPECT_NEAR(seen.estimate.errors.range_skew, with.sensor->errors.range_skew, 0.01);
    EXPECT_NEAR(seen.gain / (without_how.cost - how.cost), 1.0, 0.2);
    off_m += testing::poseError(with, drive.truth);
    off_without_m += testing::poseError(without, drive.truth);
  }
  EXPECT_GT(nees, 0.6);
  EXPECT_LT(nees, 1.5);
  EXPECT_LT(off_m, 0.7 * off_without_m);
}

TEST(NormalEquations, GradientInTheSensorIsHalfTheNumericOneOfTheCost) {
  Drive drive = readBy(kSkewed, testing::simulatedDrive(5)).start;
  drive.sensor = {{0.01, 0.005, -0.02, 0.01, 0.01}, kSigmas};
  const NormalEquations at(drive);
  const auto costAt = [&](const Eigen::VectorXd& dx) -> Eigen::VectorXd {
    Drive moved = drive;
    Eigen::VectorXd all = Eigen::VectorXd::Zero(at.g().size());
    all.tail<5>() = dx;
    move(moved, at, all);
    return Eigen::VectorXd::Constant(1, NormalEquations(moved).cost());
  };
  const Eigen::VectorXd numeric =
      testing::numericJacobian(costAt, SensorErrors::Vector::Zero()).transpose();
  EXPECT_LT((2.0 * at.g().tail<5>() - numeric).norm(), 1e-4 * numeric.norm());
}

}  // namespace
}  // namespace colonnade
