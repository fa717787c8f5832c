// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opencv_odometry.hpp"

#include <limits>
#include <opencv2/rgbd/depth.hpp>

namespace colonnade {
namespace {

cv::Mat cameraMatrix(const PinholeCamera& camera) {
  return (cv::Mat_<float>(3, 3) << static_cast<float>(camera.fx_px), 0.0f,
          static_cast<float>(camera.cx_px), 0.0f, static_cast<float>(camera.fy_px),
          static_cast<float>(camera.cy_px), 0.0f, 0.0f, 1.0f);
}

cv::Ptr<cv::rgbd::Odometry> makeOdometry(const std::string& method, const cv::Mat& camera) {
  constexpr float kMinDepth_m = 0.3f;
  constexpr float kMaxDepth_m = 6.0f;
  if (method == "opencv_icp") {
    return cv::rgbd::ICPOdometry::create(camera, kMinDepth_m, kMaxDepth_m);
  }
  if (method == "opencv_rgbd_icp") {
    return cv::rgbd::RgbdICPOdometry::create(camera, kMinDepth_m, kMaxDepth_m);
  }
  return cv::rgbd::RgbdOdometry::create(camera, kMinDepth_m, kMaxDepth_m);
}

/// OpenCV marks missing depth by NaN.
cv::Mat depthWithNan(const cv::Mat& depth_m) {
  cv::Mat out = depth_m.clone();
  out.setTo(std::numeric_limits<float>::quiet_NaN(), depth_m <= 0.0f);
  return out;
}

}  // namespace

std::optional<Eigen::Isometry3d> openCvOdometry(const std::string& method,
                                                const RgbdPyramid& previous,
                                                const RgbdPyramid& current,
                                                const Eigen::Isometry3d& T_previous_current_guess) {
  if (previous.levels.empty() || current.levels.empty()) return std::nullopt;
  const auto odometry = makeOdometry(method, cameraMatrix(current.levels.front().camera));
  odometry->setTransformType(cv::rgbd::Odometry::RIGID_BODY_MOTION);
  // OpenCV's transform maps points of the source (previous) into the destination (current).
  const Eigen::Isometry3d T_guess = T_previous_current_guess.inverse();
  cv::Mat guess(4, 4, CV_64F);
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) guess.at<double>(r, c) = T_guess(r, c);
  }
  cv::Mat Rt;
  const bool found = odometry->compute(
      previous.gray, depthWithNan(previous.levels.front().depth_m), cv::Mat(), current.gray,
      depthWithNan(current.levels.front().depth_m), cv::Mat(), Rt, guess);
  if (!found || Rt.empty()) return std::nullopt;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) T(r, c) = Rt.at<double>(r, c);
  }
  return T.inverse();
}

}  // namespace colonnade
