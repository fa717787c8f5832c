// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "colonnade/detectors/levelled_camera.hpp"
#include "colonnade/detectors/segmentation.hpp"

namespace colonnade {
namespace {

constexpr int kPlaces = 24;  ///< looked at along a detection
constexpr double kBehind_m = 0.35;

/// A moving thing hides or makes the detection at this place, on its line or beside it; one well
/// behind it does neither, nor does one well before it that is beside the line.
bool isMovingAt(const Segmentation& segmentation, const LevelledCamera& camera,
                const Eigen::Vector2d& p_px, bool on_line, const Measurement& m) {
  if (segmentation.at(p_px) != Segmentation::kMoving) return false;
  if (!m.hasRange() || m.kind == LandmarkKind::kFloorEdge) return true;
  const double range_m =
      static_cast<double>(segmentation.nearestAt(p_px)) * camera.ray(p_px).head<2>().norm();
  return range_m < m.z[1] + kBehind_m && (on_line || range_m > m.z[1] - kBehind_m);
}

struct Shares {
  double moving = 0.0;
  double reflective = 0.0;
};

Shares sharesOf(const Detection& detection, const LevelledCamera& camera,
                const Segmentation& segmentation) {
  const Eigen::Vector2d along = detection.b_px - detection.a_px;
  if (!along.allFinite() || along.norm() < 1e-9) return {};
  const Eigen::Vector2d aside =
      1.5 * segmentation.cell_px * Eigen::Vector2d(-along.y(), along.x()).normalized();
  Shares shares;
  int inside = 0;  // of the image; corners reach beyond it
  for (int i = 0; i < kPlaces; ++i) {
    const Eigen::Vector2d p = detection.a_px + (i + 0.5) / kPlaces * along;
    if (!segmentation.contains(p)) continue;
    ++inside;
    bool moving = false;
    bool reflective = true;
    for (const double side : {-1.0, 0.0, 1.0}) {
      const Eigen::Vector2d beside = p + side * aside;
      moving =
          moving || isMovingAt(segmentation, camera, beside, side == 0.0, detection.measurement);
      reflective = reflective && segmentation.at(beside) == Segmentation::kReflective;
    }
    shares.moving += moving ? 1.0 : 0.0;
    shares.reflective += reflective ? 1.0 : 0.0;
  }
  if (inside == 0) return {};
  return {shares.moving / inside, shares.reflective / inside};
}

}  // namespace

void refuseSegmented(const Frame& frame, const Segmentation& segmentation,
                     const SegmentationOptions& options, Detections& detections) {
  if (segmentation.empty()) return;
  const LevelledCamera camera(frame);
  for (Detection& detection : detections) {
    if (!detection.accepted()) continue;
    const Shares shares = sharesOf(detection, camera, segmentation);
    if (shares.moving >= std::max(options.min_share_on_moving, 1e-3))
      refuse(detections, detection, "moving");
    else if (shares.reflective >= std::max(options.min_share_on_reflective, 1e-3))
      refuse(detections, detection, "reflective");
  }
}

}  // namespace colonnade
