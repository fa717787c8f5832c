// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// `colonnade evaluate` as a user meets it.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "colonnade/evaluation/covariance_csv.hpp"
#include "folder_test.hpp"
#include "shared_data.hpp"
#include "test_paths.hpp"

namespace colonnade {
namespace {

using namespace colonnade::testing;
using ::testing::HasSubstr;

struct Outcome {
  int code = -1;
  std::string text;
};

class EvaluateVerb : public FolderTest {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(program())) GTEST_SKIP() << program() << " is not built";
    FolderTest::SetUp();
    writeTum(folder_ / "truth.tum", winding());
    writeTum(folder_ / "estimate.tum", noisy(winding()));
  }

  Outcome run(const std::string& arguments) const {
    const std::string command = "cd '" + folder_.string() + "' && '" + program().string() +
                                "' evaluate " + arguments + " 2>&1";
    Outcome outcome;
    FILE* pipe = ::popen(command.c_str(), "r");
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe))
      outcome.text += static_cast<char>(c);
    outcome.code = WEXITSTATUS(::pclose(pipe));
    return outcome;
  }
};

TEST_F(EvaluateVerb, PrintsATableThatNamesItsAlignment) {
  const auto outcome = run("estimate.tum --ground-truth truth.tum");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.text, HasSubstr("se2 (rigid in x, y, yaw; no scale)"));
  EXPECT_THAT(outcome.text, HasSubstr("ATE rmse"));
  EXPECT_THAT(outcome.text, HasSubstr("RPE over 10 m"));
}

TEST_F(EvaluateVerb, PrintsJsonWithThePromisedKeys) {
  const auto outcome = run("estimate.tum --ground-truth truth.tum --align se3 --json");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const auto json = nlohmann::json::parse(outcome.text);
  for (const char* key : {"alignment", "ate_rmse_m", "rpe_1m_percent", "heading_rmse_deg",
                          "nees_mean", "coverage", "matched"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["alignment"], "se3");
  EXPECT_TRUE(json["nees_mean"].is_null());
  EXPECT_EQ(json["matched"], 201);
  EXPECT_NEAR(json["ate_rmse_m"].get<double>(), 0.028, 0.004);  // 2 cm in x and in y
}

TEST_F(EvaluateVerb, ScoresConsistencyWithCovariances) {
  std::vector<StampedCovariance> rows;
  for (const auto& pose : winding())
    rows.push_back({pose.stamp_s, Eigen::Matrix3d::Identity() * 1e-3});
  rows.front().covariance.setZero();
  writeCovarianceCsv(folder_ / "covariance.csv", rows);
  const auto outcome =
      run("estimate.tum --ground-truth truth.tum --covariance covariance.csv --json");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_GT(nlohmann::json::parse(outcome.text)["nees_mean"].get<double>(), 0.0);
}

TEST_F(EvaluateVerb, MakesMistakesPlain) {
  const auto absent = run("absent.tum --ground-truth truth.tum");
  EXPECT_EQ(absent.code, 1);
  EXPECT_THAT(absent.text, HasSubstr("absent.tum: cannot be read"));
  auto late = winding();
  for (auto& pose : late) pose.stamp_s += 100.0;
  writeTum(folder_ / "late.tum", late);
  const auto apart = run("late.tum --ground-truth truth.tum");
  EXPECT_EQ(apart.code, 1);
  EXPECT_THAT(apart.text, HasSubstr("100.000 to 120.000 s"));
  EXPECT_EQ(run("estimate.tum --ground-truth truth.tum --align sim3").code, 2);
  EXPECT_EQ(run("estimate.tum").code, 2);
}

}  // namespace
}  // namespace colonnade
