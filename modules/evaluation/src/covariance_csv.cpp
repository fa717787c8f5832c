// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/covariance_csv.hpp"

#include <string>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/csv_table.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

constexpr const char* kHeader = "stamp,xx,xy,xphi,yy,yphi,phiphi";
constexpr const char* kOrigin = "origin_x,origin_y,origin_phi";

}  // namespace

void writeCovarianceCsv(const std::filesystem::path& path,
                        const std::vector<StampedCovariance>& covariances) {
  std::string text = std::string(kHeader) + "," + kOrigin + "\n";
  for (const auto& row : covariances) {
    const auto& P = row.covariance;
    const Pose2& T = row.T_world_origin;
    text += formatFixed(row.stamp_s, 6);
    for (const double value :
         {P(0, 0), P(0, 1), P(0, 2), P(1, 1), P(1, 2), P(2, 2), T.x, T.y, T.phi})
      text += "," + formatDouble(value, 12);
    text += "\n";
  }
  writeFileAtomically(path, text);
}

std::vector<StampedCovariance> readCovarianceCsv(const std::filesystem::path& path) {
  CsvTable table(path, fields(kHeader, ','), "covariances of a trajectory");
  std::vector<StampedCovariance> rows;
  while (const auto entry = table.next()) {
    StampedCovariance row;
    row.stamp_s = entry->number("stamp");
    if (!rows.empty() && row.stamp_s <= rows.back().stamp_s)
      entry->complain("stamp", "above the one before; sort the file by it");
    const double xx = entry->number("xx"), xy = entry->number("xy"), xphi = entry->number("xphi");
    const double yy = entry->number("yy"), yphi = entry->number("yphi");
    const double phiphi = entry->number("phiphi");
    row.covariance << xx, xy, xphi, xy, yy, yphi, xphi, yphi, phiphi;
    const bool x = entry->has("origin_x"), y = entry->has("origin_y");
    const bool phi = entry->has("origin_phi");
    if (x != y || y != phi)
      throw Error(entry->where() + ": columns " + kOrigin + " belong together");
    if (x)
      row.T_world_origin = {entry->number("origin_x"), entry->number("origin_y"),
                            entry->number("origin_phi")};
    rows.push_back(row);
  }
  return rows;
}

}  // namespace colonnade
