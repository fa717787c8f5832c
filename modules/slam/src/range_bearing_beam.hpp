// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "range_bearing_joint.hpp"

namespace colonnade {

/// Carries several hypotheses over one frame, reading by reading: each may be of a landmark within
/// its gate, the first sight of a new one, or an outlier; the likeliest of all continuations are
/// kept, likeliest first. In a map that stays as it is none is kept that says the same of the
/// robot, and of the landmarks seen in the frame, as a likelier one.
ReadingDecisions decideByHypotheses(const ReadingFrame& frame, const RangeBearingOptions& options,
                                    std::vector<RangeBearingHypothesis>& hypotheses);

}  // namespace colonnade
