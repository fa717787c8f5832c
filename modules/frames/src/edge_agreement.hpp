// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

namespace colonnade {

/// How well the jumps of a depth image lie on the edges of a picture of the same size.
struct EdgeAgreement {
  int jumps = 0;          ///< pixels where the depth jumps
  double strength = 0.0;  ///< mean gradient of the picture there, relative to its mean elsewhere
};

/// `depth_m` CV_32FC1 metres, 0 = not measured; `gray` CV_8UC1.
EdgeAgreement edgeAgreement(const cv::Mat& depth_m, const cv::Mat& gray);

}  // namespace colonnade
