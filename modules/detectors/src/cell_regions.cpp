// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cell_regions.hpp"

namespace colonnade {

std::vector<std::vector<std::size_t>> regionsOf(const std::vector<std::uint8_t>& marked,
                                                int columns, int rows) {
  std::vector<std::vector<std::size_t>> regions;
  std::vector<std::uint8_t> open = marked;
  for (std::size_t first = 0; first < open.size(); ++first) {
    if (!open[first]) continue;
    open[first] = 0;
    std::vector<std::size_t> region{first};
    for (std::size_t next = 0; next < region.size(); ++next) {
      const int column = static_cast<int>(region[next]) % columns;
      const int row = static_cast<int>(region[next]) / columns;
      for (int r = row - 1; r <= row + 1; ++r) {
        for (int c = column - 1; c <= column + 1; ++c) {
          if (c < 0 || r < 0 || c >= columns || r >= rows) continue;
          const auto cell = static_cast<std::size_t>(r * columns + c);
          if (!open[cell]) continue;
          open[cell] = 0;
          region.push_back(cell);
        }
      }
    }
    regions.push_back(std::move(region));
  }
  return regions;
}

}  // namespace colonnade
