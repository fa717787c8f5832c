// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "colonnade/evaluation/floor_score.hpp"
#include "colonnade/evaluation/landmark_score.hpp"

namespace colonnade {

/// The `landmarks` object of `evaluate --json`: the options and one object per kind. Numbers the
/// data cannot tell are null.
nlohmann::ordered_json toJson(const LandmarkScore& score);
/// The `walls` object.
nlohmann::ordered_json toJson(const WallScore& score);
/// The `free_area` object.
nlohmann::ordered_json toJson(const FloorScore& score);

/// Tables for people; each ends with a line break.
std::string toText(const LandmarkScore& score);
std::string toText(const FloorScore& score);

}  // namespace colonnade
