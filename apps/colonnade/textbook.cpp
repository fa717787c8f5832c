// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/text.hpp"
#include "line_plot.hpp"
#include "results_folder.hpp"
#include "textbook_drive.hpp"
#include "verbs.hpp"

namespace colonnade {
namespace {

namespace fs = std::filesystem;
const cv::Scalar kBlue(200, 90, 30), kRed(40, 40, 210), kGreen(60, 160, 60), kBlack(30, 30, 30),
    kGray(160, 160, 160);

struct TextbookArguments {
  fs::path output;
  int rounds = 2;
  std::uint64_t seed = 1;
  int runs = 30;
};

/// Root mean squares of the position error over the runs, one a step.
struct ErrorCurves {
  std::vector<double> dead_reckoning, plain, invariant;
  double nees_plain = 0.0, nees_invariant = 0.0;
};

double apart(const Pose2& a, const Pose2& b) { return (a.translation() - b.translation()).norm(); }

ErrorCurves errorsOver(const TextbookWorld& world, const TextbookArguments& arguments) {
  ErrorCurves curves;
  for (int run = 0; run < arguments.runs; ++run) {
    const auto d = drive(world, arguments.rounds, arguments.seed + static_cast<std::uint64_t>(run));
    for (auto* curve : {&curves.dead_reckoning, &curves.plain, &curves.invariant})
      curve->resize(d.truth.size());
    for (std::size_t i = 0; i < d.truth.size(); ++i) {
      curves.dead_reckoning[i] += std::pow(apart(d.dead_reckoning[i], d.truth[i]), 2);
      curves.plain[i] += std::pow(apart(d.plain[i], d.truth[i]), 2);
      curves.invariant[i] += std::pow(apart(d.invariant[i], d.truth[i]), 2);
    }
    curves.nees_plain += d.nees_plain / arguments.runs;
    curves.nees_invariant += d.nees_invariant / arguments.runs;
  }
  for (auto* curve : {&curves.dead_reckoning, &curves.plain, &curves.invariant})
    for (double& value : *curve) value = std::sqrt(value / arguments.runs);
  return curves;
}

std::vector<cv::Point2d> curve(const std::vector<double>& values, const TextbookWorld& world,
                               std::size_t count) {
  std::vector<cv::Point2d> points;
  for (std::size_t i = 0; i < std::min(count, values.size()); ++i)
    points.emplace_back(world.step_m * static_cast<double>(i), values[i]);
  return points;
}

std::vector<cv::Point2d> path(const std::vector<Pose2>& poses, std::size_t count) {
  std::vector<cv::Point2d> points;
  for (std::size_t i = 0; i < std::min(count, poses.size()); ++i)
    points.emplace_back(poses[i].x, poses[i].y);
  return points;
}

std::vector<double> distances(const std::vector<Pose2>& a, const std::vector<Pose2>& b) {
  std::vector<double> result;
  for (std::size_t i = 0; i < a.size(); ++i) result.push_back(apart(a[i], b[i]));
  return result;
}

std::vector<double> roundEnds(const TextbookWorld& world, int rounds) {
  std::vector<double> ends;
  for (int r = 1; r < rounds; ++r) ends.push_back(world.step_m * world.steps_a_round * r);
  return ends;
}

/// Figures 5.16 and 5.18: objects blue, detected landmarks red, true path green, estimate black.
LinePlot mapFigure(const TextbookWorld& world, const TextbookDrive& d) {
  LinePlot figure{"EKF-SLAM and dead reckoning, one drive", "x [m]", "y [m]", true, {}, {}};
  PlotSeries objects{"objects", kBlue, {}, true}, found{"landmarks found", kRed, {}, true};
  for (const auto& p : world.landmarks()) objects.points.emplace_back(p.x(), p.y());
  for (const auto& l : d.landmarks) found.points.emplace_back(l.p_world.x(), l.p_world.y());
  figure.series = {{"dead reckoning", kGray, path(d.dead_reckoning, d.truth.size()), false},
                   {"true path", kGreen, path(d.truth, d.truth.size()), false},
                   {"EKF", kBlack, path(d.invariant, d.truth.size()), false},
                   objects,
                   found};
  return figure;
}

/// Figures 5.19 and 5.20: distance from the true path over the way, after some rounds.
LinePlot distanceFigure(const TextbookWorld& world, int rounds, std::uint64_t seed) {
  const TextbookDrive d = drive(world, rounds, seed);
  const auto along = [&](const std::vector<Pose2>& poses) {
    return curve(distances(poses, d.truth), world, d.truth.size());
  };
  return {"Distance from the true path, " + std::to_string(rounds) +
              (rounds == 1 ? " round" : " rounds"),
          "way [m]",
          "distance [m]",
          false,
          {{"dead reckoning", kGray, along(d.dead_reckoning), false},
           {"plain EKF", kRed, along(d.plain), false},
           {"invariant EKF", kBlack, along(d.invariant), false}},
          roundEnds(world, rounds)};
}

LinePlot rmseFigure(const TextbookWorld& world, const ErrorCurves& e, int rounds, int runs) {
  const auto all = [&](const std::vector<double>& values) {
    return curve(values, world, values.size());
  };
  return {"Root mean square of the position error over " + std::to_string(runs) + " drives",
          "way [m]",
          "RMSE [m]",
          false,
          {{"dead reckoning", kGray, all(e.dead_reckoning), false},
           {"plain EKF", kRed, all(e.plain), false},
           {"invariant EKF", kBlack, all(e.invariant), false}},
          roundEnds(world, rounds)};
}

/// Over the steps of one round.
double rmsOfRound(const std::vector<double>& rmse, const TextbookWorld& world, int round) {
  double sum = 0.0;
  for (int i = 1; i <= world.steps_a_round; ++i)
    sum += std::pow(rmse[static_cast<std::size_t>((round - 1) * world.steps_a_round + i)], 2);
  return std::sqrt(sum / world.steps_a_round);
}

nlohmann::ordered_json describe(const TextbookWorld& world, const TextbookArguments& arguments,
                                const ErrorCurves& e) {
  nlohmann::ordered_json json;
  json["rounds"] = arguments.rounds;
  json["runs"] = arguments.runs;
  json["seed"] = arguments.seed;
  json["landmarks"] = world.landmarks().size();
  json["sigmas"] = {{"along_m", world.along_m},
                    {"across_m", world.across_m},
                    {"heading_deg", degrees(world.heading)},
                    {"range_m", world.range_m},
                    {"bearing_deg", degrees(world.bearing)}};
  for (int round = 1; round <= arguments.rounds; ++round)
    json["rmse_m"].push_back({{"round", round},
                              {"dead_reckoning", rmsOfRound(e.dead_reckoning, world, round)},
                              {"plain_ekf", rmsOfRound(e.plain, world, round)},
                              {"invariant_ekf", rmsOfRound(e.invariant, world, round)}});
  json["nees_of_last_pose"] = {{"plain_ekf", e.nees_plain}, {"invariant_ekf", e.nees_invariant}};
  return json;
}

void writeTable(const fs::path& file, const TextbookWorld& world, const ErrorCurves& e) {
  std::string text = "step,way_m,rmse_dead_reckoning_m,rmse_plain_ekf_m,rmse_invariant_ekf_m\n";
  for (std::size_t i = 0; i < e.plain.size(); ++i)
    text += std::to_string(i) + "," + formatFixed(world.step_m * static_cast<double>(i), 3) + "," +
            formatFixed(e.dead_reckoning[i], 6) + "," + formatFixed(e.plain[i], 6) + "," +
            formatFixed(e.invariant[i], 6) + "\n";
  writeFileAtomically(file, text);
}

ExitCode textbook(const TextbookArguments& arguments) {
  const fs::path folder = makeResultsFolder(arguments.output, arguments.output);
  const TextbookWorld world;
  const ErrorCurves errors = errorsOver(world, arguments);
  writePlot(folder / "map.png", mapFigure(world, drive(world, arguments.rounds, arguments.seed)));
  for (int rounds = 1; rounds <= arguments.rounds; ++rounds)
    writePlot(folder / ("distance_round_" + std::to_string(rounds) + ".png"),
              distanceFigure(world, rounds, arguments.seed));
  writePlot(folder / "rmse.png", rmseFigure(world, errors, arguments.rounds, arguments.runs));
  writeTable(folder / "rmse.csv", world, errors);
  const auto json = describe(world, arguments, errors);
  writeFileAtomically(folder / "textbook.json", json.dump(2) + "\n");

  std::printf("RMSE over %d drives, metres\nround  dead reckoning  plain EKF  invariant EKF\n",
              arguments.runs);
  for (const auto& row : json["rmse_m"])
    std::printf("%5d  %14s  %9s  %13s\n", row["round"].get<int>(),
                formatFixed(row["dead_reckoning"], 3).c_str(),
                formatFixed(row["plain_ekf"], 3).c_str(),
                formatFixed(row["invariant_ekf"], 3).c_str());
  std::printf("NEES of the last pose over 3: plain %s, invariant %s\nresults    %s\n",
              formatFixed(errors.nees_plain, 2).c_str(),
              formatFixed(errors.nees_invariant, 2).c_str(), folder.c_str());
  return ExitCode::kDone;
}

}  // namespace

Action addTextbook(CLI::App& verb) {
  const auto arguments = std::make_shared<TextbookArguments>();
  verb.add_option("-o,--output", arguments->output, "new folder")->required();
  verb.add_option("--rounds", arguments->rounds, "of the cloister")
      ->check(CLI::Range(1, 20))
      ->capture_default_str();
  verb.add_option("--seed", arguments->seed, "of the first drive; others follow")
      ->check(notNegative())
      ->capture_default_str();
  verb.add_option("--runs", arguments->runs, "drives the RMSE is taken over")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb.footer(
      "Examples:\n"
      "  colonnade textbook -o textbook\n"
      "  colonnade textbook -o textbook3 --rounds 3 --seed 7");
  return [arguments] { return textbook(*arguments); };
}

}  // namespace colonnade
