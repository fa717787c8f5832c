// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slice_surfaces.hpp"

namespace colonnade {

/// A lip of a frame or skirting board shows where a column covers no more of its surface.
constexpr double kResolved_m = 0.015;

/// The lines of surfaces beside their ends, by which corners are measured, and what is known of
/// columns there. right: of the right end, else of the left one.
class SurfaceEnds {
 public:
  explicit SurfaceEnds(const SliceSurfaces& surfaces) : surfaces_(surfaces) {}

  /// The part of a surface within the window beside its right or left end.
  InverseLine beside(const SliceSurface& surface, bool right) const;
  /// A frame or lip too narrow to be a surface of its own stands out from the end of a surface by
  /// `relief_m` at most: the corner is on it, so the surface is moved there, parallel to itself.
  /// limit: the first column of the next surface.
  InverseLine withRelief(InverseLine line, bool right, std::size_t limit) const;
  /// A lip that the columns do not resolve may stand out from the end of a surface at s.
  InverseLine withHiddenRelief(InverseLine line, double s) const;
  /// The columns in which two surfaces meet show some of both: not to be taken for either.
  InverseLine withoutMixed(const InverseLine& line, bool right, double s_corner) const;
  /// Pixels at an outline show what lies some pixels farther in (Nguyen, Izadi and Lovell 2012,
  /// lateral noise): on a slanting surface they are all too near or all too far.
  InverseLine withoutFray(const InverseLine& line, bool right) const;
  /// Metres of a surface that one column sees at s, beyond what shows every lip.
  double unresolved(const InverseLine& line, double s) const;

 private:
  InverseLine besideEnd(const InverseLine& line, bool right) const;
  bool isFitted(const InverseLine& line) const;
  InverseLine doubtful(InverseLine line, double columns) const;

  const SliceSurfaces& surfaces_;
};

}  // namespace colonnade
