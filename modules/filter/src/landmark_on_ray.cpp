// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "colonnade/filter/covariance.hpp"
#include "colonnade/filter/ekf_slam.hpp"
#include "sensed.hpp"

namespace colonnade {

std::optional<LandmarkId> EkfSlam::addLandmarkOnRay(LandmarkId clone, const Measurement& bearing,
                                                    double inverse_depth,
                                                    double inverse_depth_sigma) {
  const Block* from = state_.find(clone);
  if (!from || !bearing.z.allFinite() || !bearing.R.allFinite() ||
      !bearing.p_robot_camera.allFinite() || !std::isfinite(inverse_depth) ||
      !std::isfinite(inverse_depth_sigma))
    return std::nullopt;
  // Anchor, direction and a number along it: the parameters of a floor line are built alike.
  const FreedMeasurement freed = freedOf(state_, bearing);
  Measurement ray = bearing;
  ray.z = Eigen::Vector2d(freed.measurement.z(0), inverse_depth);
  ray.R = Eigen::Vector2d(freed.measurement.R(0, 0), inverse_depth_sigma * inverse_depth_sigma)
              .asDiagonal();
  const Eigen::Vector3d at = state_.x.segment<3>(from->offset);
  const InverseMeasurement inverse = lineFromFloor({at(0), at(1), at(2)}, ray);
  SparseJacobian J(4);
  J.add(0, from->offset, inverse.J_robot);
  if (const Block* sensor = sensorOf(state_, bearing))
    J.add(0, sensor->offset, inverse.J_z.col(0) * freed.J_errors.row(0));
  const LandmarkId id = nextId();
  augment(state_, {id, BlockKind::kInverseDepth, bearing.kind, 0, {}}, inverse.block, J,
          inverse.J_z * ray.R * inverse.J_z.transpose());
  return id;
}

}  // namespace colonnade
