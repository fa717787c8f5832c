// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "colonnade/detectors/segmentation.hpp"
#include "depth_cells.hpp"

namespace colonnade {

/// Cells of holes in the depth that surfaces within the sensor's reach surround.
std::vector<std::uint8_t> reflectiveCells(const DepthCells& cells,
                                          const SegmentationOptions& options);

}  // namespace colonnade
