// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// Sees a depth image from another camera: every measured pixel becomes a point, is projected and
/// covers the footprint of its pixel there; where several meet, the nearest wins. Pixels nothing
/// reaches stay 0.
class DepthRegistration {
 public:
  /// `depth_m` CV_32FC1 metres of `from`; the result is CV_32FC1 metres of `to`.
  cv::Mat registered(const cv::Mat& depth_m, const PinholeCamera& from, const PinholeCamera& to,
                     const Eigen::Isometry3d& T_to_from);

 private:
  void prepare(const PinholeCamera& from, const Eigen::Matrix3d& R_to_from);

  PinholeCamera from_;
  Eigen::Matrix3d R_to_from_ = Eigen::Matrix3d::Zero();
  std::vector<Eigen::Vector3f> rays_;  ///< of every pixel of `from`, turned into the axes of `to`
};

}  // namespace colonnade
