// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/edges/edge_line_backend.hpp"

namespace colonnade {

/// The reference: Gaussian, Canny and standard Hough transform of OpenCV, as in the thesis
/// (2015, section 2.2), at 1 px and 1 degree.
class OpencvBackend : public EdgeLineBackend {
 public:
  explicit OpencvBackend(const EdgeOptions& options) : options_(options) {}

 private:
  EdgeLines process(const cv::Mat& gray, const EdgeView& view) override;

  EdgeOptions options_;
};

}  // namespace colonnade
