// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/edges/edge_line_backend.hpp"

#include "colonnade/base/error.hpp"
#include "fixed_backend.hpp"
#include "opencv_backend.hpp"

namespace colonnade {

EdgeLines EdgeLineBackend::extract(const cv::Mat& gray, const EdgeView& view) {
  if (gray.empty()) return {};
  if (gray.type() != CV_8UC1) {
    throw Error("edge stage: the image is not 8-bit gray; convert it before extract()");
  }
  return process(gray, view);
}

std::unique_ptr<EdgeLineBackend> makeEdgeLineBackend(const std::string& name,
                                                     const EdgeOptions& options) {
  if (name == "opencv") return std::make_unique<OpencvBackend>(options);
  if (name == "fixed") return std::make_unique<FixedBackend>(options);
  throw Error("no edge backend \"" + name + "\" in this program; available: opencv, fixed",
              ExitCode::kUsage);
}

}  // namespace colonnade
