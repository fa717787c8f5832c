// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tum_folder.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <tuple>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/frames/tum_import.hpp"

namespace colonnade {
namespace {

/// Calls `use(words, where)` for every line that is neither empty nor a comment.
template <class Use>
void forEachLine(const std::filesystem::path& path, ExitCode code, Use use) {
  errno = 0;
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path))
    throw Error(path.string() + ": " + (errno != 0 ? std::strerror(errno) : "is a folder"), code);
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const auto entries = words(trimmed(line.substr(0, line.find('#'))));
    if (!entries.empty()) use(entries, path.string() + ":" + std::to_string(number) + ": ");
  }
}

}  // namespace

std::vector<TumEntry> readTumList(const std::filesystem::path& path) {
  std::vector<TumEntry> entries;
  forEachLine(path, ExitCode::kFailed, [&](const auto& fields, const std::string& where) {
    const auto stamp = parseDouble(fields[0]);
    if (fields.size() != 2 || !stamp || !std::isfinite(*stamp))
      throw Error(where + "expected `stamp file`");
    entries.push_back({*stamp, fields[1]});
  });
  std::stable_sort(entries.begin(), entries.end(),
                   [](const auto& a, const auto& b) { return a.stamp_s < b.stamp_s; });
  return entries;
}

std::vector<std::pair<std::size_t, std::size_t>> associate(const std::vector<TumEntry>& a,
                                                           const std::vector<TumEntry>& b,
                                                           double tolerance_s) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> near;
  std::size_t first = 0;
  constexpr double kRounding = 1e-9;
  for (std::size_t i = 0; i < a.size(); ++i) {
    while (first < b.size() && b[first].stamp_s < a[i].stamp_s - tolerance_s - kRounding) ++first;
    for (std::size_t j = first;
         j < b.size() && b[j].stamp_s <= a[i].stamp_s + tolerance_s + kRounding; ++j)
      near.emplace_back(std::abs(a[i].stamp_s - b[j].stamp_s), i, j);
  }
  std::sort(near.begin(), near.end());
  std::vector<bool> a_used(a.size()), b_used(b.size());
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const auto& [difference, i, j] : near) {
    if (a_used[i] || b_used[j]) continue;
    a_used[i] = b_used[j] = true;
    pairs.emplace_back(i, j);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

TumCalibration readTumCalibration(const std::filesystem::path& path) {
  TumCalibration calibration;
  std::map<std::string, double> values;
  forEachLine(path, ExitCode::kUsage, [&](const auto& fields, const std::string& where) {
    static const std::vector<std::string> kKnown{"fx", "fy", "cx", "cy", "depth_units_per_metre"};
    const auto value = fields.size() == 2 ? parseDouble(fields[1]) : std::nullopt;
    if (!value || !std::isfinite(*value))
      throw Error(where + "expected `key number`", ExitCode::kUsage);
    if (std::find(kKnown.begin(), kKnown.end(), fields[0]) == kKnown.end())
      throw Error(where + "unknown key " + fields[0] + " (known: " + joined(kKnown, ", ") + ")",
                  ExitCode::kUsage);
    if (*value <= 0.0) throw Error(where + fields[0] + " must be positive", ExitCode::kUsage);
    values[fields[0]] = *value;
  });
  for (const auto& [key, target] : {std::pair{"fx", &calibration.fx_px},
                                    {"fy", &calibration.fy_px},
                                    {"cx", &calibration.cx_px},
                                    {"cy", &calibration.cy_px}}) {
    if (!values.contains(key))
      throw Error(path.string() + ": " + key + " is missing", ExitCode::kUsage);
    *target = values[key];
  }
  if (values.contains("depth_units_per_metre"))
    calibration.depth_units_per_metre = values["depth_units_per_metre"];
  return calibration;
}

}  // namespace colonnade
