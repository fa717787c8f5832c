// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/maps/landmark_csv.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <string>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

constexpr std::array kColumns = {
    "id",           "kind",        "x",         "y",      "direction", "extent_ax", "extent_ay",
    "extent_bx",    "extent_by",   "cov_xx",    "cov_xy", "cov_yy",    "hallway",   "pair_id",
    "observations", "first_stamp", "last_stamp"};

/// One row, its fields found by the name of their column.
class Row {
 public:
  Row(const std::map<std::string, std::size_t>& columns, std::vector<std::string> entries,
      std::string where)
      : columns_(columns), entries_(std::move(entries)), where_(std::move(where)) {}

  const std::string& text(const char* column) const { return entries_[columns_.at(column)]; }

  double number(const char* column) const {
    const auto value = parseDouble(text(column));
    if (!value || !std::isfinite(*value)) complain(column, "a number");
    return *value;
  }

  std::int32_t integer(const char* column) const {
    const double value = number(column);
    constexpr double kLimit = std::numeric_limits<std::int32_t>::max();
    if (value != std::floor(value) || std::abs(value) > kLimit) complain(column, "a whole number");
    return static_cast<std::int32_t>(value);
  }

  LandmarkKind kind() const {
    for (int i = 0; i < kLandmarkKinds; ++i) {
      const auto kind = static_cast<LandmarkKind>(i);
      if (text("kind") == name(kind)) return kind;
    }
    complain("kind", "pillar, floor_edge or depth_slope");
  }

  [[noreturn]] void complain(const char* column, const std::string& wanted) const {
    throw Error(where_ + ": column " + column + ": \"" + text(column) + "\" is not " + wanted);
  }

 private:
  const std::map<std::string, std::size_t>& columns_;
  std::vector<std::string> entries_;
  std::string where_;
};

LandmarkRecord toRecord(const Row& row) {
  LandmarkRecord record;
  record.id = LandmarkId{row.integer("id")};
  record.kind = row.kind();
  record.p_world = {row.number("x"), row.number("y")};
  record.covariance << row.number("cov_xx"), row.number("cov_xy"), row.number("cov_xy"),
      row.number("cov_yy");
  if (!row.text("direction").empty()) record.direction = row.number("direction");
  if (record.kind == LandmarkKind::kFloorEdge && !record.direction)
    row.complain("direction", "a number, which every floor edge needs");
  record.extent_a = {row.number("extent_ax"), row.number("extent_ay")};
  record.extent_b = {row.number("extent_bx"), row.number("extent_by")};
  record.hallway = row.integer("hallway");
  if (!row.text("pair_id").empty()) record.pair_id = LandmarkId{row.integer("pair_id")};
  record.observations = row.integer("observations");
  record.first_stamp_s = row.number("first_stamp");
  record.last_stamp_s = row.number("last_stamp");
  return record;
}

std::map<std::string, std::size_t> readHeader(const std::string& line, const std::string& where) {
  std::map<std::string, std::size_t> columns;
  const auto names = fields(line, ',');
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!columns.emplace(names[i], i).second)
      throw Error(where + ": column " + names[i] + " stands twice");
  for (const char* column : kColumns)
    if (!columns.contains(column))
      throw Error(where + ": column " + column + " is missing; a landmark file starts with \"" +
                  joined({kColumns.begin(), kColumns.end()}, ",") + "\"");
  return columns;
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
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path))
    throw Error(path.string() + ": cannot be read as a landmark file");
  LandmarkMap landmarks;
  std::map<std::string, std::size_t> columns;
  std::set<LandmarkId> ids;
  std::string line;
  for (int line_number = 1; std::getline(file, line); ++line_number) {
    const std::string where = path.string() + ":" + std::to_string(line_number);
    line = trimmed(line);
    if (line.empty() || line.front() == '#') continue;
    if (columns.empty()) {
      columns = readHeader(line, where);
      continue;
    }
    auto entries = fields(line, ',');
    if (entries.size() != columns.size())
      throw Error(where + ": the header has " + std::to_string(columns.size()) +
                  " columns, this row " + std::to_string(entries.size()));
    landmarks.push_back(toRecord(Row(columns, std::move(entries), where)));
    if (!ids.insert(landmarks.back().id).second)
      throw Error(where + ": id " + std::to_string(number(landmarks.back().id)) +
                  " stands twice; every landmark needs its own");
  }
  if (columns.empty()) throw Error(path.string() + ": has no header line; it is no landmark file");
  std::sort(landmarks.begin(), landmarks.end(),
            [](const LandmarkRecord& a, const LandmarkRecord& b) { return a.id < b.id; });
  return landmarks;
}

}  // namespace colonnade
