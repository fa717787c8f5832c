// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare_result.hpp"

namespace colonnade {

/// What stands above and below the table.
struct ComparisonNotes {
  std::string log;
  LogContents contents;
  int jobs = 1;
  int random_runs = 1;
};

/// The table in Markdown, readable as it stands, with the failure rule, how each method was run and
/// what the log lacks below it. Figures of repeated runs: median [least..greatest].
std::string toMarkdown(const std::vector<MethodOutcome>& methods, const ComparisonNotes& notes);

/// The same with every figure of every run.
nlohmann::ordered_json toJson(const std::vector<MethodOutcome>& methods,
                              const ComparisonNotes& notes);

}  // namespace colonnade
