// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <utility>
#include <vector>

namespace colonnade {

/// A line of rgb.txt or depth.txt.
struct TumEntry {
  double stamp_s = 0.0;
  std::filesystem::path file;  ///< below the folder
};

/// Reads `stamp file` lines, sorted by stamp. Throws Error naming file and line.
std::vector<TumEntry> readTumList(const std::filesystem::path& path);

/// Pairs (index in a, index in b) whose stamps differ by at most `tolerance_s`, closest first as in
/// the benchmark's associate.py; each entry is used once. In the order of a.
std::vector<std::pair<std::size_t, std::size_t>> associate(const std::vector<TumEntry>& a,
                                                           const std::vector<TumEntry>& b,
                                                           double tolerance_s);

}  // namespace colonnade
