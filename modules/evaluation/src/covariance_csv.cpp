// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/covariance_csv.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <string>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

constexpr const char* kHeader = "stamp,xx,xy,xphi,yy,yphi,phiphi";

}  // namespace

void writeCovarianceCsv(const std::filesystem::path& path,
                        const std::vector<StampedCovariance>& covariances) {
  std::string text = std::string(kHeader) + "\n";
  for (const auto& row : covariances) {
    const auto& P = row.covariance;
    text += formatFixed(row.stamp_s, 6);
    for (const double value : {P(0, 0), P(0, 1), P(0, 2), P(1, 1), P(1, 2), P(2, 2)})
      text += "," + formatDouble(value, 12);
    text += "\n";
  }
  writeFileAtomically(path, text);
}

std::vector<StampedCovariance> readCovarianceCsv(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path))
    throw Error(path.string() + ": cannot be read as covariances of a trajectory");
  std::vector<StampedCovariance> rows;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const auto complain = [&](const std::string& what) {
      throw Error(path.string() + ":" + std::to_string(number) + ": " + what);
    };
    line = trimmed(line);
    if (line.empty() || line.front() == '#' || (number == 1 && line == kHeader)) continue;
    const auto entries = fields(line, ',');
    if (entries.size() != 7)
      complain("a row has 7 numbers (" + std::string(kHeader) + "), found " +
               std::to_string(entries.size()));
    std::array<double, 7> v{};
    for (std::size_t i = 0; i < v.size(); ++i) {
      const auto value = parseDouble(entries[i]);
      if (!value || !std::isfinite(*value)) complain("\"" + entries[i] + "\" is not a number");
      v[i] = *value;
    }
    if (!rows.empty() && v[0] <= rows.back().stamp_s)
      complain("the stamp does not grow; sort the file by its first column");
    StampedCovariance row;
    row.stamp_s = v[0];
    row.covariance << v[1], v[2], v[3], v[2], v[4], v[5], v[3], v[5], v[6];
    rows.push_back(row);
  }
  return rows;
}

}  // namespace colonnade
