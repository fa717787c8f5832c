// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "colonnade/base/text.hpp"
#include "colonnade/base/trajectory.hpp"
#include "colonnade/campaign/run_record.hpp"
#include "colonnade/evaluation/trajectory_score.hpp"

namespace colonnade {
namespace {

void addNumbers(const nlohmann::json& json, const std::string& prefix,
                std::map<std::string, double>& numbers) {
  for (const auto& [key, value] : json.items()) {
    const std::string name = prefix.empty() ? key : prefix + "." + key;
    if (value.is_object()) addNumbers(value, name, numbers);
    if (value.is_boolean()) numbers[name] = value.get<bool>() ? 1.0 : 0.0;
    if (value.is_number() && std::isfinite(value.get<double>())) numbers[name] = value;
  }
}

}  // namespace

void addMetrics(const nlohmann::json& evaluation, const nlohmann::json& summary,
                RunRecord& record) {
  // An evaluation of a whole folder keeps the trajectory's numbers in an object of that name.
  nlohmann::json numbers = evaluation;
  if (const auto trajectory = numbers.find("trajectory");
      trajectory != numbers.end() && trajectory->is_object()) {
    const nlohmann::json inner = *trajectory;
    numbers.erase("trajectory");
    numbers.update(inner);
  }
  addNumbers(numbers, "", record.metrics);
  if (const auto map = summary.find("landmarks"); map != summary.end() && map->is_object())
    addNumbers(*map, "map", record.metrics);
  for (const char* key : {"axes", "loop_closings", "frames_processed"})
    if (const auto value = summary.find(key); value != summary.end() && value->is_number())
      record.metrics[key] = *value;
  if (const auto nis = summary.find("nis"); nis != summary.end() && nis->is_object()) {
    for (const auto& [kind, value] : nis->items()) {
      if (!value.contains("mean") || !value.contains("dof") || !value["mean"].is_number()) continue;
      record.nis[kind] = {value["mean"], value["dof"]};
      record.metrics["nis." + kind] = value["mean"];
    }
  }
  const nlohmann::json times = summary.value("/timing_ms/frame"_json_pointer, nlohmann::json());
  for (const char* key : {"median", "p95"})
    if (times.contains(key)) record.timing[std::string("frame_ms_") + key] = times[key];
  if (summary.contains("peak_rss_mb")) record.timing["peak_rss_mb"] = summary["peak_rss_mb"];
}

std::array<std::optional<double>, kInstants> neesAtTenths(const std::filesystem::path& results,
                                                          const std::filesystem::path& truth) {
  std::array<std::optional<double>, kInstants> nees{};
  const Trajectory estimate = readTum(results / "trajectory.tum");
  const Trajectory reference = readTum(truth);
  const auto covariances = readCovarianceCsv(results / "trajectory_covariance.csv");
  if (estimate.empty() || covariances.empty()) return nees;
  const double begin = estimate.front().stamp_s;
  const double duration = estimate.back().stamp_s - begin;
  for (std::size_t i = 0; i < kInstants; ++i) {
    const double instant =
        begin + duration * static_cast<double>(i + 1) / static_cast<double>(kInstants);
    const auto nearest =
        std::min_element(covariances.begin(), covariances.end(), [&](const auto& a, const auto& b) {
          return std::abs(a.stamp_s - instant) < std::abs(b.stamp_s - instant);
        });
    if (nearest == covariances.begin()) continue;
    // The first says how sure the estimate was where the worlds are laid on each other; its own
    // error is zero there, so that the sum is that of the pose at the instant.
    const auto score = evaluateTrajectory(estimate, reference, {}, {covariances.front(), *nearest});
    if (score.nees_mean) nees[i] = *score.nees_mean * static_cast<double>(score.nees_poses);
  }
  return nees;
}

std::string failureOf(const RunRecord& record, const FailureRule& rule) {
  const auto metric = [&](const char* key) -> std::optional<double> {
    const auto found = record.metrics.find(key);
    return found == record.metrics.end() ? std::nullopt : std::optional(found->second);
  };
  const auto ate = metric("ate_rmse_m");
  const auto coverage = metric("coverage");
  if (!ate || !coverage) return "no score";
  if (*ate > rule.max_ate_m)
    return "ATE " + formatFixed(*ate, 2) + " m, above " + formatDouble(rule.max_ate_m) + " m";
  if (*coverage < rule.min_coverage)
    return "coverage " + formatFixed(*coverage, 2) + ", below " + formatDouble(rule.min_coverage);
  return "";
}

}  // namespace colonnade
