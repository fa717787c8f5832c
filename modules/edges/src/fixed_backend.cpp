// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "fixed_backend.hpp"

namespace colonnade {

EdgeLines FixedBackend::process(const cv::Mat& gray, const EdgeView& view) {
  auto found =
      stage_.process(gray, runParameters(stage_.shape(), options_, view, gray.cols, gray.rows));
  return {std::move(found.edges), toHoughLines(found.lines, gray.cols, gray.rows, options_)};
}

}  // namespace colonnade
