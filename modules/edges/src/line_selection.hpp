// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "colonnade/edges/edge_line_backend.hpp"

namespace colonnade {

/// The best lines of each class in the order of EdgeLines::lines, without near copies (2 degrees
/// and 3 px, also across the wrap of theta) of better ones.
std::vector<HoughLine> selectLines(std::vector<HoughLine> lines, int max_of_each_class);

}  // namespace colonnade
