// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "colonnade/campaign/plan.hpp"
#include "colonnade/campaign/run_record.hpp"
#include "colonnade/evaluation/consistency.hpp"

namespace colonnade {

/// Of the runs that have the number, failed or not.
struct Spread {
  std::size_t count = 0;
  double median = 0.0;  ///< of an even count: the mean of the middle two
  double minimum = 0.0;
  double maximum = 0.0;
};
/// Nothing for no values.
std::optional<Spread> spreadOf(std::vector<double> values);

/// A mean that is 1 for an honest filter, with the band it lies in with 95 % probability then.
struct Consistency {
  std::size_t count = 0;  ///< NEES: runs; NIS: degrees of freedom
  double mean = 0.0;
  Band band;
  /// "" inside the band, "high" (too sure of itself) or "low" (too cautious).
  const char* verdict() const;
};

/// One row of the table: a world with a configuration over all seeds.
struct TableRow {
  std::string world;
  std::string configuration;
  std::size_t planned = 0;
  std::size_t done = 0;               ///< with a record
  std::vector<std::string> failures;  ///< "seed 4: why"
  std::map<std::string, Spread> metrics;
  std::map<std::string, Spread> timing;
  std::array<std::optional<Consistency>, kInstants> nees{};  ///< at the tenths, / 3, over runs
  std::map<std::string, Consistency> nis;                    ///< per kind
};

struct CampaignTable {
  std::vector<TableRow> rows;  ///< worlds, then configurations, in the order of the file
  std::vector<std::pair<const PlannedRun*, std::optional<RunRecord>>> runs;  ///< of the plan
  std::size_t outdated = 0;  ///< records made in another way; counted as not done
  bool complete() const;
  std::size_t failures() const;
};

/// Reads the record of every run. The plan must outlive the table.
CampaignTable tabulate(const CampaignPlan& plan);

/// For people (Markdown), for programs, and one row per run (columns of timing last, so that the
/// others can be compared between repetitions).
std::string toMarkdown(const CampaignTable& table, const CampaignPlan& plan);
nlohmann::ordered_json toJson(const CampaignTable& table, const CampaignPlan& plan);
std::string toCsv(const CampaignTable& table);

/// campaign.md, campaign.json and campaign.csv in the plan's folder.
void writeTable(const CampaignTable& table, const CampaignPlan& plan);

}  // namespace colonnade
