// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/edges/fixed_lines.hpp"

namespace colonnade {

/// The image stage in integers, with the result of the accelerator bit for bit.
class FixedBackend : public EdgeLineBackend {
 public:
  explicit FixedBackend(const EdgeOptions& options) : options_(options), stage_(runShape()) {}

 private:
  EdgeLines process(const cv::Mat& gray, const EdgeView& view) override;

  EdgeOptions options_;
  FixedStage stage_;
};

}  // namespace colonnade
