// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>
#include <set>

#include "colonnade/base/text.hpp"
#include "colonnade/campaign/table.hpp"

namespace colonnade {
namespace {

using Json = nlohmann::ordered_json;

/// A field of a CSV file (RFC 4180).
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

Json toJson(const std::map<std::string, Spread>& spreads) {
  Json json = Json::object();
  for (const auto& [name, spread] : spreads) {
    json[name] = {{"median", spread.median},
                  {"minimum", spread.minimum},
                  {"maximum", spread.maximum},
                  {"runs", spread.count}};
  }
  return json;
}

Json toJson(const Consistency& consistency, const char* counted) {
  return {{"mean", consistency.mean},
          {counted, consistency.count},
          {"band_95", {consistency.band.low, consistency.band.high}}};
}

Json toJson(const TableRow& row) {
  Json json;
  json["world"] = row.world;
  json["configuration"] = row.configuration;
  json["planned"] = row.planned;
  json["done"] = row.done;
  json["failed"] = row.failures.size();
  json["failures"] = row.failures;
  json["metrics"] = toJson(row.metrics);
  json["nees_at_tenths"] = Json::array();
  for (const auto& nees : row.nees)
    json["nees_at_tenths"].push_back(nees ? toJson(*nees, "runs") : Json(nullptr));
  json["nis"] = Json::object();
  for (const auto& [kind, nis] : row.nis) json["nis"][kind] = toJson(nis, "dof");
  json["timing"] = toJson(row.timing);
  return json;
}

template <class Numbers>
std::string cell(const Numbers& numbers, const std::string& name) {
  const auto found = numbers.find(name);
  return found == numbers.end() ? "" : formatDouble(found->second);
}

}  // namespace

Json toJson(const CampaignTable& table, const CampaignPlan& plan) {
  Json json;
  json["drives"] = plan.drives.size();
  json["runs"] = plan.runs();
  json["complete"] = table.complete();
  json["failures"] = table.failures();
  json["failure_rule"] = {{"max_ate_m", plan.campaign.failure.max_ate_m},
                          {"min_coverage", plan.campaign.failure.min_coverage}};
  json["rows"] = Json::array();
  for (const TableRow& row : table.rows) json["rows"].push_back(toJson(row));
  return json;
}

std::string toCsv(const CampaignTable& table) {
  std::set<std::string> metrics;
  std::set<std::string> timing;
  for (const auto& [run, record] : table.runs) {
    if (!record) continue;
    for (const auto& [name, value] : record->metrics) metrics.insert(name);
    for (const auto& [name, value] : record->timing) timing.insert(name);
  }
  std::string text = "run,world,seed,configuration,state,failure,exit_code";
  for (const std::string& name : metrics) text += "," + name;
  for (std::size_t i = 1; i <= kInstants; ++i) text += ",nees_at_" + std::to_string(10 * i);
  for (const std::string& name : timing) text += "," + name;
  text += "\n";
  for (const auto& [run, record] : table.runs) {
    text += std::to_string(run->index) + "," + run->world + "," + std::to_string(run->seed) + "," +
            run->configuration + ",";
    text += !record ? "open,," : record->failed() ? "failed," : "done,";
    if (record) text += quoted(record->failure) + "," + std::to_string(record->exit_code);
    for (const std::string& name : metrics)
      text += "," + (record ? cell(record->metrics, name) : std::string());
    for (std::size_t i = 0; i < kInstants; ++i)
      text += "," + (record && record->nees[i] ? formatDouble(*record->nees[i]) : std::string());
    for (const std::string& name : timing)
      text += "," + (record ? cell(record->timing, name) : std::string());
    text += "\n";
  }
  return text;
}

}  // namespace colonnade
