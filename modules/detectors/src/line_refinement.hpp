// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "colonnade/detectors/refined_line.hpp"
#include "line_walker.hpp"

namespace colonnade {

/// Refines guesses on one image. edges: as EdgeLines::edges; bits: those of its steep or flat
/// edges, with rows or columns as steps.
class LineRefiner {
 public:
  LineRefiner(const cv::Mat& gray, const cv::Mat& edges, EdgeBits bits, bool steep,
              const LineRefinementOptions& options);

  /// Appends the lines that edge pixels beside the guess support.
  void refine(const Straight& guess, RefinedLines& lines);

 private:
  /// `samples` keeps those that agree.
  std::optional<RefinedLine> fitRun(Samples& samples, int sign) const;
  /// The line, or its parts where it is broken.
  void appendStraightParts(const RefinedLine& line, SampleSpan samples, RefinedLines& lines) const;

  Walker walker_;
  bool steep_;
  LineRefinementOptions options_;
  Samples rising_, falling_, beside_, some_;
};

/// Longest first, without those that say nothing a longer one does not.
RefinedLines withoutDuplicates(RefinedLines lines, double duplicate_px);

}  // namespace colonnade
