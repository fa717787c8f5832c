// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/score_json.hpp"

#include <cmath>

#include "colonnade/base/text.hpp"
#include "colonnade/evaluation/consistency.hpp"
#include "table_row.hpp"

namespace colonnade {
namespace {

using Json = nlohmann::ordered_json;

std::string percent(double share) { return formatFixed(100.0 * share, 0) + " %"; }

/// "begins 1.20 s after", or "before" for the opposite sign.
std::string offset(const char* what, double seconds, const char* positive, const char* negative) {
  return std::string(what) + " " + formatFixed(std::abs(seconds), 2) + " s " +
         (seconds >= 0.0 ? positive : negative) + " it";
}

}  // namespace

std::string toText(const SpanScore& span) {
  return "truth covers " + percent(span.estimate_in_truth) + " of the estimate (" +
         offset("begins", span.truth_starts_after_s, "after", "before") + ", " +
         offset("ends", span.truth_ends_before_s, "before", "after") + "); the estimate covers " +
         percent(span.truth_in_estimate) + " of the truth";
}

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
  json["rpe_1s_tum_m"] = orNull(score.rpe_1s_tum_m);
  json["heading_rmse_deg"] = score.heading_rmse_deg;
  json["end_drift_percent"] = orNull(score.end_drift_percent);
  json["nees_mean"] = orNull(score.nees_mean);
  json["nees_share_within_95"] = orNull(score.nees_share_within_95);
  json["nees_poses"] = score.nees_poses;
  json["nees_left_out"] = score.nees_left_out;
  json["nees_refused"] = score.nees_refused.empty() ? Json(nullptr) : Json(score.nees_refused);
  const Band band = consistencyBand(1, 3);
  json["nees_band_95"] = {band.low, band.high};
  json["span"] = {{"estimate_in_truth", score.span.estimate_in_truth},
                  {"truth_in_estimate", score.span.truth_in_estimate},
                  {"truth_starts_after_s", score.span.truth_starts_after_s},
                  {"truth_ends_before_s", score.span.truth_ends_before_s}};
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
  text += tableRow("alignment", alignment);
  text += tableRow("matched poses", std::to_string(score.matched) + " of " +
                                        std::to_string(score.estimated) + ", covering " +
                                        formatFixed(100.0 * score.coverage, 1) + " % of the truth");
  text += tableRow("time spans", toText(score.span));
  text += tableRow("path", formatFixed(score.path_length_m, 2) + " m");
  text += tableRow("ATE rmse", formatFixed(score.ate_rmse_m, 4) + " m (max " +
                                   formatFixed(score.ate_max_m, 4) + " m)");
  text += tableRow("heading rmse", formatFixed(score.heading_rmse_deg, 3) + " deg");
  for (const auto& error : score.rpe)
    text += tableRow("RPE over " + formatDouble(error.length_m, 3) + " m",
                     formatFixed(error.percent, 3) + " %, " + formatFixed(error.deg_per_m, 3) +
                         " deg/m (rmse of " + std::to_string(error.pieces) + " pieces)");
  if (score.rpe_1s_m)
    text += tableRow("RPE over 1 s", formatFixed(*score.rpe_1s_m, 4) + " m, " +
                                         formatFixed(*score.rpe_1s_deg, 3) + " deg");
  if (score.end_drift_percent)
    text += tableRow("drift at the end", formatFixed(*score.end_drift_percent, 3) +
                                             " % of the path (first poses laid on each other)");
  if (score.nees_mean) {
    const Band band = consistencyBand(1, 3);
    text += tableRow("NEES / 3",
                     formatFixed(*score.nees_mean, 3) +
                         " (1 is honest; one run: " + formatFixed(band.low, 2) + " to " +
                         formatFixed(band.high, 2) + " if its poses share one error), " +
                         formatFixed(100.0 * *score.nees_share_within_95, 1) +
                         " % of poses within the 95 % bound" +
                         (score.nees_left_out == 0
                              ? ""
                              : "; " + std::to_string(score.nees_left_out) + " poses left out"));
  } else if (!score.nees_refused.empty()) {
    text += tableRow("NEES / 3", "none: " + score.nees_refused);
  }
  return text;
}

}  // namespace colonnade
