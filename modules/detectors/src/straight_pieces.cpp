// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "straight_pieces.hpp"

#include <cmath>

namespace colonnade {

std::vector<StraightPiece> straightPieces(const DepthCells& cells, int row,
                                          const SegmentationOptions& options) {
  const float* const near_m = &cells.near_m[cells.index(0, row)];
  std::vector<StraightPiece> pieces;
  const auto goesOn = [&](const InverseDepthLine& line, int column) {
    const auto z = static_cast<double>(near_m[column]);
    const double tolerance_m = 0.5 * (options.tolerance_m + options.tolerance_per_m2 * z * z);
    const double expected_m = line.at(column);
    return expected_m > 0.0 &&
           std::abs(expected_m - z) < (line.count() < 3 ? 3.0 : 1.0) * tolerance_m;
  };
  const auto place = [&](int column) -> Eigen::Vector3d {
    return static_cast<double>(near_m[column]) * cells.ray(column, row);
  };
  for (int column = 0; column < cells.columns;) {
    if (near_m[column] == DepthCells::kNone) {
      ++column;
      continue;
    }
    StraightPiece piece;
    piece.first = column;
    do {
      piece.line.add(column, near_m[column]);
      ++column;
    } while (column < cells.columns && near_m[column] != DepthCells::kNone &&
             goesOn(piece.line, column));
    piece.end = column;
    piece.length_m = (place(piece.end - 1) - place(piece.first)).norm();
    if (piece.line.count() >= 3) pieces.push_back(piece);
  }
  return pieces;
}

}  // namespace colonnade
