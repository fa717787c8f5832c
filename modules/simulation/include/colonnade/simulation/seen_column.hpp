// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace colonnade {

/// What one frame shows of one landmark, person, pane of glass or mirror: a row of the columns file
/// (see the README of this module).
struct SeenColumn {
  std::string kind;  ///< pillar, floor_edge, depth_slope, person, glass or mirror
  int id = 0;
  Eigen::Vector2d from = Eigen::Vector2d::Zero();  ///< pixels
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
  double length_px = 0.0;
  double range_m = 0.0;
  double contrast = 0.0;  ///< gray levels; 0 for what is no line
};

/// Writes STEM_columns.csv frame by frame, whole or not at all: into a temporary neighbour that
/// `finish()` renames. Throws Error when the disk takes no more.
class ColumnsFile {
 public:
  explicit ColumnsFile(const std::filesystem::path& path);
  ~ColumnsFile();
  ColumnsFile(const ColumnsFile&) = delete;
  ColumnsFile& operator=(const ColumnsFile&) = delete;

  void add(double stamp_s, std::size_t frame, const std::vector<SeenColumn>& columns);
  void finish();

 private:
  void check();

  std::filesystem::path path_, temporary_;
  std::ofstream file_;
};

}  // namespace colonnade
