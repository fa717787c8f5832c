// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <set>

#include "colonnade/base/text.hpp"
#include "colonnade/campaign/table.hpp"

namespace colonnade {
namespace {

struct Column {
  const char* title;
  const char* metric;
  int decimals;
};
constexpr Column kAccuracy[] = {{"ATE, m", "ate_rmse_m", 3},
                                {"RPE 1 m, %", "rpe_1m_percent", 2},
                                {"heading, deg", "heading_rmse_deg", 2},
                                {"NEES/3 of the run", "nees_mean", 2},
                                {"coverage", "coverage", 2}};
constexpr Column kTime[] = {{"ms a frame, median", "frame_ms_median", 1},
                            {"ms a frame, 95 %", "frame_ms_p95", 1},
                            {"run, s", "wall_s", 1},
                            {"peak MiB", "peak_rss_mb", 0}};

/// "median (minimum to maximum)".
std::string cell(const std::map<std::string, Spread>& spreads, const Column& column) {
  const auto found = spreads.find(column.metric);
  if (found == spreads.end()) return "-";
  const Spread& spread = found->second;
  return formatFixed(spread.median, column.decimals) + " (" +
         formatFixed(spread.minimum, column.decimals) + " to " +
         formatFixed(spread.maximum, column.decimals) + ")";
}

std::string line(const std::vector<std::string>& cells) {
  return "| " + joined(cells, " | ") + " |\n";
}

std::string header(const std::vector<std::string>& titles) {
  std::string rule = "|";
  for (std::size_t i = 0; i < titles.size(); ++i) rule += "---|";
  return line(titles) + rule + "\n";
}

template <class Cells>
std::string tableOf(const CampaignTable& table, std::vector<std::string> titles, Cells&& cells) {
  titles.insert(titles.begin(), {"world", "configuration"});
  std::string text = header(titles);
  for (const TableRow& row : table.rows) {
    std::vector<std::string> words{row.world, row.configuration};
    for (std::string& cell : cells(row)) words.push_back(std::move(cell));
    text += line(words);
  }
  return text + "\n";
}

std::string spreadTable(const CampaignTable& table, const std::vector<Column>& columns,
                        std::map<std::string, Spread> TableRow::*spreads) {
  std::vector<std::string> titles;
  for (const Column& column : columns) titles.push_back(column.title);
  return tableOf(table, titles, [&](const TableRow& row) {
    std::vector<std::string> cells;
    for (const Column& column : columns) cells.push_back(cell(row.*spreads, column));
    return cells;
  });
}

std::string accuracyTable(const CampaignTable& table) {
  std::vector<std::string> titles{"runs", "failed"};
  for (const Column& column : kAccuracy) titles.push_back(column.title);
  return tableOf(table, titles, [](const TableRow& row) {
    const bool all = row.done == row.planned;
    std::vector<std::string> cells{
        std::to_string(row.done) + (all ? "" : " of " + std::to_string(row.planned)),
        std::to_string(row.failures.size())};
    for (const Column& column : kAccuracy) cells.push_back(cell(row.metrics, column));
    return cells;
  });
}

/// Precision and recall of whatever the evaluation scores besides the trajectory.
std::string mapTable(const CampaignTable& table) {
  std::set<std::string> names;
  for (const TableRow& row : table.rows)
    for (const auto& [name, spread] : row.metrics)
      if (name.ends_with("precision") || name.ends_with("recall")) names.insert(name);
  std::vector<Column> columns;
  for (const std::string& name : names) columns.push_back({name.c_str(), name.c_str(), 2});
  return names.empty() ? "" : "## Map\n\n" + spreadTable(table, columns, &TableRow::metrics);
}

std::string cell(const Consistency& consistency, int decimals) {
  const std::string verdict = consistency.verdict();
  return formatFixed(consistency.mean, decimals) + (verdict.empty() ? "" : " " + verdict);
}

std::string band(const Consistency& consistency, int decimals) {
  return formatFixed(consistency.band.low, decimals) + " to " +
         formatFixed(consistency.band.high, decimals);
}

std::string neesTable(const CampaignTable& table) {
  std::vector<std::string> titles;
  for (std::size_t i = 1; i <= kInstants; ++i) titles.push_back(std::to_string(10 * i) + " %");
  titles.push_back("95 % band");
  return tableOf(table, titles, [](const TableRow& row) {
    std::vector<std::string> cells;
    for (const auto& nees : row.nees) cells.push_back(nees ? cell(*nees, 2) : "-");
    // At the end; where runs lack an instant its band is wider, see campaign.json.
    cells.push_back(row.nees.back() ? band(*row.nees.back(), 2) : "-");
    return cells;
  });
}

std::string nisTable(const CampaignTable& table) {
  std::set<std::string> kinds;
  for (const TableRow& row : table.rows)
    for (const auto& [kind, nis] : row.nis) kinds.insert(kind);
  if (kinds.empty()) return "";
  return "## Consistency of the measurements: NIS per degree of freedom\n\n" +
         tableOf(table, {kinds.begin(), kinds.end()},
                 [&](const TableRow& row) {
                   std::vector<std::string> cells;
                   for (const std::string& kind : kinds) {
                     const auto nis = row.nis.find(kind);
                     cells.push_back(nis == row.nis.end() ? "-"
                                                          : cell(nis->second, 3) + " (" +
                                                                band(nis->second, 3) + ")");
                   }
                   return cells;
                 }) +
         "Over all accepted measurements of all runs, with the 95 % band for independent ones.\n\n";
}

std::string failureList(const CampaignTable& table) {
  std::string text;
  for (const TableRow& row : table.rows)
    for (const std::string& failure : row.failures)
      text += "- " + row.world + ", " + row.configuration + ", " + failure + "\n";
  return text.empty() ? "" : "## Failed runs\n\n" + text + "\n";
}

}  // namespace

std::string toMarkdown(const CampaignTable& table, const CampaignPlan& plan) {
  const FailureRule& rule = plan.campaign.failure;
  std::string text =
      "# Campaign\n\n" + std::to_string(plan.campaign.worlds.size()) + " world(s), " +
      std::to_string(plan.campaign.seeds.size()) + " seed(s), " +
      std::to_string(plan.campaign.configurations.size()) +
      " configuration(s). Numbers are median (minimum to maximum) over the seeds.\n\n";
  if (!table.complete())
    text += "**Not complete:** " +
            std::to_string(std::count_if(table.runs.begin(), table.runs.end(),
                                         [](const auto& run) { return !run.second; })) +
            " of " + std::to_string(plan.runs()) + " runs are missing" +
            (table.outdated > 0 ? ", " + std::to_string(table.outdated) +
                                      " of them were made with another program, world or options"
                                : "") +
            ".\n\n";
  text += "## Accuracy\n\n" + accuracyTable(table);
  text +=
      "A run failed when simulate, run or evaluate did not exit with 0, when it has no score, "
      "when its ATE is above " +
      formatDouble(rule.max_ate_m) + " m, or when it covers less than " +
      formatDouble(rule.min_coverage) +
      " of the truth's time. Numbers are over all runs that have them, failed or not. ATE and "
      "heading are se2-aligned, without scale.\n\n";
  text += mapTable(table);
  text += "## Consistency of the pose: mean NEES / 3 over the runs, at tenths of the run\n\n" +
          neesTable(table) +
          "1 for an honest filter; the chi-square band is for runs that are independent, with 3 "
          "degrees of freedom each. \"high\": too sure of itself, \"low\": too cautious.\n\n";
  text += nisTable(table);
  text +=
      "## Time\n\n" + spreadTable(table, {std::begin(kTime), std::end(kTime)}, &TableRow::timing);
  text += failureList(table);
  return text;
}

}  // namespace colonnade
