// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "colonnade/base/options.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// The landmark rule of the 2012 thesis as it stands there, for comparison. Slopes are those of
/// depth over pixel columns, millimetres per pixel.
struct SlopePixelOptions {
  static constexpr const char* kSection = "SlopePixels";
  int rows = 3;               ///< evenly spread over the image
  double min_depth_m = 1.22;  ///< thesis 2012, after the Kinect SDK 1.5: depth to be trusted
  double max_depth_m = 3.81;
  double colour_share = 0.0;  ///< alpha of a picture of full brightness; 0: depth alone

  void visit(OptionVisitor& v) {
    v.integer("rows", rows, {1, 2000}, "rows looked at, evenly spread");
    v.number("min_depth_m", min_depth_m, {0.1, 20}, "nearest landmark");
    v.number("max_depth_m", max_depth_m, {0.1, 20}, "farthest landmark");
    v.number("colour_share", colour_share, {0, 1},
             "weight of colour in a picture of full brightness, less in the dark; depth: the rest");
  }
};

/// A pixel at which the slope changes.
struct SlopePixel {
  int u = 0;
  int v = 0;
  double depth_m = 0.0;
  double weight = 0.0;  ///< what is compared with the threshold
};

/// Thesis 2012, "Landmark Detection" and "Improved landmark detection algorithm": every measured
/// pixel that is nearer than a neighbour in its row, and no farther than the other, with
///   W = alpha * colour + beta * |right slope - left slope| > threshold, alpha + beta = 1.
/// Neighbours are the next measured pixels, whatever lies between; colour is the larger of the
/// distances in (B, G, R) to both; alpha is colour_share times the mean brightness. O(pixels).
std::vector<SlopePixel> findSlopePixels(const Frame& frame, double threshold,
                                        const SlopePixelOptions& options);

}  // namespace colonnade
