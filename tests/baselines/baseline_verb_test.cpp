// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "../apps/program.hpp"
#include "colonnade/base/trajectory.hpp"
#include "colonnade/maps/landmark_csv.hpp"

namespace colonnade {
namespace {

class BaselineVerb : public testing::ProgramTest {
 protected:
  std::string corridorAndTruth() const {
    return corridor().string() + " --ground-truth " +
           (corridor().parent_path() / "corridor_ground_truth.tum").string();
  }
};

TEST_F(BaselineVerb, WritesTrajectorySummaryAndScore) {
  const auto outcome = colonnade("baseline kf-slam " + corridorAndTruth() + " -o r");
  ASSERT_EQ(0, outcome.exit_code) << outcome.err;
  const auto s = summary("r");
  EXPECT_EQ(226, s["frames_processed"]);
  EXPECT_EQ(226u, readTum(folder_ / "r/trajectory.tum").size());
  EXPECT_LT(s["trajectory"]["ate_rmse_m"].get<double>(), 1.0);
  EXPECT_GT(s["timing_ms"]["frame"]["median"].get<double>(), 0.0);
  EXPECT_GT(s["peak_rss_mb"].get<double>(), 1.0);
  EXPECT_EQ(std::filesystem::file_size(folder_ / "r/landmarks.csv"), s["map_bytes"]);
  const auto map = readLandmarksCsv(folder_ / "r/landmarks.csv");
  EXPECT_EQ(map.size(), s["landmarks"]["pillar"].get<std::size_t>() +
                            s["landmarks"]["depth_slope"].get<std::size_t>());
}

TEST_F(BaselineVerb, DeadReckoningOfTheCorridorIsTheOdometryInTheLog) {
  ASSERT_EQ(0, colonnade("baseline dead-reckoning " + corridorAndTruth() + " -o r").exit_code);
  // The world's odometry errs by some percent: neither the truth nor nonsense.
  const double ate = summary("r")["trajectory"]["ate_rmse_m"];
  EXPECT_GT(ate, 0.03);
  EXPECT_LT(ate, 1.5);
}

TEST_F(BaselineVerb, RefusesInOneLine) {
  EXPECT_EQ(2, colonnade("baseline orb-slam x.rawlog").exit_code);
  EXPECT_EQ(
      2, colonnade("baseline difodo " + corridor().string() + " --set Difodo.levls=2").exit_code);
  const auto absent = colonnade("baseline difodo absent.rawlog");
  EXPECT_EQ(1, absent.exit_code);
  EXPECT_EQ(1, absent.errorLines()) << absent.err;
}

TEST_F(BaselineVerb, FollowsARealCorridor) {
  COLONNADE_REQUIRE_RECORDING(recording, "corridor_xtion");
  ASSERT_EQ(0, colonnade("import tum " + recording.string() + " -o c.rawlog").exit_code);
  const std::string log = " c.rawlog --ground-truth c_ground_truth.tum";
  ASSERT_EQ(0,
            colonnade("baseline kinect-3d-slam" + log + " -o k --set KinectSlam.map=0").exit_code);
  const auto s = summary("k");
  EXPECT_EQ(0, s["lost_frames"]);
  EXPECT_LT(s["trajectory"]["ate_rmse_m"].get<double>(), 0.5);
  const auto none = colonnade("baseline dead-reckoning c.rawlog -o d");
  EXPECT_EQ(1, none.exit_code);
  EXPECT_NE(std::string::npos, none.err.find("no wheel odometry")) << none.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "d"));
}

}  // namespace
}  // namespace colonnade
