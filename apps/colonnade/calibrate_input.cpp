// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate_input.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

struct Column {
  const char* name;
  std::optional<double> PillarPlace::*field;
  bool positive;
};

constexpr std::array<Column, 4> kColumns{{{"distance_m", &PillarPlace::distance, true},
                                          {"lateral_m", &PillarPlace::lateral, false},
                                          {"delta_rho_px", &PillarPlace::delta_rho_px, true},
                                          {"left_rho_px", &PillarPlace::left_rho_px, false}}};

/// Hands every row to `take`, with the frame where the table has that column.
void readRows(const std::filesystem::path& csv, bool with_frame,
              const std::function<void(std::size_t, const PillarPlace&)>& take) {
  std::ifstream file(csv);
  if (!std::filesystem::is_regular_file(csv) || !file)
    throw Error(csv.string() + ": cannot be read");
  constexpr int kFrame = -1;
  std::vector<int> meaning;
  bool has_frame = false;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::string where = csv.string() + ":" + std::to_string(number) + ": ";
    if (trimmed(line).empty() || trimmed(line).front() == '#') continue;
    const auto cells = fields(line, ',');
    if (meaning.empty()) {
      for (const std::string& name : cells) {
        const auto known = std::find_if(kColumns.begin(), kColumns.end(),
                                        [&](const Column& column) { return name == column.name; });
        const bool frame = with_frame && name == "frame";
        if (known == kColumns.end() && !frame)
          throw Error(where + "unknown column '" + name +
                      "'; known: " + (with_frame ? "frame, " : "") +
                      "distance_m, lateral_m, delta_rho_px, left_rho_px");
        has_frame = has_frame || frame;
        meaning.push_back(frame ? kFrame : static_cast<int>(known - kColumns.begin()));
      }
      if (with_frame && !has_frame) throw Error(where + "the column 'frame' is missing");
      continue;
    }
    if (cells.size() != meaning.size())
      throw Error(where + std::to_string(cells.size()) + " cells under " +
                  std::to_string(meaning.size()) + " columns");
    PillarPlace place;
    std::size_t frame = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (cells[i].empty() && meaning[i] != kFrame) continue;
      const auto value = parseDouble(cells[i]);
      const bool positive =
          meaning[i] != kFrame && kColumns[static_cast<std::size_t>(meaning[i])].positive;
      if (!value || !std::isfinite(*value) || (positive && *value <= 0.0) ||
          (meaning[i] == kFrame && (*value < 0.0 || *value > 1e9)))
        throw Error(where + "'" + cells[i] + "' is no " + (positive ? "positive " : "") + "number");
      if (meaning[i] == kFrame)
        frame = static_cast<std::size_t>(*value);
      else
        place.*kColumns[static_cast<std::size_t>(meaning[i])].field = *value;
    }
    take(frame, place);
  }
  if (meaning.empty()) throw Error(csv.string() + ": empty");
}

}  // namespace

std::vector<PillarPlace> readPlaces(const std::filesystem::path& csv) {
  std::vector<PillarPlace> places;
  readRows(csv, false, [&](std::size_t, const PillarPlace& place) { places.push_back(place); });
  return places;
}

std::map<std::size_t, PillarPlace> readPlacesByFrame(const std::filesystem::path& csv) {
  std::map<std::size_t, PillarPlace> places;
  readRows(csv, true, [&](std::size_t frame, const PillarPlace& place) { places[frame] = place; });
  return places;
}

}  // namespace colonnade
