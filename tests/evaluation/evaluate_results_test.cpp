// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// `colonnade evaluate` on the results folder of a run, with truth beside a log.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "colonnade/evaluation/covariance_csv.hpp"
#include "colonnade/maps/landmark_csv.hpp"
#include "folder_test.hpp"
#include "shared_data.hpp"
#include "test_paths.hpp"

namespace colonnade {
namespace {

using namespace colonnade::testing;
using ::testing::HasSubstr;
using ::testing::Not;

class EvaluateResults : public FolderTest {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(program())) GTEST_SKIP() << program() << " is not built";
    FolderTest::SetUp();
    writeTum(folder_ / "hall_ground_truth.tum", winding());
    LandmarkMap truth(2);
    truth[1].id = LandmarkId{1};
    truth[0].p_world = {2.0, 1.0};
    truth[1].p_world = {4.0, -1.0};
    for (auto& record : truth) record.observations = 50;
    writeLandmarksCsv(folder_ / "hall_landmarks.csv", truth);
    writeFloor(folder_ / "hall_floor", 100, 0.0, 0.0);

    // The same hall from elsewhere, one landmark missed, half of the floor seen.
    const Pose2 T_estimate_truth{3.0, 1.0, 0.0};
    std::filesystem::create_directories(folder_ / "results");
    const auto estimate = moved(T_estimate_truth.toIsometry3(), winding());
    writeTum(folder_ / "results/trajectory.tum", estimate);
    std::vector<StampedCovariance> rows;
    for (const auto& pose : estimate)
      rows.push_back({pose.stamp_s, Eigen::Matrix3d::Identity() * 1e-4});
    rows.front().covariance.setZero();
    writeCovarianceCsv(folder_ / "results/trajectory_covariance.csv", rows);
    truth[0].p_world = transform(T_estimate_truth, truth[0].p_world);
    truth.pop_back();
    writeLandmarksCsv(folder_ / "results/landmarks.csv", truth);
    writeFloor(folder_ / "results/map", 50, 3.0, 1.0);
  }

  /// A free floor, 4 m high.
  static void writeFloor(const std::filesystem::path& stem, int width, double x, double y) {
    std::ofstream picture(stem.string() + ".pgm");
    picture << "P2\n" << width << " 40\n255\n";
    for (int i = 0; i < width * 40; ++i) picture << "254\n";
    std::ofstream(stem.string() + ".yaml")
        << "image: " << stem.filename().string() << ".pgm\nresolution: 0.1\norigin: [" << x << ", "
        << y << ", 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
  }

  struct Outcome {
    int code = -1;
    std::string text;
  };
  Outcome run(const std::string& arguments, const std::string& redirection = "2>&1") const {
    const std::string command = "cd '" + folder_.string() + "' && '" + program().string() +
                                "' evaluate " + arguments + " " + redirection;
    Outcome outcome;
    FILE* pipe = ::popen(command.c_str(), "r");
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe))
      outcome.text += static_cast<char>(c);
    outcome.code = WEXITSTATUS(::pclose(pipe));
    return outcome;
  }
};

TEST_F(EvaluateResults, ScoresEverythingInTheFolderFromAnyTruthBesideTheLog) {
  std::ofstream(folder_ / "hall.rawlog.gz") << "only its name counts here";
  for (const std::string truth :
       {"hall.rawlog.gz", "hall_ground_truth.tum", "hall_landmarks.csv", "hall_floor.yaml"}) {
    const auto outcome = run("results --json --ground-truth " + truth);
    ASSERT_EQ(outcome.code, 0) << outcome.text;
    const auto json = nlohmann::json::parse(outcome.text);
    EXPECT_NEAR(json["ate_rmse_m"].get<double>(), 0.0, 1e-6);
    EXPECT_NEAR(json["nees_mean"].get<double>(), 0.0, 1e-6);
    EXPECT_DOUBLE_EQ(json["landmarks"]["pillar"]["precision"].get<double>(), 1.0);
    EXPECT_DOUBLE_EQ(json["landmarks"]["pillar"]["recall"].get<double>(), 0.5);
    EXPECT_EQ(json["landmarks"]["pillar"]["missed_truth_ids"], nlohmann::json::array({1}));
    EXPECT_TRUE(json["landmarks"]["floor_edge"]["precision"].is_null());
    EXPECT_TRUE(json["walls"]["angle_rmse_deg"].is_null());
    EXPECT_NEAR(json["free_area"]["recall"].get<double>(), 0.5, 0.02);
    EXPECT_NEAR(json["free_area"]["precision"].get<double>(), 1.0, 0.02);
    EXPECT_TRUE(json["not_scored"].empty());
  }
}

TEST_F(EvaluateResults, PrintsATable) {
  const auto outcome = run("results --ground-truth hall_floor.png --gate 0.25");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.text, HasSubstr("right within 0.25 m"));
  EXPECT_THAT(outcome.text, HasSubstr("precision 100 % (1 of 1, 0 duplicates, 0 false)"));
  EXPECT_THAT(outcome.text, HasSubstr("recall 50 % (1 of 2 seen)"));
  EXPECT_THAT(outcome.text, HasSubstr("free floor"));
  EXPECT_THAT(outcome.text, HasSubstr("truth covers 100 % of the estimate"));
  EXPECT_THAT(outcome.text, Not(HasSubstr("not scored")));
}

