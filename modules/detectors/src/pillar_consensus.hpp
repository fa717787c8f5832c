// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "across_profile.hpp"
#include "colonnade/detectors/levelled_camera.hpp"
#include "colonnade/detectors/refined_line.hpp"

namespace colonnade {

/// By which a line leans over from the projected vertical in the image, radians.
double leanOf(const LevelledCamera& camera, const RefinedLine& line);

/// Where the camera's roll is not quite right, all verticals of a frame lean over by the same;
/// where its pitch is not, by what is linear in the column. Theil and Sen's line through all of
/// them, where there are enough of them to tell.
class CommonLean {
 public:
  CommonLean(const LevelledCamera& camera, const RefinedLines& uprights);
  bool known() const { return known_; }
  double of(const RefinedLine& line) const;

 private:
  double at_0_ = 0.0, per_px_ = 0.0;
  bool known_ = false;
};

/// How wide the blur of the lens and of motion makes the edges of a frame. What rises much more
/// gently than most is the shade of a lamp or in a corner, however near it seems to be to an edge.
class CommonWidth {
 public:
  explicit CommonWidth(const std::vector<AcrossProfile>& uprights);
  /// Widest edge, px between the half heights of its gradient.
  double limit() const { return limit_px_; }

 private:
  double limit_px_;
};

}  // namespace colonnade
