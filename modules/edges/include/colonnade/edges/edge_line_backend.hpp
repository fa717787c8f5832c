// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "colonnade/edges/edge_options.hpp"
#include "colonnade/edges/edge_view.hpp"

namespace colonnade {

enum class LineClass { kVertical, kInclined };

/// A line of the Hough transform: u cos(theta) + v sin(theta) = rho, pixels from the image's first
/// pixel; theta = theta_index degrees (thesis 2015, section 2.2, figure 11). A seed: detectors
/// refit it.
struct HoughLine {
  int theta_index = 0;  ///< whole degrees, 0 to 179
  int rho_bin = 0;      ///< whole pixels, may be negative
  int votes = 0;
  LineClass line_class = LineClass::kVertical;
};

/// What the image stage gives: which pixels are edges, which way their gradient points, and lines.
struct EdgeLines {
  /// CV_8UC1: 0 = no edge, else 1 + the gradient direction in one of 8 sectors of 45 degrees
  /// (sector 0 is centred on +u, sector 2 on +v: brightness grows in that direction).
  cv::Mat edges;
  std::vector<HoughLine> lines;  ///< ordered by class, then votes (most first), theta, rho
};

/// The image stage, exchangeable: OpenCV, integer or hardware.
class EdgeLineBackend {
 public:
  virtual ~EdgeLineBackend() = default;
  /// gray: CV_8UC1, else Error. An empty image gives no edges and no lines. A known view lets a
  /// backend leave out lines that can be neither vertical in space nor on the floor.
  EdgeLines extract(const cv::Mat& gray, const EdgeView& view = {});
  /// What a user should know when all frames are done, a line each.
  virtual std::vector<std::string> notes() const { return {}; }

 private:
  /// gray: CV_8UC1, not empty.
  virtual EdgeLines process(const cv::Mat& gray, const EdgeView& view) = 0;
};

/// What runs unless another is asked for.
inline constexpr const char* kDefaultBackend = "fixed";

/// Throws Error (kUsage) for a backend this program was not built with.
std::unique_ptr<EdgeLineBackend> makeEdgeLineBackend(const std::string& name,
                                                     const EdgeOptions& options);

}  // namespace colonnade
