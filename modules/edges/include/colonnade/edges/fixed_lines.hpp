// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "colonnade/edges/edge_line_backend.hpp"
#include "colonnade/edges/fixed_stage.hpp"

namespace colonnade {

/// The shape `run` uses for `fixed` and `rtl`: every degree near the vertical, every second
/// elsewhere.
FixedShape runShape();

/// The run-time registers for an image. The thresholds of the options are those of the `opencv`
/// backend and are scaled to the same contrast; smoothing_sigma_px is fixed at 1 px.
FixedParameters runParameters(const FixedShape& shape, const EdgeOptions& options,
                              const EdgeView& view, int width_px, int height_px);

/// Lines of a packet in the convention of EdgeLines (rho from the first pixel), selected.
std::vector<HoughLine> toHoughLines(const std::vector<FixedLine>& lines, int width_px,
                                    int height_px, const EdgeOptions& options);

}  // namespace colonnade