TEST_F(EvaluateResults, SaysInOneLineWhatItCouldNotScore) {
  std::filesystem::remove(folder_ / "results/map.yaml");
  std::filesystem::remove(folder_ / "hall_landmarks.csv");
  const auto words = run("results --ground-truth hall_ground_truth.tum --json", "2>&1 >json.txt");
  EXPECT_EQ(words.code, 0);
  EXPECT_EQ(words.text,
            "not scored: landmarks (hall_landmarks.csv is missing), free floor "
            "(results/map.yaml is missing)\n");
  std::ifstream file(folder_ / "json.txt");
  const auto json = nlohmann::json::parse(file);
  EXPECT_EQ(json["not_scored"].size(), 2U);
  EXPECT_FALSE(json.contains("landmarks"));
}

TEST_F(EvaluateResults, TakesPartsByName) {
  std::filesystem::rename(folder_ / "results/trajectory.tum", folder_ / "t.tum");
  const std::string base = "t.tum --ground-truth hall_ground_truth.tum ";
  const auto both = run(base + "--json --landmarks results/landmarks.csv --floor results/map.yaml");
  ASSERT_EQ(both.code, 0) << both.text;
  EXPECT_TRUE(nlohmann::json::parse(both.text).contains("landmarks"));
  EXPECT_TRUE(nlohmann::json::parse(both.text).contains("free_area"));
  // A trajectory alone is scored alone, without a word on maps.
  const auto alone = run(base);
  EXPECT_EQ(alone.code, 0);
  EXPECT_THAT(alone.text, Not(HasSubstr("landmarks")));
  const auto half = run(base + "--truth-landmarks hall_landmarks.csv");
  EXPECT_EQ(half.code, 2);
  EXPECT_THAT(half.text, HasSubstr("--landmarks"));
  std::filesystem::rename(folder_ / "hall_ground_truth.tum", folder_ / "truth.tum");
  const auto other = run("t.tum --ground-truth truth.tum --floor results/map.yaml");
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.text, HasSubstr("--truth-floor"));
}

TEST_F(EvaluateResults, MakesMistakesPlain) {
  const auto nothing = run(". --ground-truth hall_ground_truth.tum");
  EXPECT_EQ(nothing.code, 1);
  EXPECT_THAT(nothing.text, HasSubstr("holds no trajectory.tum"));
  const auto no_truth = run("results --ground-truth other.rawlog");
  EXPECT_EQ(no_truth.code, 1);
  EXPECT_THAT(no_truth.text, HasSubstr("other_ground_truth.tum is missing"));
  std::ofstream(folder_ / "results/landmarks.csv") << "id,kind,x,y\n0,pillar,1,2\n";
  const auto columns = run("results --ground-truth hall_ground_truth.tum");
  EXPECT_EQ(columns.code, 1);
  EXPECT_THAT(columns.text, HasSubstr("landmarks.csv:1: column direction is missing"));
  EXPECT_EQ(run("results --ground-truth hall.rawlog --gate 0").code, 2);
}

/// The corridor of the repository, run as a user runs it. Bounds leave room for other machines: a
/// map drawn wrongly, or matched wrongly, is far outside them.
TEST_F(EvaluateResults, OfARealRunAreWhatThePictureShows) {
  const auto log = sourceFolder() / "rawlogs/corridor.rawlog";
  const std::string command = "cd '" + folder_.string() + "' && '" + program().string() +
                              "' run '" + log.string() + "' -o map >log.txt 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const auto outcome = run("map --json --ground-truth '" + log.string() + "'");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  const auto json = nlohmann::json::parse(outcome.text);
  EXPECT_TRUE(json["nees_refused"].is_null());
  const auto number = [&](const char* kind, const char* key) {
    return json["landmarks"][kind][key].get<double>();
  };
  EXPECT_GT(number("pillar", "precision"), 0.75);
  EXPECT_GT(number("pillar", "recall"), 0.45);
  EXPECT_LT(number("pillar", "position_median_m"), 0.08);
  EXPECT_GT(number("depth_slope", "precision"), 0.8);
  EXPECT_GT(number("depth_slope", "recall"), 0.4);
  EXPECT_GT(number("floor_edge", "precision"), 0.75);
  EXPECT_GT(number("floor_edge", "length_recall"), 0.5);
  EXPECT_LT(json["walls"]["angle_rmse_deg"].get<double>(), 2.0);
  EXPECT_GT(json["free_area"]["precision"].get<double>(), 0.95);
  EXPECT_GT(json["free_area"]["iou"].get<double>(), 0.7);

  std::ifstream file(folder_ / "map/summary.json");
  const auto summary = nlohmann::json::parse(file);
  for (const char* kind : {"pillar", "floor_edge", "depth_slope"}) {
    const auto& nis = summary["nis"][kind];
    EXPECT_EQ(nis["mean"], summary["nis_mean"][kind]);
    EXPECT_GE(nis["dof"].get<int>(), nis["count"].get<int>());
    EXPECT_LE(nis["dof"].get<int>(), 2 * nis["count"].get<int>());
    EXPECT_GT(nis["band_95"][0].get<double>(), 0.5);
    EXPECT_LT(nis["band_95"][0].get<double>(), 1.0);
    EXPECT_GT(nis["band_95"][1].get<double>(), 1.0);
  }
}

}  // namespace
}  // namespace colonnade
