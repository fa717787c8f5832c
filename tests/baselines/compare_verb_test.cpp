// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "../apps/program.hpp"

namespace colonnade {
namespace {

using Json = nlohmann::json;

class CompareVerb : public testing::ProgramTest {
 protected:
  /// The corridor with few frames, far apart.
  void simulate(const std::string& name, const std::string& settings) const {
    const auto outcome = colonnade(
        "simulate '" + (testing::sourceFolder() / "rawlogs/worlds/corridor.world").string() +
        "' -o " + name + ".rawlog " + settings);
    ASSERT_EQ(0, outcome.exit_code) << outcome.err;
  }
  Json comparison(const std::string& results) const {
    return Json::parse(testing::contentOf(folder_ / results / "compare.json"));
  }
  static Json row(const Json& comparison, const std::string& key) {
    for (const Json& method : comparison["methods"])
      if (method["key"] == key) return method;
    ADD_FAILURE() << "no row " << key;
    return {};
  }
};

TEST_F(CompareVerb, PutsEveryMethodIntoOneTable) {
  simulate("c", "--set camera.rate_hz=2");
  const auto outcome =
      colonnade("compare c.rawlog -o r --runs 2 --ground-truth c_ground_truth.tum");
  ASSERT_EQ(0, outcome.exit_code) << outcome.err;
  const Json json = comparison("r");
  EXPECT_EQ(testing::contentOf(folder_ / "r/compare.md"),
            outcome.out.substr(0, outcome.out.rfind("\nresults")));

  const Json slam = row(json, "colonnade");
  EXPECT_EQ("ok", slam["verdict"]);
  ASSERT_EQ(1u, slam["runs"].size());
  const Json figures = slam["runs"][0]["figures"];
  EXPECT_EQ(summary("r/runs/colonnade")["trajectory"]["ate_rmse_m"], figures["ate_m"]);
  EXPECT_GT(figures["landmarks"].get<double>(), 5.0);
  EXPECT_GT(figures["landmarks_per_frame"].get<double>(), 0.5);
  EXPECT_GT(figures["frame_ms_p95"].get<double>(), figures["frame_ms_median"].get<double>() * 0.99);
  EXPECT_GT(figures["map_bytes"].get<double>(), 100.0);
  EXPECT_EQ(0.0, row(json, "motion-alone")["median"]["landmarks"]);
  EXPECT_EQ("ok", row(json, "dead-reckoning")["verdict"]);
  EXPECT_GT(row(json, "kf-slam")["median"]["landmarks"].get<double>(), 5.0);

  // At 40 cm a frame the corners are lost: the row says so and counts the runs.
  const Json peer = row(json, "kinect-3d-slam");
  ASSERT_EQ(2u, peer["runs"].size());
  EXPECT_EQ(2, peer["failed_runs"]);
  EXPECT_TRUE(peer["verdict"].get<std::string>().starts_with("FAILED 2 of 2: covers "))
      << peer["verdict"];
  EXPECT_NE(std::string::npos, outcome.out.find(peer["verdict"].get<std::string>()));
  EXPECT_NE(std::string::npos, outcome.out.find("A run FAILED when"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "r/runs/kinect-3d-slam-1/map.ply"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "r/runs/kinect-3d-slam-2/map.ply"));
}

TEST_F(CompareVerb, NamesWhatALogLacksAndRunsTheRest) {
  simulate("c", "--set camera.rate_hz=3 --set depth.enabled=0");
  const auto outcome = colonnade("compare c.rawlog -o r --ablations --jobs 2");
  ASSERT_EQ(0, outcome.exit_code) << outcome.err;
  const Json json = comparison("r");
  for (const char* key : {"kinect-3d-slam", "difodo", "kf-slam"}) {
    EXPECT_EQ("missing: no depth in the log", row(json, key)["verdict"]) << key;
    EXPECT_TRUE(row(json, key)["runs"].empty());
  }
  EXPECT_EQ("ok", row(json, "colonnade")["verdict"]);
  EXPECT_FALSE(row(json, "colonnade")["median"].contains("ate_m"));
  EXPECT_EQ(false, json["contents"]["ground_truth"]);
  EXPECT_NE(std::string::npos, outcome.out.find("no depth; no ground truth given"));
  EXPECT_NE(std::string::npos, outcome.out.find("2 at a time, which disturbs the times"));
  // An ablation does what it says.
  const auto kinds = [&](const std::string& run) {
    return Json::parse(testing::contentOf(folder_ / "r/runs" / run / "summary.json"))["landmarks"];
  };
  EXPECT_EQ(0, kinds("no-pillars")["pillar"]);
  EXPECT_EQ(0, kinds("no-floor-edges")["floor_edge"]);
  EXPECT_GT(kinds("no-floor-edges")["pillar"].get<int>(), 0);
}

TEST_F(CompareVerb, RefusesBeforeItBegins) {
  const std::string log = corridor().string();
  const auto refused = [&](const std::string& arguments, int exit_code) {
    const auto outcome = colonnade("compare " + arguments + " -o r");
    EXPECT_EQ(exit_code, outcome.exit_code) << arguments << outcome.err;
    EXPECT_EQ(1, outcome.errorLines()) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "r"));
  };
  refused("absent.rawlog", 1);
  refused(log + " --ground-truth absent.tum", 1);
  refused(log + " --runs 0", 2);
  refused(log + " -c absent.ini", 2);
}

}  // namespace
}  // namespace colonnade
