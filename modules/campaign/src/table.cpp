// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/campaign/table.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "colonnade/base/atomic_file.hpp"

namespace colonnade {
namespace {

constexpr std::size_t kPoseDof = 3;  // x, y, heading

std::map<std::string, Spread> spreads(const std::map<std::string, std::vector<double>>& values) {
  std::map<std::string, Spread> result;
  for (const auto& [name, list] : values)
    if (const auto spread = spreadOf(list)) result[name] = *spread;
  return result;
}

/// Gathers the runs of one row.
class RowBuilder {
 public:
  void add(const PlannedRun& run, const std::optional<RunRecord>& record) {
    row_.world = run.world;
    row_.configuration = run.configuration;
    ++row_.planned;
    if (!record) return;
    ++row_.done;
    if (record->failed())
      row_.failures.push_back("seed " + std::to_string(run.seed) + ": " + record->failure);
    for (const auto& [name, value] : record->metrics) metrics_[name].push_back(value);
    for (const auto& [name, value] : record->timing) timing_[name].push_back(value);
    for (const auto& [kind, nis] : record->nis) {
      row_.nis[kind].count += nis.dof;
      row_.nis[kind].mean += nis.mean * static_cast<double>(nis.dof);
    }
    for (std::size_t i = 0; i < kInstants; ++i)
      if (record->nees[i]) nees_[i].push_back(*record->nees[i]);
  }

  TableRow finish() {
    row_.metrics = spreads(metrics_);
    row_.timing = spreads(timing_);
    for (auto& [kind, nis] : row_.nis) {
      if (nis.count == 0) continue;
      nis.mean /= static_cast<double>(nis.count);
      nis.band = consistencyBand(nis.count, 1);
    }
    std::erase_if(row_.nis, [](const auto& entry) { return entry.second.count == 0; });
    for (std::size_t i = 0; i < kInstants; ++i) {
      if (nees_[i].empty()) continue;
      double sum = 0.0;
      for (const double value : nees_[i]) sum += value;
      const std::size_t runs = nees_[i].size();
      row_.nees[i] =
          Consistency{runs, sum / static_cast<double>(runs), consistencyBand(runs, kPoseDof)};
    }
    return std::move(row_);
  }

 private:
  TableRow row_;
  std::map<std::string, std::vector<double>> metrics_;
  std::map<std::string, std::vector<double>> timing_;
  std::array<std::vector<double>, kInstants> nees_;
};

}  // namespace

std::optional<Spread> spreadOf(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  const double median =
      values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
  return Spread{values.size(), median, values.front(), values.back()};
}

const char* Consistency::verdict() const {
  return mean > band.high ? "high" : mean < band.low ? "low" : "";
}

bool CampaignTable::complete() const {
  return std::all_of(rows.begin(), rows.end(),
                     [](const TableRow& row) { return row.done == row.planned; });
}

std::size_t CampaignTable::failures() const {
  std::size_t count = 0;
  for (const TableRow& row : rows) count += row.failures.size();
  return count;
}

CampaignTable tabulate(const CampaignPlan& plan) {
  CampaignTable table;
  const std::size_t configurations = plan.campaign.configurations.size();
  const std::size_t seeds = plan.campaign.seeds.size();
  std::vector<RowBuilder> rows(plan.campaign.worlds.size() * configurations);
  for (const PlannedDrive& drive : plan.drives) {
    for (std::size_t c = 0; c < drive.runs.size(); ++c) {
      const PlannedRun& run = drive.runs[c];
      auto record = readRunRecord(run);
      if (record && record->stamp != run.stamp) {
        ++table.outdated;
        record.reset();
      }
      rows[drive.index / seeds * configurations + c].add(run, record);
      table.runs.emplace_back(&run, std::move(record));
    }
  }
  for (RowBuilder& row : rows) table.rows.push_back(row.finish());
  return table;
}

void writeTable(const CampaignTable& table, const CampaignPlan& plan) {
  using Json = nlohmann::ordered_json;
  writeFileAtomically(plan.folder / "campaign.md", toMarkdown(table, plan));
  writeFileAtomically(plan.folder / "campaign.csv", toCsv(table));
  writeFileAtomically(
      plan.folder / "campaign.json",
      toJson(table, plan).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace colonnade
