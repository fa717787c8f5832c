// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "colonnade/evaluation/trajectory_score.hpp"

namespace colonnade {

/// The `trajectory` object of summary.json and of `evaluate --json`. Numbers the data cannot tell
/// are null.
nlohmann::ordered_json toJson(const TrajectoryScore& score);

/// One sentence on how far the time spans agree.
std::string toText(const SpanScore& span);

/// A table for people, naming the alignment of every number; ends with a line break.
std::string toText(const TrajectoryScore& score);

}  // namespace colonnade
