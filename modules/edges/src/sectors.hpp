// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

namespace colonnade {

/// The sector of 45 degrees a gradient points into, 0 to 7: sector 0 is centred on +u, 2 on +v.
/// Integer arithmetic only (tan 22.5 degrees as 106/256), so that hardware can do the same.
int gradientSector(int gradient_u, int gradient_v);

/// Replaces each non-zero byte of `edges` (CV_8UC1) by 1 + the sector of its gradient
/// (CV_16SC1 derivatives of the same size).
void encodeSectors(const cv::Mat& gradient_u, const cv::Mat& gradient_v, cv::Mat& edges);

}  // namespace colonnade
