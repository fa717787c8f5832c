// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/filter/measurement_models.hpp"

#include <gtest/gtest.h>

#include <random>

#include "colonnade/base/angle.hpp"
#include "numeric_jacobian.hpp"

namespace colonnade {
namespace {

Pose2 poseOf(const Eigen::VectorXd& v) { return {v(0), v(1), v(2)}; }

Measurement like(LandmarkKind kind, double z0, std::optional<double> z1 = std::nullopt) {
  Measurement m;
  m.kind = kind;
  m.z.resize(z1 ? 2 : 1);
  m.z(0) = z0;
  if (z1) m.z(1) = *z1;
  m.R = MeasurementCovariance::Identity(m.z.size(), m.z.size()) * 1e-4;
  m.p_robot_camera << 0.21, -0.07;
  return m;
}

struct Case {
  const char* name;
  BlockKind kind;
  LandmarkKind landmark;
  BlockVector block;
  bool with_range;
};

class ModelJacobians : public ::testing::TestWithParam<Case> {};

TEST_P(ModelJacobians, AgreeWithNumericOnesAtManyPoses) {
  const Case& c = GetParam();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> offset(-1.0, 1.0);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d pose(offset(random), offset(random), 3.0 * offset(random));
    // A measurement near the prediction, so that the description of a line does not flip.
    Measurement m = c.with_range ? like(c.landmark, 0.0, 1.0) : like(c.landmark, 0.0);
    m.z(0) = predictMeasurement(poseOf(pose), c.kind, c.block, m).z(0);
    if (i % 2 == 1 && c.kind == BlockKind::kFloorLine) m.z(0) = wrapAngle(m.z(0) + kPi);
    const auto p = predictMeasurement(poseOf(pose), c.kind, c.block, m);
    // The derivative of the wrapped difference, so that +pi and -pi do not tear it apart.
    const auto difference = [&](const MeasurementVector& z) -> Eigen::VectorXd {
      Eigen::VectorXd d = z - p.z;
      d(0) = wrapAngle(d(0));
      return d;
    };
    const auto by_robot = testing::numericJacobian(
        [&](const Eigen::VectorXd& v) {
          return difference(predictMeasurement(poseOf(v), c.kind, c.block, m).z);
        },
        pose);
    const auto by_block = testing::numericJacobian(
        [&](const Eigen::VectorXd& v) {
          return difference(predictMeasurement(poseOf(pose), c.kind, v, m).z);
        },
        c.block);
    EXPECT_LT((p.H_robot - by_robot).cwiseAbs().maxCoeff(), 1e-6) << c.name;
    EXPECT_LT((p.H_block - by_block).cwiseAbs().maxCoeff(), 1e-6) << c.name;
  }
}

BlockVector block(std::initializer_list<double> values) {
  BlockVector b(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), b.data());
  return b;
}

INSTANTIATE_TEST_SUITE_P(
    AllKinds, ModelJacobians,
    ::testing::Values(
        Case{"point bearing", BlockKind::kPoint, LandmarkKind::kPillarEdge, block({4, 1.5}), false},
        Case{"point range", BlockKind::kPoint, LandmarkKind::kDepthSlope, block({-3, 2}), true},
        Case{"inverse depth bearing", BlockKind::kInverseDepth, LandmarkKind::kPillarEdge,
             block({0.2, -0.3, 0.7, 0.25}), false},
        Case{"at infinity", BlockKind::kInverseDepth, LandmarkKind::kPillarEdge,
             block({0.2, -0.3, 0.7, 0.0}), false},
        Case{"inverse depth range", BlockKind::kInverseDepth, LandmarkKind::kPillarEdge,
             block({0.2, -0.3, -2.4, 0.2}), true},
        Case{"floor line", BlockKind::kFloorLine, LandmarkKind::kFloorEdge,
             block({0.4, 0.1, 1.4, 2.5}), true}),
    [](const auto& info) {
      std::string name = info.param.name;
      std::replace(name.begin(), name.end(), ' ', '_');
      return name;
    });

