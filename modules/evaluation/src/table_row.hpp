// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace colonnade {

inline nlohmann::ordered_json orNull(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

/// A line of a table: two blanks, the label, the value from column 26 on.
inline std::string tableRow(const std::string& label, const std::string& value) {
  std::string padded = "  " + label;
  padded.resize(std::max<std::size_t>(padded.size() + 2, 26), ' ');
  return padded + value + "\n";
}

}  // namespace colonnade
