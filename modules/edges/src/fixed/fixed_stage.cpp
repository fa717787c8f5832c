// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/edges/fixed_stage.hpp"

#include "canny.hpp"
#include "colonnade/base/error.hpp"
#include "hough.hpp"

namespace colonnade {

FixedStage::FixedStage(FixedShape shape) : shape_(std::move(shape)) {
  constexpr int kLast_deg = kFirstAngle_deg + static_cast<int>(kAngleTable.size()) - 1;
  int former = kFirstAngle_deg - 1;
  for (const int angle : shape_.angles_deg) {
    if (angle <= former || angle > kLast_deg) {
      throw Error("edge stage: angle " + std::to_string(angle) +
                  " is out of [-90, 89] or out of order; give ascending whole degrees");
    }
    former = angle;
  }
  if (shape_.hysteresis_passes < 0) throw Error("edge stage: negative number of passes");
}

FixedResult FixedStage::process(const cv::Mat& gray, const FixedParameters& parameters) {
  auto edges = fixed::canny(gray, parameters, shape_.hysteresis_passes);
  FixedResult result;
  result.lines = fixed::houghLines(edges, shape_, parameters, votes_);
  result.edges = std::move(edges.edges);
  return result;
}

}  // namespace colonnade
