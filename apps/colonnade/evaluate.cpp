// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "colonnade/base/trajectory.hpp"
#include "colonnade/evaluation/score_json.hpp"
#include "colonnade/evaluation/trajectory_score.hpp"
#include "verbs.hpp"

namespace colonnade {
namespace {

struct Arguments {
  std::string trajectory;
  std::string ground_truth;
  std::string covariance;
  std::string alignment = "se2";
  bool json = false;
};

ExitCode evaluate(const Arguments& arguments) {
  EvaluationOptions options;
  options.alignment = alignmentOfName(arguments.alignment);
  const auto estimate = readTum(arguments.trajectory);
  const auto truth = readTum(arguments.ground_truth);
  std::vector<StampedCovariance> covariances;
  if (!arguments.covariance.empty()) covariances = readCovarianceCsv(arguments.covariance);
  const auto score = evaluateTrajectory(estimate, truth, options, covariances);
  if (arguments.json) {
    std::printf("%s\n", toJson(score).dump(2).c_str());
  } else {
    std::printf("%s against %s\n%s", arguments.trajectory.c_str(), arguments.ground_truth.c_str(),
                toText(score).c_str());
    if (!arguments.covariance.empty() && !score.nees_mean)
      std::printf("  NEES / 3: no covariance of %s fits a matched pose\n",
                  arguments.covariance.c_str());
  }
  return ExitCode::kDone;
}

}  // namespace

Action addEvaluate(CLI::App& verb) {
  const auto arguments = std::make_shared<Arguments>();
  verb.footer(
      "Examples:\n"
      "  colonnade evaluate corridor_results/trajectory.tum --ground-truth "
      "corridor_ground_truth.tum\n"
      "  colonnade evaluate trajectory.tum --ground-truth truth.tum --align se3 --json\n"
      "  colonnade evaluate trajectory.tum --ground-truth truth.tum \\\n"
      "      --covariance trajectory_covariance.csv");
  verb.add_option("trajectory", arguments->trajectory, "estimated trajectory, TUM format")
      ->required();
  verb.add_option("--ground-truth", arguments->ground_truth, "true trajectory, TUM format")
      ->required();
  verb.add_option("--align", arguments->alignment,
                  "rigid fit before the absolute errors: none, se2 (x, y, yaw) or se3")
      ->check(CLI::IsMember({"none", "se2", "se3"}))
      ->capture_default_str();
  verb.add_option("--covariance", arguments->covariance,
                  "trajectory_covariance.csv of the run, to score its consistency (NEES)");
  verb.add_flag("--json", arguments->json, "print one JSON object instead of a table");
  return [arguments] { return evaluate(*arguments); };
}

}  // namespace colonnade
