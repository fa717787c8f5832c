// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "slice_surfaces.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {

double angleBetween(const InverseLine& a, const InverseLine& b) {
  return std::acos(std::clamp(a.normal().dot(b.normal()), -1.0, 1.0));
}

SliceSurfaces::SliceSurfaces(const InverseColumns& columns, double focal_px,
                             const DepthSlopeOptions& options)
    : columns_(columns), focal_px_(focal_px), options_(options), fits_(columns) {
  std::vector<InverseLine> pieces = straightPieces(columns, kPieceCost, kStrayCost);
  std::erase_if(pieces, [&](const InverseLine& piece) { return !isStrong(piece); });
  noise_ = columnNoise(columns, pieces);
  fits_.assumeScale(noise_.scale);
  for (const auto& piece : pieces) addSurface(piece);
}

/// Outlines fray over a few pixels and would be surfaces of their own.
bool SliceSurfaces::isStrong(const InverseLine& piece) const {
  constexpr double kPerFocal = 1.0 / 97.0;  // 6 columns of a camera with f = 580 px
  const double least = std::max(4.0, options_.min_columns * focal_px_ * kPerFocal / 6.0);
  return static_cast<double>(piece.columns()) >= least && piece.at(sAt(piece.first)) > 0.0 &&
         piece.at(sAt(piece.last - 1)) > 0.0 &&
         (endOf(piece, true) - endOf(piece, false)).norm() >= options_.min_face_m;
}

/// Lens and pattern bend long walls a little: pieces that go on straight are one surface.
void SliceSurfaces::addSurface(const InverseLine& piece) {
  if (!surfaces_.empty()) {
    InverseLine& before = surfaces_.back().line;
    const double s = 0.5 * (sAt(before.last - 1) + sAt(piece.first));
    const double step_m = std::abs(1.0 / before.at(s) - 1.0 / piece.at(s));
    if (angleBetween(before, piece) < options_.min_turn / 3.0 && step_m < reliefAt(s, before)) {
      before = fits_.fit(before.first, piece.last);
      surfaces_.back().last_begin = piece.first;
      return;
    }
  }
  surfaces_.push_back({piece, piece.last, piece.first});
}

double SliceSurfaces::columnSigma(double s, const InverseLine& line) const {
  const double z = 1.0 / std::max(line.at(s), 1e-3);
  return std::sqrt(columns_[line.first].variance) * z * z;
}

double SliceSurfaces::reliefAt(double s, const InverseLine& line) const {
  return 0.005 + 2.0 * columnSigma(s, line);
}

}  // namespace colonnade
