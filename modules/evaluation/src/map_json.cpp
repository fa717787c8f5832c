// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/map_json.hpp"

#include "colonnade/base/text.hpp"
#include "table_row.hpp"

namespace colonnade {
namespace {

using Json = nlohmann::ordered_json;

constexpr LandmarkKind kKinds[] = {LandmarkKind::kPillarEdge, LandmarkKind::kFloorEdge,
                                   LandmarkKind::kDepthSlope};

Json numbers(const std::vector<LandmarkId>& ids) {
  Json list = Json::array();
  for (const auto id : ids) list.push_back(number(id));
  return list;
}

Json toJson(const KindScore& score, LandmarkKind kind) {
  Json json;
  json["estimated"] = score.estimated;
  json["right"] = score.right;
  if (kind == LandmarkKind::kFloorEdge) json["further_pieces"] = score.further;
  json["duplicates"] = score.duplicates;
  json["false"] = score.false_ids.size();
  if (kind != LandmarkKind::kFloorEdge) json["false_at_other_kind"] = score.other_kind;
  json["true_seen"] = score.true_seen;
  json["true_found"] = score.true_found;
  json["precision"] = orNull(score.precision);
  json["recall"] = orNull(score.recall);
  if (kind == LandmarkKind::kFloorEdge) {
    json["offset_rmse_m"] = orNull(score.offset_rmse_m);
    json["direction_rmse_deg"] = orNull(score.direction_rmse_deg);
    json["extent_on_truth"] = orNull(score.extent_on_truth);
    json["length_recall"] = orNull(score.length_recall);
  } else {
    json["position_rmse_m"] = orNull(score.position_rmse_m);
    json["position_median_m"] = orNull(score.position_median_m);
  }
  json["nees_mean"] = orNull(score.nees_mean);
  json["nees_landmarks"] = score.nees_landmarks;
  if (kind != LandmarkKind::kFloorEdge) json["improbable_ids"] = numbers(score.improbable_ids);
  json["duplicate_ids"] = numbers(score.duplicate_ids);
  json["false_ids"] = numbers(score.false_ids);
  json["missed_truth_ids"] = numbers(score.missed_ids);
  return json;
}

std::string percent(const std::optional<double>& share) {
  return share ? formatFixed(100.0 * *share, 0) + " %" : "none";
}

std::string shares(const KindScore& score, LandmarkKind kind) {
  std::string text = "precision " + percent(score.precision) + " (" +
                     std::to_string(score.right + score.further) + " of " +
                     std::to_string(score.estimated) + ", " + std::to_string(score.duplicates) +
                     " duplicates, " + std::to_string(score.false_ids.size()) + " false";
  if (score.other_kind > 0)
    text += ", " + std::to_string(score.other_kind) + " of these at the other upright kind";
  text += "), recall " + percent(score.recall) + " (" + std::to_string(score.true_found) + " of " +
          std::to_string(score.true_seen) + " seen";
  if (kind == LandmarkKind::kFloorEdge && score.length_recall)
    text += "; " + percent(score.length_recall) + " of their length";
  return text + ")";
}

std::string errors(const KindScore& score) {
  std::vector<std::string> parts;
  if (score.position_rmse_m)
    parts.push_back("position rmse " + formatFixed(*score.position_rmse_m, 3) + " m, median " +
                    formatFixed(*score.position_median_m, 3) + " m");
  if (score.offset_rmse_m)
    parts.push_back("offset rmse " + formatFixed(*score.offset_rmse_m, 3) + " m, direction " +
                    formatFixed(*score.direction_rmse_deg, 2) + " deg");
  if (score.extent_on_truth)
    parts.push_back(percent(score.extent_on_truth) + " of the extents on a true edge");
  if (score.nees_mean)
    parts.push_back(
        "NEES / dof " + formatFixed(*score.nees_mean, 2) + " of " +
        std::to_string(score.nees_landmarks) +
        (score.improbable_ids.empty()
             ? ""
             : " (" + std::to_string(score.improbable_ids.size()) + " farther off than 3 sigma)"));
  return joined(parts, ", ");
}

}  // namespace

Json toJson(const LandmarkScore& score) {
  Json json;
  json["gate_m"] = score.options.gate_m;
  json["gate_deg"] = degrees(score.options.gate);
  json["min_observations"] = score.options.min_observations;
  for (const auto kind : kKinds) json[name(kind)] = toJson(score[kind], kind);
  return json;
}

Json toJson(const WallScore& score) {
  return {{"edges", score.edges},
          {"angle_rmse_deg", orNull(score.angle_rmse_deg)},
          {"direction_rmse_deg", orNull(score.direction_rmse_deg)}};
}

Json toJson(const FloorScore& score) {
  return {{"iou", score.iou},
          {"precision", score.precision},
          {"recall", score.recall},
          {"estimate_m2", score.estimate_m2},
          {"truth_m2", score.truth_m2},
          {"both_m2", score.both_m2},
          {"resolution_m", score.resolution_m}};
}

std::string toText(const LandmarkScore& score) {
  std::string text =
      tableRow("landmarks", "same alignment; right within " +
                                formatDouble(score.options.gate_m, 6) + " m (floor edges " +
                                formatDouble(degrees(score.options.gate), 6) + " deg), seen = in " +
                                std::to_string(score.options.min_observations) + " frames or more");
  for (const auto kind : kKinds) {
    text += tableRow(name(kind), shares(score[kind], kind));
    const std::string details = errors(score[kind]);
    if (!details.empty()) text += tableRow("", details);
  }
  const auto& walls = score.walls;
  if (walls.angle_rmse_deg)
    text += tableRow("angle between walls", formatFixed(*walls.angle_rmse_deg, 3) +
                                                " deg rmse, weighted by length (" +
                                                std::to_string(walls.edges) + " floor edges)");
  if (walls.direction_rmse_deg)
    text += tableRow("direction of walls",
                     formatFixed(*walls.direction_rmse_deg, 3) + " deg rmse, weighted by length");
  return text;
}

std::string toText(const FloorScore& score) {
  return tableRow("free floor",
                  "IoU " + formatFixed(score.iou, 3) + ", precision " + percent(score.precision) +
                      " of " + formatFixed(score.estimate_m2, 1) + " m2 mapped, recall " +
                      percent(score.recall) + " of " + formatFixed(score.truth_m2, 1) +
                      " m2 true (the robot sees a part)");
}

}  // namespace colonnade
