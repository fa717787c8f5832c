// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/maps/landmark_csv.hpp"
#include "program.hpp"

namespace colonnade::testing {
namespace {

using RangeBearingRun = ProgramTest;
using Textbook = ProgramTest;

TEST_F(RangeBearingRun, MapsARealRobotFromItsReadings) {
  COLONNADE_REQUIRE_RECORDING(data, "mrclam7");
  const Outcome import =
      colonnade("import mrclam '" + data.string() + "' --robot 2 -o robot2.rawlog");
  ASSERT_EQ(import.exit_code, 0) << import.err;
  EXPECT_NE(import.out.find("readings of moving robots"), std::string::npos) << import.out;
  const std::string run = "run robot2.rawlog --ground-truth robot2_ground_truth.tum ";
  const Outcome known = colonnade(run + "-o known");
  ASSERT_EQ(known.exit_code, 0) << known.err;
  EXPECT_LT(summary("known")["trajectory"]["ate_rmse_m"].get<double>(), 0.25);
  EXPECT_EQ(summary("known")["association"]["right_share"], 1.0);
  const LandmarkMap map = readLandmarksCsv(folder_ / "known/landmarks.csv");
  ASSERT_EQ(map.size(), 15u);
  EXPECT_EQ(number(map.front().id), 6);  // the identities of the data set
  EXPECT_TRUE(std::filesystem::exists(folder_ / "known/map.3Dscene"));
  EXPECT_NE(contentOf(folder_ / "known/config.ini").find("[RangeBearing]"), std::string::npos);

  ASSERT_EQ(colonnade(run + "-o again").exit_code, 0);
  for (const char* file : {"trajectory.tum", "trajectory_covariance.csv", "landmarks.csv"})
    EXPECT_EQ(contentOf(folder_ / "known" / file), contentOf(folder_ / "again" / file)) << file;

  // The world moved along with the map, which is none of NEES's business; smoothing ends elsewhere.
  ASSERT_EQ(colonnade(run + "-o still --set RangeBearing.world_with_map=false").exit_code, 0);
  EXPECT_NEAR(summary("known")["trajectory"]["nees_mean"].get<double>(),
              summary("still")["trajectory"]["nees_mean"].get<double>(), 0.02);
  EXPECT_NE(summary("known")["trajectory"]["ate_rmse_m"],
            summary("still")["trajectory"]["ate_rmse_m"]);
  // The ranges of this robot are long.
  EXPECT_NE(known.err.find("the sensor seems to read ranges 3."), std::string::npos) << known.err;
  const Outcome estimated = colonnade(run + "-o estimated --set RangeBearing.estimate_sensor=true");
  ASSERT_EQ(estimated.exit_code, 0) << estimated.err;
  EXPECT_EQ(estimated.err.find("seems"), std::string::npos) << estimated.err;
  EXPECT_NE(estimated.out.find("sensor     range offset"), std::string::npos) << estimated.out;
  const auto of = summary("estimated");
  EXPECT_NEAR(of["sensor"]["range_scale"]["estimate"].get<double>(), 0.035, 0.015);
  for (const char* when : {"trajectory", "trajectory_final"})
    EXPECT_LT(of[when]["ate_rmse_m"].get<double>(),
              0.8 * summary("known")[when]["ate_rmse_m"].get<double>());

  const Outcome contradiction = colonnade(
      run + "-o none --set RangeBearing.use_ids=false --set RangeBearing.bearing_only=true");
  EXPECT_EQ(contradiction.exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none"));
}

TEST_F(RangeBearingRun, FindsARealRobotInAnotherOnesMap) {
  COLONNADE_REQUIRE_RECORDING(data, "mrclam7");
  for (const char* robot : {"2", "3"})
    ASSERT_EQ(colonnade("import mrclam '" + data.string() + "' --robot " + robot + " -o robot" +
                        robot + ".rawlog")
                  .exit_code,
              0);
  ASSERT_EQ(colonnade("run robot3.rawlog -o map").exit_code, 0);
  const Outcome found = colonnade(
      "run robot2.rawlog --map map/map.colonnade --localize --start anywhere -o found "
      "--ground-truth robot2_ground_truth.tum");
  ASSERT_EQ(found.exit_code, 0) << found.err;
  EXPECT_LT(summary("found")["trajectory"]["ate_rmse_m"].get<double>(), 0.2);
  EXPECT_EQ(readLandmarksCsv(folder_ / "found/landmarks.csv").size(), 15u);

  // Maps are for logs of their kind.
  const Outcome camera =
      colonnade("run '" + corridor().string() + "' --map map/map.colonnade -o none");
  EXPECT_EQ(camera.exit_code, 2);
  EXPECT_NE(camera.err.find("made from landmark readings"), std::string::npos) << camera.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none"));
}

TEST_F(RangeBearingRun, ALoopClosedLateMovesTheStartAndNotTheMap) {
  COLONNADE_REQUIRE_RECORDING(data, "mrclam7");
  ASSERT_EQ(colonnade("import mrclam '" + data.string() + "' --robot 1 -o robot1.rawlog").exit_code,
            0);
  const std::string run = "run robot1.rawlog --ground-truth robot1_ground_truth.tum ";
  ASSERT_EQ(colonnade(run + "-o with").exit_code, 0);
  ASSERT_EQ(colonnade(run + "-o start --set RangeBearing.world_with_map=false").exit_code, 0);
  const double with_map = summary("with")["trajectory"]["ate_rmse_m"].get<double>();
  const double from_start = summary("start")["trajectory"]["ate_rmse_m"].get<double>();
  EXPECT_LT(with_map, 0.2);
  EXPECT_LT(with_map, 0.7 * from_start);
}

TEST_F(Textbook, DeadReckoningDriftsAndTheFilterDoesNot) {
  const Outcome outcome = colonnade("textbook -o book --rounds 2 --runs 10 --seed 3");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(contentOf(folder_ / "book/textbook.json"));
  ASSERT_EQ(json["rmse_m"].size(), 2u);
  for (const auto& round : json["rmse_m"])
    EXPECT_LT(round["invariant_ekf"].get<double>(), 0.4 * round["dead_reckoning"].get<double>());
  // The second round finds all landmarks known.
  EXPECT_LT(json["rmse_m"][1]["invariant_ekf"].get<double>(),
            json["rmse_m"][0]["invariant_ekf"].get<double>());
  EXPECT_GT(json["rmse_m"][1]["dead_reckoning"].get<double>(),
            json["rmse_m"][0]["dead_reckoning"].get<double>());
  for (const char* file : {"map.png", "rmse.png", "distance_round_1.png", "distance_round_2.png"})
    EXPECT_GT(std::filesystem::file_size(folder_ / "book" / file), 5000u) << file;
  EXPECT_EQ(colonnade("textbook -o book").exit_code, 2);  // never into an old folder
}

}  // namespace
}  // namespace colonnade::testing
