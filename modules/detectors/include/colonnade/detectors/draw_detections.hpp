// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "colonnade/detectors/detection.hpp"
#include "colonnade/detectors/segmentation.hpp"
#include "colonnade/edges/edge_line_backend.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// A picture for people, CV_8UC3: edge pixels faint, accepted landmarks in the colour of their kind
/// with their measurement, refused ones thin and red with the reason, pairs joined, a legend below;
/// moving things reddish, panes and mirrors bluish where a segmentation is given.
cv::Mat drawDetections(const Frame& frame, const EdgeLines& edges, const Detections& detections,
                       const Segmentation* segmentation = nullptr);

}  // namespace colonnade
