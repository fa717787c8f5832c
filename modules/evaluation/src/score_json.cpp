// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/score_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

using Json = nlohmann::ordered_json;

Json orNull(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

std::string row(const std::string& label, const std::string& value) {
  std::string padded = "  " + label;
  padded.resize(std::max<std::size_t>(padded.size() + 2, 26), ' ');
  return padded + value + "\n";
}

}  // namespace

Json toJson(const TrajectoryScore& score) {
  Json json;
  json["alignment"] = name(score.alignment);
  json["ate_rmse_m"] = score.ate_rmse_m;
  json["ate_max_m"] = score.ate_max_m;
  for (const int length : {1, 2, 5, 10}) {
    const auto* error = score.rpeOver(length);
    const std::string key = "rpe_" + std::to_string(length) + "m_";
    json[key + "percent"] = error ? Json(error->percent) : Json(nullptr);
    json[key + "deg_per_m"] = error ? Json(error->deg_per_m) : Json(nullptr);
  }
  json["rpe_1s_m"] = orNull(score.rpe_1s_m);
  json["rpe_1s_deg"] = orNull(score.rpe_1s_deg);
  json["heading_rmse_deg"] = score.heading_rmse_deg;
  json["end_drift_percent"] = orNull(score.end_drift_percent);
  json["nees_mean"] = orNull(score.nees_mean);
  json["nees_share_within_95"] = orNull(score.nees_share_within_95);
  json["nees_poses"] = score.nees_poses;
  json["coverage"] = score.coverage;
  json["matched"] = score.matched;
  json["estimated"] = score.estimated;
  json["path_length_m"] = score.path_length_m;
  return json;
}

std::string toText(const TrajectoryScore& score) {
  std::string alignment = name(score.alignment);
  if (score.alignment == Alignment::kSe2) alignment += " (rigid in x, y, yaw; no scale)";
  if (score.alignment == Alignment::kSe3) alignment += " (rigid, Umeyama; no scale)";
  std::string text;
  text += row("alignment", alignment);
  text += row("matched poses", std::to_string(score.matched) + " of " +
                                   std::to_string(score.estimated) + ", covering " +
                                   formatFixed(100.0 * score.coverage, 1) + " % of the truth");
  text += row("path", formatFixed(score.path_length_m, 2) + " m");
  text += row("ATE rmse", formatFixed(score.ate_rmse_m, 4) + " m (max " +
                              formatFixed(score.ate_max_m, 4) + " m)");
  text += row("heading rmse", formatFixed(score.heading_rmse_deg, 3) + " deg");
  for (const auto& error : score.rpe)
    text += row("RPE over " + formatDouble(error.length_m, 3) + " m",
                formatFixed(error.percent, 3) + " %, " + formatFixed(error.deg_per_m, 3) +
                    " deg/m (rmse of " + std::to_string(error.pieces) + " pieces)");
  if (score.rpe_1s_m)
    text += row("RPE over 1 s", formatFixed(*score.rpe_1s_m, 4) + " m, " +
                                    formatFixed(*score.rpe_1s_deg, 3) + " deg");
  if (score.end_drift_percent)
    text += row("drift at the end", formatFixed(*score.end_drift_percent, 3) +
                                        " % of the path (first poses laid on each other)");
  if (score.nees_mean)
    text += row("NEES / 3", formatFixed(*score.nees_mean, 3) + " (1 is honest), " +
                                formatFixed(100.0 * *score.nees_share_within_95, 1) +
                                " % of poses within the 95 % bound");
  return text;
}

}  // namespace colonnade
