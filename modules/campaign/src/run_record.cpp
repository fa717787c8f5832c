// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/campaign/run_record.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/error.hpp"
#include "shell_text.hpp"

namespace colonnade {
namespace {

using Json = nlohmann::ordered_json;

std::filesystem::path recordOf(const PlannedRun& run) { return run.folder / "run.json"; }

std::string commandLine(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "colonnade");
  return shellLine(arguments);
}

}  // namespace

void writeRunRecord(const PlannedRun& run, const PlannedDrive& drive, const RunRecord& record) {
  Json json;
  json["world"] = run.world;
  json["seed"] = run.seed;
  json["configuration"] = run.configuration;
  json["failure"] = record.failure;
  json["exit_code"] = record.exit_code;
  json["commands"] = {commandLine(drive.simulate_arguments), commandLine(run.run_arguments),
                      commandLine(run.evaluate_arguments)};
  json["stamp"] = record.stamp;
  json["metrics"] = record.metrics;
  json["nis"] = Json::object();
  for (const auto& [kind, nis] : record.nis)
    json["nis"][kind] = {{"mean", nis.mean}, {"dof", nis.dof}};
  json["nees_at_tenths"] = Json::array();
  for (const auto& nees : record.nees)
    json["nees_at_tenths"].push_back(nees ? Json(*nees) : Json(nullptr));
  json["timing"] = record.timing;
  std::filesystem::create_directories(run.folder);
  writeFileAtomically(recordOf(run),
                      json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::optional<RunRecord> readRunRecord(const PlannedRun& run) {
  const auto path = recordOf(run);
  std::ifstream file(path);
  if (!file) return std::nullopt;
  try {
    const Json json = Json::parse(file);
    RunRecord record;
    record.stamp = json.at("stamp");
    record.failure = json.at("failure");
    record.exit_code = json.at("exit_code");
    record.metrics = json.at("metrics");
    record.timing = json.at("timing");
    for (const auto& [kind, nis] : json.at("nis").items())
      record.nis[kind] = {nis.at("mean"), nis.at("dof")};
    for (std::size_t i = 0; i < kInstants; ++i) {
      const auto& nees = json.at("nees_at_tenths").at(i);
      if (!nees.is_null()) record.nees[i] = nees.get<double>();
    }
    return record;
  } catch (const nlohmann::json::exception& error) {
    throw Error(path.string() + ": is no record of a run (" + error.what() +
                "); remove it and the run is done again");
  }
}

std::string stampDifference(const std::string& former, const std::string& now) {
  std::istringstream old_lines(former);
  std::istringstream new_lines(now);
  for (std::string before, after;;) {
    const bool had = static_cast<bool>(std::getline(old_lines, before));
    const bool has = static_cast<bool>(std::getline(new_lines, after));
    if (!had && !has) return "";
    if (!had) return after + ", formerly not";
    if (!has) return before + " formerly, now not";
    if (before == after) continue;
    const auto value = after.find(": ");
    return before + ", now " + (value == std::string::npos ? after : after.substr(value + 2));
  }
}

}  // namespace colonnade
