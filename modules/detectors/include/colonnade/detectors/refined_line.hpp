// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/options.hpp"
#include "colonnade/edges/edge_line_backend.hpp"

namespace colonnade {

/// How seeds of the Hough transform become measured lines.
struct LineRefinementOptions {
  static constexpr const char* kSection = "Lines";
  double search_px = 3.0;  ///< edge pixels this far from the seed belong to it
  double inlier_px = 1.2;  ///< from the fitted line
  double max_gap_px = 12.0;
  double min_length_px = 40.0;
  double min_support = 0.7;         ///< share of the steps along the line with an edge pixel
  double max_residual_px = 0.6;     ///< root mean square; texture scatters more than edges
  double min_aligned = 0.75;        ///< share of pixels whose gradient points across the line
  double duplicate_px = 2.0;        ///< lines this close with the same sign are one line
  double correlated_samples = 4.0;  ///< neighbouring edge pixels share their error over this many

  void visit(OptionVisitor& v) {
    v.number("search_px", search_px, {1, 10}, "reach from the Hough line to its edge pixels");
    v.number("inlier_px", inlier_px, {0.3, 5}, "from the fitted line");
    v.number("max_gap_px", max_gap_px, {1, 100}, "gap that does not end a line");
    v.number("min_length_px", min_length_px, {10, 1000}, "shortest line kept");
    v.number("min_support", min_support, {0.1, 1}, "share of a line's steps with an edge pixel");
    v.number("max_residual_px", max_residual_px, {0.1, 5}, "root mean square of a line's pixels");
    v.number("min_aligned", min_aligned, {0, 1}, "share of pixels with a gradient across the line");
    v.number("duplicate_px", duplicate_px, {0, 10}, "lines closer than this are one");
    v.number("correlated_samples", correlated_samples, {1, 50}, "edge pixels that share an error");
  }
};

/// A straight edge measured to a fraction of a pixel. Steep lines are u = offset + slope (v -
/// middle), flat ones v = offset + slope (u - middle); s is the coordinate run along (v or u).
struct RefinedLine {
  bool steep = true;
  double middle = 0.0;
  double offset = 0.0;
  double slope = 0.0;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of (offset, slope), px
  double begin = 0.0;                                    ///< of the supported extent, in s
  double end = 0.0;
  int gradient_sign = 0;  ///< +1: brightness grows towards +u (steep) or +v (flat)
  int samples = 0;

  double across(double s) const { return offset + slope * (s - middle); }
  Eigen::Vector2d at(double s) const {
    return steep ? Eigen::Vector2d(across(s), s) : Eigen::Vector2d(s, across(s));
  }
  double variance(double s) const {  ///< of across(s), px squared
    const Eigen::Vector2d j(1.0, s - middle);
    return j.dot(covariance * j);
  }
  double length() const { return (at(end) - at(begin)).norm(); }
};

using RefinedLines = std::vector<RefinedLine>;

/// Fits every seed to the edge pixels beside it, one line for each sign of the gradient and each
/// supported run, duplicates removed, longest first. gray: CV_8UC1 of the size of edges.edges.
RefinedLines refineLines(const cv::Mat& gray, const EdgeLines& edges,
                         const LineRefinementOptions& options);

}  // namespace colonnade
