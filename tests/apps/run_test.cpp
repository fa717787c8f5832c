// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <zlib.h>

#include <set>

#include "colonnade/base/text.hpp"
#include "colonnade/base/trajectory.hpp"
#include "colonnade/frames/rawlog_source.hpp"
#include "colonnade/maps/landmark_csv.hpp"
#include "program.hpp"

namespace colonnade {
namespace {

using testing::contentOf;

class Run : public testing::ProgramTest {
 protected:
  std::string truthOf(const std::filesystem::path& log) const {
    return log.parent_path() / (log.stem().string() + "_ground_truth.tum");
  }
};

TEST_F(Run, WheelsAndCameraTogetherAreBetterThanWheelsAlone) {
  const std::string arguments =
      "run " + corridor().string() + " --ground-truth " + truthOf(corridor()) + " -o ";
  ASSERT_EQ(0, colonnade(arguments + "both").exit_code);
  ASSERT_EQ(0, colonnade(arguments + "wheels --set Motion.source=odometry").exit_code);
  const auto both = summary("both");
  EXPECT_EQ("odometry_visual", both["motion_source"]);
  EXPECT_LT(both["trajectory"]["ate_rmse_m"].get<double>(), 0.03);
  EXPECT_LT(both["trajectory"]["ate_rmse_m"].get<double>(),
            0.7 * summary("wheels")["trajectory"]["ate_rmse_m"].get<double>());
}

TEST_F(Run, MapsTheCorridorAtAThirdOfDeadReckoningsError) {
  const std::string log = corridor().string();
  const std::string truth = " --ground-truth " + truthOf(corridor());
  const std::string wheels = " --set Motion.source=odometry";
  ASSERT_EQ(0, colonnade("run " + log + " -o slam" + truth + wheels).exit_code);
  // No landmark ever reaches the map and no wall the heading: what is left is dead reckoning.
  ASSERT_EQ(0, colonnade("run " + log + " -o reckoning" + truth + wheels +
                         " --set Axes.enabled=false --set Initialization.sightings=100"
                         " --set Initialization.max_bearing_candidates=0 --set "
                         "FloorEdges.max_distance_sigma_m=0.01")
                   .exit_code);
  const auto slam = summary("slam");
  const auto reckoning = summary("reckoning");
  EXPECT_EQ("odometry", slam["motion_source"]);
  EXPECT_EQ(slam["frames"], slam["frames_processed"]);
  EXPECT_LT(slam["trajectory"]["ate_rmse_m"].get<double>(),
            reckoning["trajectory"]["ate_rmse_m"].get<double>() / 3.0);
  EXPECT_LT(slam["trajectory"]["ate_rmse_m"].get<double>(), 0.08);
  EXPECT_LT(slam["trajectory"]["heading_rmse_deg"].get<double>(), 1.0);
  EXPECT_LT(slam["trajectory"]["nees_mean"].get<double>(), 2.0);
  EXPECT_DOUBLE_EQ(1.0, slam["trajectory"]["coverage"].get<double>());
  EXPECT_GE(slam["landmarks"]["pillar"].get<int>(), 20);
  EXPECT_GE(slam["landmarks"]["floor_edge"].get<int>(), 4);
  EXPECT_GE(slam["landmarks"]["depth_slope"].get<int>(), 15);
}

/// Share of mapped landmarks with a true one of the same kind within `distance`, after the two
/// trajectories start at the same pose.
TEST_F(Run, MostMappedLandmarksStandWhereTheBuildingHasOne) {
  ASSERT_EQ(0, colonnade("run " + corridor().string() + " -o r").exit_code);
  const LandmarkMap map = readLandmarksCsv(folder_ / "r/landmarks.csv");
  const LandmarkMap truth =
      readLandmarksCsv(testing::sourceFolder() / "rawlogs/corridor_landmarks.csv");
  const Pose2 T_truth_map = planarPart(readTum(truthOf(corridor())).front().T_world_body);
  int corners = 0;
  int right = 0;
  for (const LandmarkRecord& record : map) {
    if (record.kind != LandmarkKind::kDepthSlope) continue;
    ++corners;
    const Eigen::Vector2d p = transform(T_truth_map, record.p_world);
    right += std::any_of(truth.begin(), truth.end(), [&](const LandmarkRecord& t) {
      return t.kind == LandmarkKind::kDepthSlope && (t.p_world - p).norm() < 0.2;
    });
  }
  ASSERT_GT(corners, 10);
  EXPECT_GE(right, 0.8 * corners);
}

TEST_F(Run, TwiceGivesTheSameBytes) {
  for (const std::string name : {"a", "b"})
    ASSERT_EQ(0, colonnade("run " + corridor().string() + " -o " + name).exit_code);
  int compared = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "a")) {
    if (entry.path().filename() == "summary.json") continue;
    EXPECT_TRUE(contentOf(entry.path()) == contentOf(folder_ / "b" / entry.path().filename()))
        << entry.path().filename();
    ++compared;
  }
  EXPECT_GE(compared, 14);
  auto a = summary("a");
  auto b = summary("b");
  for (auto* json : {&a, &b})
    for (const char* measured : {"timing_ms", "realtime_factor", "peak_rss_mb"})
      json->erase(measured);
  EXPECT_EQ(a, b);
}

