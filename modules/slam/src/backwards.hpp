// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/slam/explanation.hpp"

namespace colonnade {

/// The way back over a motion.
MotionIncrement reversed(const Drive::Motion& motion);

/// The same drive explained from its end by an estimator of its own: what made the first one go
/// wrong comes last, when the map is known. Its landmarks bear the numbers of those of `forwards`
/// they share most readings with, new ones otherwise; the world is that of `forwards`.
Explanation explainedBackwards(const DriveRecord& record, const Explanation& forwards,
                               const RangeBearingOptions& options,
                               const FilterOptions& filter_options);

}  // namespace colonnade