TEST(MeasurementModels, ALineIsTheSameFromItsOtherDescription) {
  const Pose2 pose{0.5, 0.2, 0.3};
  const Measurement m = like(LandmarkKind::kFloorEdge, 1.2, 1.0);
  const auto a = predictMeasurement(pose, BlockKind::kFloorLine, block({0.1, 0.2, 1.4, 1.5}), m);
  const auto b =
      predictMeasurement(pose, BlockKind::kFloorLine, block({0.1, 0.2, 1.4 - kPi, -1.5}), m);
  EXPECT_NEAR(a.z(0), b.z(0), 1e-12);
  EXPECT_NEAR(a.z(1), b.z(1), 1e-12);
}

TEST(MeasurementModels, InnovationsOfAnglesWrap) {
  const Measurement m = like(LandmarkKind::kPillarEdge, radians(-179.5));
  MeasurementVector predicted(1);
  predicted << radians(179.5);
  EXPECT_NEAR(innovationOf(m, predicted)(0), radians(1.0), 1e-12);
}

TEST(InverseModels, ReturnWhatTheMeasurementPredictsAndTheirJacobians) {
  const Eigen::Vector3d pose(0.4, -0.2, 0.9);
  for (const auto& m :
       {like(LandmarkKind::kDepthSlope, -0.4, 2.2), like(LandmarkKind::kFloorEdge, 1.1, 1.7)}) {
    const bool line = m.kind == LandmarkKind::kFloorEdge;
    const auto invert = [&](const Eigen::VectorXd& v, const Eigen::VectorXd& z) {
      Measurement moved = m;
      moved.z = z;
      return line ? lineFromFloor(poseOf(v), moved) : pointFromRange(poseOf(v), moved);
    };
    const auto inverse = invert(pose, m.z);
    const auto again = predictMeasurement(
        poseOf(pose), line ? BlockKind::kFloorLine : BlockKind::kPoint, inverse.block, m);
    EXPECT_LT((again.z - m.z).norm(), 1e-12);
    const auto by_robot = testing::numericJacobian(
        [&](const Eigen::VectorXd& v) -> Eigen::VectorXd { return invert(v, m.z).block; }, pose);
    const auto by_z = testing::numericJacobian(
        [&](const Eigen::VectorXd& z) -> Eigen::VectorXd { return invert(pose, z).block; }, m.z);
    EXPECT_LT((inverse.J_robot - by_robot).cwiseAbs().maxCoeff(), 1e-7);
    EXPECT_LT((inverse.J_z - by_z).cwiseAbs().maxCoeff(), 1e-7);
  }
}

TEST(Triangulation, FindsThePointAndItsJacobians) {
  const Eigen::Vector2d landmark(4.0, 1.2);
  const Eigen::Vector3d a(0.0, 0.1, 0.2);
  const Eigen::Vector3d b(0.9, -0.5, 0.5);
  const auto bearingFrom = [&](const Eigen::Vector3d& pose) {
    Measurement m = like(LandmarkKind::kPillarEdge, 0.0);
    m.z = predictMeasurement(poseOf(pose), BlockKind::kPoint, landmark, m).z;
    return m;
  };
  const Measurement first = bearingFrom(a);
  const Measurement now = bearingFrom(b);
  const auto t = triangulate(poseOf(a), first, poseOf(b), now);
  EXPECT_LT((pointOf(t.block) - landmark).norm(), 1e-9);
  EXPECT_GT(t.baseline_m, 0.5);

  const auto at = [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
    Measurement f = first;
    Measurement n = now;
    f.z(0) = v(6);
    n.z(0) = v(7);
    return triangulate(poseOf(v.head(3)), f, poseOf(v.segment(3, 3)), n).block;
  };
  Eigen::VectorXd all(8);
  all << a, b, first.z(0), now.z(0);
  const Eigen::MatrixXd numeric = testing::numericJacobian(at, all);
  EXPECT_LT((t.J_robot_a - numeric.leftCols(3)).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((t.J_robot_b - numeric.middleCols(3, 3)).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((t.J_bearing_a - numeric.col(6)).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((t.J_bearing_b - numeric.col(7)).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(PointOfInverseDepth, JacobianAgreesWithTheNumericOne) {
  const BlockVector y = block({0.3, -0.8, 2.1, 0.31});
  Eigen::Matrix<double, 2, 4> J;
  pointOf(y, &J);
  const auto numeric = testing::numericJacobian(
      [](const Eigen::VectorXd& v) -> Eigen::VectorXd { return pointOf(v); }, y);
  EXPECT_LT((J - numeric).cwiseAbs().maxCoeff(), 1e-7);
}

}  // namespace
}  // namespace colonnade
