// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/campaign/table.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "campaign_folder.hpp"

namespace colonnade {
namespace {

using ::testing::HasSubstr;

TEST(Spread, IsOfOddAndEvenCounts) {
  EXPECT_FALSE(spreadOf({}));
  const auto odd = spreadOf({5.0, 1.0, 3.0});
  EXPECT_EQ(3u, odd->count);
  EXPECT_DOUBLE_EQ(3.0, odd->median);
  EXPECT_DOUBLE_EQ(1.0, odd->minimum);
  EXPECT_DOUBLE_EQ(5.0, odd->maximum);
  EXPECT_DOUBLE_EQ(2.5, spreadOf({4.0, 1.0, 3.0, 2.0})->median);
  EXPECT_DOUBLE_EQ(7.0, spreadOf({7.0})->median);
}

/// Ten seeds of a world with two configurations, records by hand.
class Table : public testing::CampaignFolder {
 protected:
  void SetUp() override {
    CampaignFolder::SetUp();
    plan_ = planCampaign(
        parse("world w hall.world\nseeds 1..10\nconfiguration good\nconfiguration bad\n"),
        folder_ / "out", "p");
    for (const PlannedDrive& drive : plan_.drives) {
      const auto seed = static_cast<double>(drive.seed);
      RunRecord good;
      good.stamp = drive.runs[0].stamp;
      good.metrics = {{"ate_rmse_m", 0.01 * seed}, {"landmarks.recall", 0.5}};
      good.timing = {{"frame_ms_median", seed}};
      good.nis = {{"pillar", drive.seed == 1 ? InnovationMean{2.0, 30} : InnovationMean{0.5, 10}}};
      good.nees.fill(seed / 5.5);  // mean 1
      good.nees[9] = 0.4;
      if (drive.seed > 4) good.nees[3].reset();
      writeRunRecord(drive.runs[0], drive, good);
      if (drive.seed > 2) continue;  // eight runs are missing
      RunRecord bad;
      bad.stamp = drive.seed == 1 ? drive.runs[1].stamp : "program: other\n";
      bad.failure = "run: exit 2: say, \"why\"";
      bad.exit_code = 2;
      writeRunRecord(drive.runs[1], drive, bad);
    }
  }
  CampaignPlan plan_;
};

TEST_F(Table, AddsUpByHand) {
  const CampaignTable table = tabulate(plan_);
  ASSERT_EQ(2u, table.rows.size());
  const TableRow& good = table.rows[0];
  EXPECT_EQ("good", good.configuration);
  EXPECT_EQ(10u, good.done);
  EXPECT_TRUE(good.failures.empty());
  EXPECT_DOUBLE_EQ(0.055, good.metrics.at("ate_rmse_m").median);
  EXPECT_DOUBLE_EQ(0.01, good.metrics.at("ate_rmse_m").minimum);
  EXPECT_DOUBLE_EQ(0.10, good.metrics.at("ate_rmse_m").maximum);
  EXPECT_DOUBLE_EQ(5.5, good.timing.at("frame_ms_median").median);
  // NEES: chi-square with 30 degrees of freedom is within 16.791 and 46.979 (tables), over 30.
  EXPECT_NEAR(1.0, good.nees[0]->mean, 1e-12);
  EXPECT_NEAR(16.791 / 30.0, good.nees[0]->band.low, 1e-3);
  EXPECT_NEAR(46.979 / 30.0, good.nees[0]->band.high, 1e-3);
  EXPECT_STREQ("", good.nees[0]->verdict());
  EXPECT_STREQ("low", good.nees[9]->verdict());
  // Where four runs have the instant: 12 degrees of freedom, 4.404 to 23.337.
  EXPECT_EQ(4u, good.nees[3]->count);
  EXPECT_NEAR(2.5 / 5.5, good.nees[3]->mean, 1e-12);
  EXPECT_NEAR(4.404 / 12.0, good.nees[3]->band.low, 1e-3);
  EXPECT_NEAR(23.337 / 12.0, good.nees[3]->band.high, 1e-3);
  // NIS: (2 * 30 + 9 * 0.5 * 10) / 120; chi-square with 120: 91.573 to 152.211.
  const Consistency& nis = good.nis.at("pillar");
  EXPECT_EQ(120u, nis.count);
  EXPECT_NEAR(105.0 / 120.0, nis.mean, 1e-12);
  EXPECT_NEAR(91.573 / 120.0, nis.band.low, 1e-3);
  EXPECT_NEAR(152.211 / 120.0, nis.band.high, 1e-3);

  const TableRow& bad = table.rows[1];
  EXPECT_EQ(10u, bad.planned);
  EXPECT_EQ(1u, bad.done);
  EXPECT_THAT(bad.failures, ::testing::ElementsAre("seed 1: run: exit 2: say, \"why\""));
  EXPECT_EQ(1u, table.outdated);
  EXPECT_FALSE(table.complete());
  EXPECT_EQ(1u, table.failures());
}

TEST_F(Table, IsReadableByPeopleAndPrograms) {
  const CampaignTable table = tabulate(plan_);
  writeTable(table, plan_);
  const std::string text = content("out/campaign.md");
  EXPECT_THAT(text, HasSubstr("| w | good | 10 | 0 | 0.055 (0.010 to 0.100) |"));
  EXPECT_THAT(text, HasSubstr("| w | bad | 1 of 10 | 1 | - |"));
  EXPECT_THAT(text, HasSubstr("**Not complete:** 9 of 20 runs are missing, 1 of them were made"));
  EXPECT_THAT(text, HasSubstr("A run failed when"));
  EXPECT_THAT(text, HasSubstr("| world | configuration | landmarks.recall |"));
  EXPECT_THAT(text, HasSubstr("- w, bad, seed 1: run: exit 2: say, \"why\"\n"));
  const auto json = nlohmann::json::parse(content("out/campaign.json"));
  EXPECT_EQ(20, json["runs"]);
  EXPECT_EQ(false, json["complete"]);
  EXPECT_EQ(10, json["rows"][0]["metrics"]["ate_rmse_m"]["runs"]);
  EXPECT_EQ(1, json["rows"][1]["failed"]);
  EXPECT_NEAR(0.875, json["rows"][0]["nis"]["pillar"]["mean"].get<double>(), 1e-12);
  const std::string csv = content("out/campaign.csv");
  EXPECT_THAT(
      csv, ::testing::StartsWith("run,world,seed,configuration,state,failure,exit_code,ate_rmse_m,"
                                 "landmarks.recall,nees_at_10,"));
  EXPECT_THAT(csv, HasSubstr(",nees_at_100,frame_ms_median\n"));
  EXPECT_THAT(csv, HasSubstr("\n0,w,1,good,done,,0,0.01,0.5,"));
  EXPECT_THAT(csv, HasSubstr("\n1,w,1,bad,failed,\"run: exit 2: say, \"\"why\"\"\",2,,,"));
  EXPECT_THAT(csv, HasSubstr("\n3,w,2,bad,open,,,"));
  EXPECT_EQ(21, std::count(csv.begin(), csv.end(), '\n'));
  // Every row has as many fields as the header; the quoted ones hold one comma more.
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  const auto commas = std::count(line.begin(), line.end(), ',');
  while (std::getline(lines, line))
    EXPECT_EQ(commas, std::count(line.begin(), line.end(), ',') -
                          (line.find('"') == std::string::npos ? 0 : 1))
        << line;
}

}  // namespace
}  // namespace colonnade