TEST_F(Run, GoesOnInAMapFromAStartNobodyKnows) {
  const std::string again = "run " + corridor().string() + " --map first/map.colonnade ";
  ASSERT_EQ(0, colonnade("run " + corridor().string() + " -o first").exit_code);
  const auto outcome = colonnade(again + "--localize --start anywhere -o found --ground-truth " +
                                 truthOf(corridor()));
  ASSERT_EQ(0, outcome.exit_code) << outcome.err;
  EXPECT_NE(std::string::npos, contentOf(folder_ / "found/events.csv").find(",place found,,"));
  EXPECT_LT(summary("found")["trajectory"]["ate_rmse_m"].get<double>(), 0.03);
  EXPECT_LT(readTum(folder_ / "found/trajectory.tum").size(),
            readTum(folder_ / "found/trajectory_final.tum").size());
  EXPECT_EQ(readTum(folder_ / "found/trajectory_final.tum").size(),
            summary("found")["frames_processed"].get<std::size_t>());

  const auto nowhere =
      colonnade(again + "--start anywhere -o nowhere --set Places.min_places=1000");
  EXPECT_EQ(1, nowhere.exit_code);
  EXPECT_NE(std::string::npos, nowhere.err.find("was not found (too few places fit"))
      << nowhere.err;
  EXPECT_TRUE(readTum(folder_ / "nowhere/trajectory.tum").empty());
  EXPECT_FALSE(readTum(folder_ / "nowhere/trajectory_final.tum").empty());

  for (const char* start : {"1,2", "1,2,x", "somewhere", "1,2,3,4", "nan,0,0"}) {
    const auto refused = colonnade(again + "-o none --start " + start);
    EXPECT_EQ(2, refused.exit_code) << start;
    EXPECT_NE(std::string::npos, refused.err.find("give x,y,heading")) << refused.err;
  }
  EXPECT_EQ(0, colonnade(again + "--localize --start 0,0,0 -o known").exit_code);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none"));
}

TEST_F(Run, FollowsARealCorridorAndTellsItsParts) {
  COLONNADE_REQUIRE_RECORDING(recording, "corridor_xtion");
  ASSERT_EQ(0, colonnade("import tum " + recording.string() + " -o c.rawlog").exit_code);
  const auto outcome = colonnade("run c.rawlog -o r --ground-truth c_ground_truth.tum");
  ASSERT_EQ(0, outcome.exit_code) << outcome.err;
  const auto s = summary("r");
  EXPECT_EQ(120, s["frames_processed"]);
  EXPECT_EQ(1.0, s["trajectory"]["coverage"]);
  // The reference itself is good to 0.05 m; MRPT's own visual method reaches 0.19 m here.
  EXPECT_LT(s["trajectory"]["ate_rmse_m"].get<double>(), 0.08);
  EXPECT_LT(s["trajectory"]["heading_rmse_deg"].get<double>(), 1.5);
  EXPECT_GE(s["landmarks"]["pillar"].get<int>(), 10);
  EXPECT_GE(s["landmarks"]["floor_edge"].get<int>(), 2);
  EXPECT_GE(s["landmarks"]["depth_slope"].get<int>(), 2);
}

TEST_F(Run, FollowsBareZigZagWalls) {
  COLONNADE_REQUIRE_RECORDING(recording, "tum_fr3_structure_notexture_far");
  ASSERT_EQ(0, colonnade("import tum " + recording.string() + " -o f.rawlog").exit_code);
  ASSERT_EQ(0, colonnade("run f.rawlog -o r --ground-truth f_ground_truth.tum").exit_code);
  EXPECT_LT(summary("r")["trajectory"]["ate_rmse_m"].get<double>(), 0.04);
}

TEST_F(Run, ResultsNeverOverwriteAnything) {
  std::filesystem::copy(corridor(), folder_ / "c.rawlog");
  ASSERT_EQ(0, colonnade("run c.rawlog").exit_code);
  ASSERT_EQ(0, colonnade("run c.rawlog").exit_code);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "c_results/summary.json"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "c_results-2/summary.json"));
  const auto refused = colonnade("run c.rawlog -o c_results");
  EXPECT_EQ(2, refused.exit_code);
  EXPECT_EQ(1, refused.errorLines()) << refused.err;
}

TEST_F(Run, TheEffectiveConfigurationReproducesTheRun) {
  ASSERT_EQ(0, colonnade("run " + corridor().string() + " -o a --set Axes.merge_deg=7").exit_code);
  ASSERT_EQ(0, colonnade("run " + corridor().string() + " -o b -c a/config.ini").exit_code);
  EXPECT_TRUE(contentOf(folder_ / "a/trajectory.tum") == contentOf(folder_ / "b/trajectory.tum"));
  EXPECT_EQ(contentOf(folder_ / "a/config.ini"), contentOf(folder_ / "b/config.ini"));
}

}  // namespace
}  // namespace colonnade
