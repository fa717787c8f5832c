// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/campaign/run_record.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "campaign_folder.hpp"
#include "colonnade/base/trajectory.hpp"
#include "colonnade/evaluation/covariance_csv.hpp"

namespace colonnade {
namespace {

using Json = nlohmann::json;
class Record : public testing::CampaignFolder {};

TEST_F(Record, ReadsBackAsItWasWritten) {
  const auto plan = planCampaign(parse("world w hall.world\nseeds 1\n"), folder_ / "out", "p");
  const PlannedDrive& drive = plan.drives[0];
  EXPECT_FALSE(readRunRecord(drive.runs[0]));
  RunRecord record;
  record.stamp = drive.runs[0].stamp;
  record.failure = "ATE \"large\"\n";
  record.exit_code = 139;
  record.metrics = {{"ate_rmse_m", 0.1}, {"landmarks.pillar.recall", 1.0 / 3.0}};
  record.timing = {{"wall_s", 2.5}};
  record.nis = {{"pillar", {0.9, 120}}};
  record.nees[9] = 1.25;
  writeRunRecord(drive.runs[0], drive, record);
  const auto back = readRunRecord(drive.runs[0]);
  ASSERT_TRUE(back);
  EXPECT_EQ(record.stamp, back->stamp);
  EXPECT_EQ(record.failure, back->failure);
  EXPECT_EQ(139, back->exit_code);
  EXPECT_EQ(record.metrics, back->metrics);
  EXPECT_EQ(record.timing, back->timing);
  EXPECT_EQ(120u, back->nis.at("pillar").dof);
  EXPECT_FALSE(back->nees[0]);
  EXPECT_EQ(1.25, back->nees[9]);
  const Json json = Json::parse(content("out/runs/w/seed-1/default/run.json"));
  EXPECT_THAT(json["commands"][0].get<std::string>(),
              ::testing::StartsWith("colonnade simulate " + folder_.string() + "/hall.world"));

  write("out/runs/w/seed-1/default/run.json", "{\"stamp\": \"cut off");
  EXPECT_THROW(readRunRecord(drive.runs[0]), Error);
}

TEST_F(Record, TakesWhateverNumbersAnEvaluationHas) {
  RunRecord record;
  addMetrics(Json::parse(R"({"alignment": "se2", "ate_rmse_m": 0.25, "nees_mean": null,
                             "rpe": [1, 2],
                             "landmarks": {"pillar": {"precision": 0.9, "recall": 0.8}},
                             "free_area": {"precision": 0.7}})"),
             Json::parse(R"({"landmarks": {"pillar": 12}, "axes": 1,
                             "nis": {"pillar": {"mean": 0.8, "dof": 20}, "empty": {"mean": null,
                             "dof": 0}}, "timing_ms": {"frame": {"median": 4.5}}})"),
             record);
  EXPECT_THAT(
      record.metrics,
      ::testing::UnorderedElementsAre(
          ::testing::Pair("ate_rmse_m", 0.25), ::testing::Pair("landmarks.pillar.precision", 0.9),
          ::testing::Pair("landmarks.pillar.recall", 0.8),
          ::testing::Pair("free_area.precision", 0.7), ::testing::Pair("map.pillar", 12.0),
          ::testing::Pair("axes", 1.0), ::testing::Pair("nis.pillar", 0.8)));
  EXPECT_EQ(20u, record.nis.at("pillar").dof);
  EXPECT_EQ(4.5, record.timing.at("frame_ms_median"));
  // An evaluation of a whole folder.
  RunRecord folder;
  addMetrics(Json::parse(R"({"trajectory": {"ate_rmse_m": 0.5}, "walls": {"recall": 1}})"),
             Json::object(), folder);
  EXPECT_EQ((std::map<std::string, double>{{"ate_rmse_m", 0.5}, {"walls.recall", 1.0}}),
            folder.metrics);
}

TEST_F(Record, CallsARunFailedByTheRule) {
  RunRecord record;
  const FailureRule rule{.max_ate_m = 0.5, .min_coverage = 0.9};
  EXPECT_EQ("no score", failureOf(record, rule));
  record.metrics = {{"ate_rmse_m", 0.5}, {"coverage", 0.9}};
  EXPECT_EQ("", failureOf(record, rule));
  record.metrics["ate_rmse_m"] = 0.51;
  EXPECT_EQ("ATE 0.51 m, above 0.5 m", failureOf(record, rule));
  record.metrics = {{"ate_rmse_m", 0.1}, {"coverage", 0.25}};
  EXPECT_EQ("coverage 0.25, below 0.9", failureOf(record, rule));
}

TEST_F(Record, TakesTheErrorOfThePoseAtTenthsOfTheRun) {
  // 101 poses along x; the estimate errs by y = t/10 m with a sigma of 0.2 m: e'P^-1 e / 3 is
  // (t/10 / 0.2)^2 / 3 at t = 1, 2 ... 10 s.
  Trajectory truth;
  Trajectory estimate;
  std::vector<StampedCovariance> covariances;
  for (int i = 0; i <= 100; ++i) {
    const double t = 0.1 * i;
    StampedPose pose;
    pose.stamp_s = 1000.0 + t;
    pose.T_world_body.translation() = Eigen::Vector3d(t, 0.0, 0.0);
    truth.push_back(pose);
    pose.T_world_body.translation().y() = 0.1 * t;
    estimate.push_back(pose);
    covariances.push_back({pose.stamp_s, Eigen::Matrix3d::Identity() * (i > 0 ? 0.04 : 0.0)});
  }
  std::filesystem::create_directories(folder_ / "results");
  writeTum(folder_ / "truth.tum", truth);
  writeTum(folder_ / "results/trajectory.tum", estimate);
  writeCovarianceCsv(folder_ / "results/trajectory_covariance.csv", covariances);
  const auto nees = neesAtTenths(folder_ / "results", folder_ / "truth.tum");
  for (std::size_t i = 0; i < kInstants; ++i) {
    const double t = static_cast<double>(i + 1);
    ASSERT_TRUE(nees[i]);
    EXPECT_NEAR(t * t * 0.25 / 3.0, *nees[i], 1e-6) << t;
  }
}

}  // namespace
}  // namespace colonnade
