// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "canny.hpp"
#include "colonnade/edges/fixed_stage.hpp"

namespace colonnade::fixed {

/// Votes and lines of one frame. votes is scratch that keeps its room between frames.
std::vector<FixedLine> houghLines(const CannyResult& edges, const FixedShape& shape,
                                  const FixedParameters& parameters,
                                  std::vector<unsigned short>& votes);

}  // namespace colonnade::fixed
