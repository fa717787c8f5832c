// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "colonnade/base/text.hpp"
#include "colonnade/base/trajectory.hpp"
#include "colonnade/evaluation/map_json.hpp"
#include "colonnade/evaluation/score_json.hpp"
#include "colonnade/evaluation/trajectory_score.hpp"
#include "colonnade/maps/landmark_csv.hpp"
#include "evaluation_files.hpp"
#include "verbs.hpp"

namespace colonnade {
namespace {

struct Arguments {
  EvaluationFiles files;
  std::string alignment = "se2";
  LandmarkScoreOptions landmarks;
  double gate_deg = degrees(LandmarkScoreOptions().gate);
  bool json = false;
};

/// Everything the files can tell.
struct Evaluation {
  TrajectoryScore trajectory;
  std::optional<TrajectoryScore> final_trajectory;  ///< where it is not the same
  std::optional<LandmarkScore> landmarks;
  std::optional<FloorScore> floor;
};

bool same(const Trajectory& a, const Trajectory& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& p, const auto& q) {
    return p.stamp_s == q.stamp_s && p.T_world_body.matrix() == q.T_world_body.matrix();
  });
}

/// What cannot be scored goes to files.not_scored with the reason.
Evaluation evaluateAll(EvaluationFiles& files, const Arguments& arguments) {
  EvaluationOptions options;
  options.alignment = alignmentOfName(arguments.alignment);
  LandmarkScoreOptions landmark_options = arguments.landmarks;
  landmark_options.gate = radians(arguments.gate_deg);
  const auto estimate = readTum(files.trajectory);
  const auto truth = readTum(files.ground_truth);
  std::vector<StampedCovariance> covariances;
  if (!files.covariance.empty()) covariances = readCovarianceCsv(files.covariance);

  Evaluation result;
  result.trajectory = evaluateTrajectory(estimate, truth, options, covariances);
  const auto final =
      files.final_trajectory.empty() ? Trajectory{} : readTum(files.final_trajectory);
  if (!final.empty() && !same(estimate, final))
    result.final_trajectory = evaluateTrajectory(final, truth, options);
  // The map goes with the trajectory after the last correction.
  const Pose2 T_truth_estimate =
      planarPart(result.final_trajectory.value_or(result.trajectory).T_truth_estimate);
  // A map that cannot be compared must not cost the score of the trajectory.
  const auto unlessRefused = [&](const char* what, const auto& score) {
    try {
      score();
    } catch (const Error& refusal) {
      files.not_scored.push_back(std::string(what) + " (" + refusal.what() + ")");
    }
  };
  if (!files.landmarks.empty()) {
    const auto estimated = readLandmarksCsv(files.landmarks);
    const auto true_ones = readLandmarksCsv(files.truth_landmarks);
    unlessRefused("landmarks", [&] {
      result.landmarks = scoreLandmarks(estimated, true_ones, T_truth_estimate, landmark_options,
                                        anchorOfMap(result.trajectory, final, covariances));
    });
  }
  if (!files.floor.empty()) {
    const auto estimated = readFloorMap(files.floor);
    const auto true_floor = readFloorMap(files.truth_floor);
    unlessRefused("free floor",
                  [&] { result.floor = scoreFloor(estimated, true_floor, T_truth_estimate); });
  }
  return result;
}

