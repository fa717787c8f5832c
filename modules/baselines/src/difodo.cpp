// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "difodo.hpp"

#include <mrpt/vision/CDifodo.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "camera_path.hpp"

namespace colonnade {
namespace {

constexpr int kCols = 320;
constexpr int kRows = 240;
constexpr unsigned kMinPoints = 100;  ///< fewer and six unknowns are noise

/// CDifodo with the frames given from outside.
class DepthOdometry : public mrpt::vision::CDifodo {
 public:
  explicit DepthOdometry(const DifodoOptions& options) : max_depth_m_(options.max_depth_m) {
    fast_pyramid = false;
    cam_mode = 1;
    downsample = 2;
    rows = kRows;
    cols = kCols;
    ctf_levels = static_cast<unsigned>(options.levels);
    m_width = kCols;
    m_height = kRows;
    for (auto* pyramid : {&depth, &depth_old, &depth_inter, &depth_warped, &xx, &xx_inter, &xx_old,
                          &xx_warped, &yy, &yy_inter, &yy_old, &yy_warped}) {
      pyramid->resize(ctf_levels);
      for (unsigned level_index = 0; level_index < ctf_levels; ++level_index) {
        (*pyramid)[level_index].resize(kRows >> level_index, kCols >> level_index);
        (*pyramid)[level_index].fill(0.0f);
      }
    }
    transformations.resize(ctf_levels);
    for (auto& transformation : transformations) transformation.resize(4, 4);
    depth_wf.setSize(kRows, kCols);
  }

  void loadFrame() override {}

  /// CDifodo sees its image turned by 180 degrees: x forward, y left, z up.
  void load(const Frame& frame) {
    const double f_px = frame.camera.fx_px * kCols / frame.camera.width_px;
    fovh = static_cast<float>(2.0 * std::atan(0.5 * kCols / f_px));
    fovv = static_cast<float>(2.0 * std::atan(0.5 * kRows / f_px));
    const auto source = [](double f, double c, double f_ideal, double from_centre) {
      return static_cast<int>(std::lround(c + f * from_centre / f_ideal));
    };
    for (int j = 0; j < kCols; ++j) {
      const int u = source(frame.camera.fx_px, frame.camera.cx_px, f_px, 0.5 * (kCols - 1) - j);
      for (int i = 0; i < kRows; ++i) {
        const int v = source(frame.camera.fy_px, frame.camera.cy_px, f_px, 0.5 * (kRows - 1) - i);
        const bool inside = u >= 0 && v >= 0 && u < frame.depth_m.cols && v < frame.depth_m.rows;
        const float z = inside ? frame.depth_m.at<float>(v, u) : 0.0f;
        depth_wf(i, j) = z > 0.0f && z < max_depth_m_ ? z : 0.0f;
      }
    }
  }
  void start() { buildCoordinatesPyramid(); }

  bool usable() const {
    return num_valid_points >= kMinPoints &&
           cam_pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen().allFinite();
  }
  /// Back to a pose, at rest.
  void halt(const mrpt::poses::CPose3D& pose) {
    cam_pose = pose;
    cam_oldpose = pose;
    kai_abs = kai_loc = kai_loc_old = mrpt::math::TTwist3D();
  }

 private:
  double max_depth_m_;
};

}  // namespace

struct Difodo::Impl {
  Impl(const DifodoOptions& options, const MotionOptions& motion_options)
      : odometry(options), motion(motion_options) {}
  DepthOdometry odometry;
  MotionOptions motion;
  std::optional<CameraPath> path;
  std::optional<double> former_stamp_s;
};

Difodo::Difodo(const DifodoOptions& options, const MotionOptions& motion)
    : impl_(std::make_unique<Impl>(options, motion)) {}
Difodo::~Difodo() = default;

BaselineStep Difodo::step(const Frame& frame) {
  auto& [odometry, motion, path, former_stamp_s] = *impl_;
  BaselineStep step;
  if (!path) path.emplace(firstMounting(frame, motion));
  if (frame.depth_m.empty()) {
    step.lost = "no depth";
  } else {
    odometry.load(frame);
    if (!former_stamp_s) {
      odometry.start();
    } else {
      odometry.fps = 1.0 / std::clamp(frame.stamp_s - *former_stamp_s, 1e-3, 10.0);
      const mrpt::poses::CPose3D before = odometry.cam_pose;
      odometry.odometryCalculation();
      if (!odometry.usable()) {
        step.lost = "too little depth, or no finite solution";
        odometry.halt(before);
      }
    }
    former_stamp_s = frame.stamp_s;
  }
  Eigen::Isometry3d T_first_now;
  T_first_now.matrix() =
      odometry.cam_pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen();
  const Eigen::Isometry3d T_forward_optical = forwardFromOptical();
  step.T_world_robot = path->robot(T_forward_optical.inverse() * T_first_now * T_forward_optical);
  return step;
}

}  // namespace colonnade
