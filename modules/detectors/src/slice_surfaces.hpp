// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "colonnade/detectors/depth_slope_detector.hpp"
#include "depth_slope_segments.hpp"

namespace colonnade {

/// A wall or a face of something: straight, or nearly so.
struct SliceSurface {
  InverseLine line;
  std::size_t first_end = 0;   ///< of the straight piece at its left end
  std::size_t last_begin = 0;  ///< of the one at its right end
};

/// What a piece of the slice must be worth, chi-squared.
constexpr double kPieceCost = 25.0;  ///< a bend
constexpr double kStrayCost = 9.0;   ///< a column of no piece: three sigma

double angleBetween(const InverseLine& a, const InverseLine& b);

/// The surfaces of a slice, left to right, and what its columns say of their noise.
class SliceSurfaces {
 public:
  /// Refers to what it is given.
  SliceSurfaces(const InverseColumns& columns, double focal_px, const DepthSlopeOptions& options);

  const std::vector<SliceSurface>& all() const { return surfaces_; }
  const InverseColumns& columns() const { return columns_; }
  double focal_px() const { return focal_px_; }
  const DepthSlopeOptions& options() const { return options_; }
  const InverseLineFits& fits() const { return fits_; }
  const ColumnNoise& noise() const { return noise_; }

  double sAt(std::size_t column) const { return columns_[column].s; }
  Eigen::Vector2d endOf(const InverseLine& line, bool right) const {
    return line.point(sAt(right ? line.last - 1 : line.first));
  }
  /// Of the depth of a column at s on a line, m.
  double columnSigma(double s, const InverseLine& line) const;

 private:
  bool isStrong(const InverseLine& piece) const;
  void addSurface(const InverseLine& piece);
  double reliefAt(double s, const InverseLine& line) const;

  const InverseColumns& columns_;
  double focal_px_;
  const DepthSlopeOptions& options_;
  InverseLineFits fits_;
  ColumnNoise noise_;
  std::vector<SliceSurface> surfaces_;
};

}  // namespace colonnade
