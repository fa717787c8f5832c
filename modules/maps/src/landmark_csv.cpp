// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/maps/landmark_csv.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/csv_table.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

constexpr std::array kColumns = {
    "id",           "kind",        "x",         "y",      "direction", "extent_ax", "extent_ay",
    "extent_bx",    "extent_by",   "cov_xx",    "cov_xy", "cov_yy",    "hallway",   "pair_id",
    "observations", "first_stamp", "last_stamp"};

LandmarkKind kindOf(const CsvTable::Row& row) {
  for (int i = 0; i < kLandmarkKinds; ++i) {
    const auto kind = static_cast<LandmarkKind>(i);
    if (row.text("kind") == name(kind)) return kind;
  }
  row.complain("kind", "pillar, floor_edge or depth_slope");
}

LandmarkRecord toRecord(const CsvTable::Row& row) {
  LandmarkRecord record;
  record.id = LandmarkId{row.integer("id")};
  record.kind = kindOf(row);
  record.p_world = {row.number("x"), row.number("y")};
  const double xx = row.number("cov_xx"), xy = row.number("cov_xy"), yy = row.number("cov_yy");
  record.covariance << xx, xy, xy, yy;
  if (!row.empty("direction")) record.direction = row.number("direction");
  if (record.kind == LandmarkKind::kFloorEdge && !record.direction)
    row.complain("direction", "a number, which every floor edge needs");
  record.extent_a = {row.number("extent_ax"), row.number("extent_ay")};
  record.extent_b = {row.number("extent_bx"), row.number("extent_by")};
  record.hallway = row.integer("hallway");
  if (!row.empty("pair_id")) record.pair_id = LandmarkId{row.integer("pair_id")};
  record.observations = row.integer("observations");
  record.first_stamp_s = row.number("first_stamp");
  record.last_stamp_s = row.number("last_stamp");
  return record;
}

}  // namespace

void writeLandmarksCsv(const std::filesystem::path& path, const LandmarkMap& landmarks) {
  std::string text = joined({kColumns.begin(), kColumns.end()}, ",") + "\n";
  for (const auto& landmark : landmarks) {
    const auto& P = landmark.covariance;
    std::vector<std::string> row = {std::to_string(number(landmark.id)), name(landmark.kind)};
    const auto add = [&](double value) { row.push_back(formatDouble(value)); };
    add(landmark.p_world.x());
    add(landmark.p_world.y());
    row.push_back(landmark.direction ? formatDouble(*landmark.direction) : "");
    for (const auto& end : {landmark.extent_a, landmark.extent_b}) {
      add(end.x());
      add(end.y());
    }
    for (const double value : {P(0, 0), P(0, 1), P(1, 1)}) add(value);
    row.push_back(std::to_string(landmark.hallway));
    row.push_back(landmark.pair_id ? std::to_string(number(*landmark.pair_id)) : "");
    row.push_back(std::to_string(landmark.observations));
    row.push_back(formatFixed(landmark.first_stamp_s, 6));
    row.push_back(formatFixed(landmark.last_stamp_s, 6));
    text += joined(row, ",") + "\n";
  }
  writeFileAtomically(path, text);
}

LandmarkMap readLandmarksCsv(const std::filesystem::path& path) {
  CsvTable table(path, {kColumns.begin(), kColumns.end()}, "a landmark file");
  LandmarkMap landmarks;
  std::set<LandmarkId> ids;
  while (const auto row = table.next()) {
    landmarks.push_back(toRecord(*row));
    if (!ids.insert(landmarks.back().id).second)
      throw Error(row->where() + ": id " + std::to_string(number(landmarks.back().id)) +
                  " stands twice; every landmark needs its own");
  }
  std::sort(landmarks.begin(), landmarks.end(),
            [](const LandmarkRecord& a, const LandmarkRecord& b) { return a.id < b.id; });
  return landmarks;
}

}  // namespace colonnade