void printJson(const Evaluation& evaluation, const EvaluationFiles& files) {
  auto json = toJson(evaluation.trajectory);
  if (evaluation.final_trajectory) json["trajectory_final"] = toJson(*evaluation.final_trajectory);
  if (evaluation.landmarks) {
    json["landmarks"] = toJson(*evaluation.landmarks);
    json["walls"] = toJson(evaluation.landmarks->walls);
  }
  if (evaluation.floor) json["free_area"] = toJson(*evaluation.floor);
  json["not_scored"] = files.not_scored;
  std::printf("%s\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}

void printTable(const Evaluation& evaluation, const EvaluationFiles& files) {
  std::printf("%s against %s\n%s", files.trajectory.c_str(), files.ground_truth.c_str(),
              toText(evaluation.trajectory).c_str());
  if (evaluation.final_trajectory)
    std::printf("%s against %s; the map is laid as this is\n%s", files.final_trajectory.c_str(),
                files.ground_truth.c_str(), toText(*evaluation.final_trajectory).c_str());
  if (evaluation.landmarks)
    std::printf("%s against %s\n%s", files.landmarks.c_str(), files.truth_landmarks.c_str(),
                toText(*evaluation.landmarks).c_str());
  if (evaluation.floor)
    std::printf("%s against %s\n%s", files.floor.c_str(), files.truth_floor.c_str(),
                toText(*evaluation.floor).c_str());
}

ExitCode evaluate(const Arguments& arguments) {
  EvaluationFiles files = complete(arguments.files);
  const Evaluation evaluation = evaluateAll(files, arguments);
  if (arguments.json)
    printJson(evaluation, files);
  else
    printTable(evaluation, files);
  constexpr double kMostOfIt = 0.9;
  if (const double share = evaluation.trajectory.span.estimate_in_truth; share < kMostOfIt)
    std::fprintf(stderr, "%s: covers only %s %% of the estimate's time; is it of the same log?\n",
                 files.ground_truth.c_str(), formatFixed(100.0 * share, 0).c_str());
  if (!files.not_scored.empty())
    std::fprintf(stderr, "not scored: %s\n", joined(files.not_scored, ", ").c_str());
  return ExitCode::kDone;
}

}  // namespace

Action addEvaluate(CLI::App& verb) {
  const auto arguments = std::make_shared<Arguments>();
  auto& files = arguments->files;
  verb.footer(
      "Examples:\n"
      "  colonnade evaluate corridor_results --ground-truth corridor.rawlog\n"
      "  colonnade evaluate trajectory.tum --ground-truth truth.tum --align se3 --json\n"
      "  colonnade evaluate trajectory.tum --ground-truth truth.tum \\\n"
      "      --covariance trajectory_covariance.csv\n"
      "  colonnade evaluate trajectory.tum --ground-truth truth.tum \\\n"
      "      --landmarks landmarks.csv --truth-landmarks true.csv --gate 0.2");
  verb.add_option("trajectory", files.trajectory,
                  "estimated trajectory, TUM format, or a results folder of run: then its "
                  "covariances, landmarks and floor are scored too")
      ->required();
  verb.add_option("--ground-truth", files.ground_truth,
                  "true trajectory, TUM format; or the log, or any truth file beside it: then all "
                  "truth beside the log is used")
      ->required();
  verb.add_option("--align", arguments->alignment,
                  "rigid fit before the absolute errors: none, se2 (x, y, yaw) or se3")
      ->check(CLI::IsMember({"none", "se2", "se3"}))
      ->capture_default_str();
  verb.add_option("--covariance", files.covariance,
                  "trajectory_covariance.csv of the run, to score its consistency (NEES)");
  verb.add_option("--landmarks", files.landmarks, "landmarks.csv of the run");
  verb.add_option("--truth-landmarks", files.truth_landmarks, "true landmarks, the same columns");
  verb.add_option("--floor", files.floor, "map.yaml of the run");
  verb.add_option("--truth-floor", files.truth_floor, "true floor, the same format");
  verb.add_option("--gate", arguments->landmarks.gate_m,
                  "metres within which a landmark is the true one")
      ->check(CLI::Range(0.001, 10.0))
      ->capture_default_str();
  verb.add_option("--gate-deg", arguments->gate_deg, "the same for directions of floor edges")
      ->check(CLI::Range(0.1, 45.0))
      ->capture_default_str();
  verb.add_option("--min-observations", arguments->landmarks.min_observations,
                  "frames that must have seen a true landmark before it counts as missed")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  verb.add_flag("--json", arguments->json, "print one JSON object instead of a table");
  return [arguments] { return evaluate(*arguments); };
}

}  // namespace colonnade
