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
  EdgeLines extract(const cv::Mat& gray) override;

 private:
  EdgeOptions options_;
};

}  // namespace colonnade
