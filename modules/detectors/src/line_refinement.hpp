// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/detectors/refined_line.hpp"
#include "line_walker.hpp"

namespace colonnade {

/// Appends the lines that edge pixels beside a steep guess support. edges: as EdgeLines::edges.
void refineSteep(const cv::Mat& gray, const cv::Mat& edges, const Straight& guess,
                 const LineRefinementOptions& options, RefinedLines& lines);

/// Longest first, without those that say nothing a longer one does not.
RefinedLines withoutDuplicates(RefinedLines lines, double duplicate_px);

}  // namespace colonnade
