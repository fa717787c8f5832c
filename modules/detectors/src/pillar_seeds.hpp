// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "colonnade/detectors/levelled_camera.hpp"
#include "colonnade/detectors/pillar_detector.hpp"

namespace colonnade {

/// Upright lines too faint for the image stage, which decides pixel by pixel: the camera's tilt
/// says which way each of them must run, so the image is averaged along it before it is
/// differentiated across, and the votes for each column are counted along the projected vertical.
/// Nothing where `options.faint_contrast` is 0.
RefinedLines faintUprights(const cv::Mat& gray, const LevelledCamera& camera,
                           const PillarOptions& options, const LineRefinementOptions& lines);

}  // namespace colonnade
