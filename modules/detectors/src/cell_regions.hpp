// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace colonnade {

/// Connected regions (by sides and corners) of the marked cells of a grid: the cells of each, in
/// the order of its first cell.
std::vector<std::vector<std::size_t>> regionsOf(const std::vector<std::uint8_t>& marked,
                                                int columns, int rows);

}  // namespace colonnade
