// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "colonnade/base/text.hpp"
#include "program.hpp"

namespace colonnade {
namespace {

using testing::contentOf;

class Detect : public testing::ProgramTest {
 protected:
  static std::vector<std::vector<std::string>> table(const std::filesystem::path& path) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(contentOf(path));
    for (std::string line; std::getline(lines, line);) rows.push_back(fields(line, ','));
    return rows;
  }
  const std::string camera_ =
      " --set Camera.fx_px=525 --set Camera.fy_px=525 --set Camera.cx_px=319.5"
      " --set Camera.cy_px=239.5 --set Camera.height_m=1.1 --set Camera.tilt=given";
};

TEST_F(Detect, WritesATableOfEveryFrameAndPicturesOfSome) {
  ASSERT_EQ(0,
            colonnade("detect " + corridor().string() + " -o seen --picture-every 100").exit_code);
  const auto rows = table(folder_ / "seen/detections.csv");
  ASSERT_GT(rows.size(), 500U);
  std::set<std::string> frames, kinds;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    ASSERT_EQ(rows[0].size(), rows[i].size()) << "row " << i;
    frames.insert(rows[i][1]);
    kinds.insert(rows[i][3]);
  }
  const auto told = nlohmann::json::parse(contentOf(folder_ / "seen/detect.json"));
  EXPECT_EQ(told["frames"].get<std::size_t>(), frames.size());
  EXPECT_EQ((std::set<std::string>{"depth_slope", "floor_edge", "pillar"}), kinds);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "seen/frame_00100.jpg"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "seen/frame_00101.jpg"));
}

TEST_F(Detect, TakesOnePictureWhoseCameraIsDescribed) {
  cv::Mat picture(480, 640, CV_8UC1, cv::Scalar(90));
  picture(cv::Rect(300, 0, 60, 400)).setTo(200);
  cv::imwrite((folder_ / "pillar.png").string(), picture);
  ASSERT_EQ(0, colonnade("detect pillar.png -o seen" + camera_).exit_code);
  int edges = 0;
  for (const auto& row : table(folder_ / "seen/detections.csv"))
    if (row[3] == "pillar" && row[4].empty()) {
      ++edges;
      EXPECT_LT(std::min(std::abs(std::stod(row[5]) - 299.5), std::abs(std::stod(row[5]) - 359.5)),
                0.6);
    }
  EXPECT_EQ(2, edges);
}

TEST_F(Detect, SaysWhatAPictureLacks) {
  cv::imwrite((folder_ / "plain.png").string(), cv::Mat(480, 640, CV_8UC1, cv::Scalar(90)));
  const auto outcome = colonnade("detect plain.png -o seen");
  EXPECT_EQ(2, outcome.exit_code);
  EXPECT_NE(std::string::npos, outcome.err.find("height_m"));
  EXPECT_EQ(1, outcome.errorLines());
  std::ofstream(folder_ / "broken.png") << "no picture";
  EXPECT_EQ(1, colonnade("detect broken.png -o seen" + camera_).exit_code);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "seen"));
}

TEST_F(Detect, PlacesCornersAndFloorEdgesOfASimulatedCorridorHonestly) {
  ASSERT_EQ(0, colonnade("simulate " +
                         (testing::sourceFolder() / "rawlogs/worlds/corridor.world").string() +
                         " -o walk.rawlog --rate 1.5")
                   .exit_code);
  // A simulated camera has none of the systematic errors that R covers otherwise.
  ASSERT_EQ(0, colonnade("detect walk.rawlog -o seen --picture-every 0 --score "
                         "--thesis-thresholds 0,30,300 --thesis-rows 12 "
                         "--set Geometry.tilt_sigma_deg=0 --set Geometry.height_sigma_m=0 "
                         "--set Geometry.depth_bias_per_m2=0")
                   .exit_code);
  const auto told = nlohmann::json::parse(contentOf(folder_ / "seen/detect.json"));
  const auto corners = told["measurements"]["depth_slope"];
  EXPECT_GE(corners["measured"].get<int>(), 90);
  EXPECT_GE(corners["precision"].get<double>(), 0.97);
  EXPECT_LE(corners["place_rms_m_at_2m"].get<double>(), 0.015);
  EXPECT_LE(corners["place_rms_m_at_3_7m"].get<double>(), 0.03);
  EXPECT_GE(corners["nees"].get<double>(), 0.5);
  EXPECT_LE(corners["nees"].get<double>(), 1.6);
  EXPECT_GE(told["score"]["depth_slope"]["precision"].get<double>(), 0.95);
  EXPECT_GE(told["score"]["depth_slope"]["recall"].get<double>(), 0.7);
  EXPECT_GE(told["score"]["floor_edge"]["precision"].get<double>(), 0.95);
  EXPECT_LE(told["measurements"]["floor_edge"]["place_rms_m_at_2m"].get<double>(), 0.03);
  // What the 2012 thesis claims: the higher the threshold, the better the landmarks.
  const auto& thresholds = told["thesis_thresholds"];
  ASSERT_EQ(3U, thresholds.size());
  EXPECT_LT(thresholds[0]["good_share"].get<double>(), thresholds[1]["good_share"].get<double>());
  EXPECT_LT(thresholds[1]["good_share"].get<double>(), thresholds[2]["good_share"].get<double>());
}

TEST_F(Detect, FindsTheEdgesOfABuildingAndFewOthers) {
  const auto world = testing::sourceFolder() / "rawlogs/worlds/ring.world";
  ASSERT_EQ(0, colonnade("simulate " + world.string() +
                         " -o ring.rawlog --width 640 --height 480 --rate 0.5 --seed 5")
                   .exit_code);
  for (const std::string stage : {"fixed", "opencv"}) {
    ASSERT_EQ(0, colonnade("detect ring.rawlog -o " + stage + " --backend " + stage +
                           " --score --track --picture-every 0")
                     .exit_code);
    const auto told = nlohmann::json::parse(contentOf(folder_ / stage / "detect.json"));
    const auto& pillars = told["score"]["pillar"];
    EXPECT_GT(pillars["wanted"].get<int>(), 20) << stage;
    EXPECT_GE(pillars["precision"].get<double>(), 0.90) << stage;
    EXPECT_GE(pillars["precision_wide"].get<double>(), 0.95) << stage;
    EXPECT_GE(pillars["recall"].get<double>(), 0.88) << stage;
    EXPECT_LE(pillars["offset_rms_px"].get<double>(), 0.5) << stage;
    EXPECT_GT(table(folder_ / stage / "tracks.csv").size(), 20U) << stage;
  }
}

TEST_F(Detect, LearnsTheShadeOfPillars) {
  cv::Mat picture(480, 640, CV_8UC3, cv::Scalar(90, 90, 90));
  picture(cv::Rect(200, 0, 60, 400)).setTo(cv::Scalar(30, 110, 230));
  picture(cv::Rect(400, 0, 60, 400)).setTo(cv::Scalar(200, 60, 40));
  cv::imwrite((folder_ / "pillars.png").string(), picture);
  ASSERT_EQ(
      0, colonnade("detect pillars.png -o seen --learn-shade 210,50,40,200" + camera_).exit_code);
  const auto edges = [&](const std::string& folder) {
    int count = 0;
    for (const auto& row : table(folder_ / folder / "detections.csv"))
      if (row[3] == "pillar" && row[4].empty()) {
        ++count;
        EXPECT_NEAR(std::stod(row[5]), 230.0, 35.0);
      }
    return count;
  };
  EXPECT_EQ(2, edges("seen"));
  ASSERT_EQ(0, colonnade("detect pillars.png -o again -c seen/config.ini").exit_code);
  EXPECT_EQ(2, edges("again"));
  EXPECT_EQ(1,
            colonnade("detect pillars.png -o no --learn-shade 630,50,40,200" + camera_).exit_code);
}

TEST_F(Detect, FollowsDoorFramesAndTheCornerOfARealCorridor) {
  COLONNADE_REQUIRE_RECORDING(recording, "corridor_xtion");
  ASSERT_EQ(0, colonnade("import tum " + recording.string() + " -o c.rawlog").exit_code);
  ASSERT_EQ(0, colonnade("detect c.rawlog -o seen --track --picture-every 0").exit_code);
  std::map<std::string, int> frames_of_track;
  std::map<std::pair<std::string, std::string>, std::string> track_of_detection;
  for (const auto& row : table(folder_ / "seen/tracks.csv")) {
    ++frames_of_track[row.at(3)];
    track_of_detection[{row.at(1), row.at(2)}] = row.at(3);
  }
  // In how many frames the edge is seen that stands at this column of half the picture's height.
  const auto framesOfEdge = [&](const std::string& frame, double u_px) {
    int most = 0;
    for (const auto& row : table(folder_ / "seen/detections.csv")) {
      const auto track = track_of_detection.find({row.at(1), row.at(2)});
      if (row[1] != frame || track == track_of_detection.end()) continue;
      const double u0 = std::stod(row[5]), v0 = std::stod(row[6]);
      const double u1 = std::stod(row[7]), v1 = std::stod(row[8]);
      if (std::abs(u0 + (u1 - u0) * (240.0 - v0) / (v1 - v0) - u_px) < 6.0)
        most = std::max(most, frames_of_track[track->second]);
    }
    return most;
  };
  EXPECT_GE(framesOfEdge("60", 101.0), 20);  // the door on the left: near side of its frame
  EXPECT_GE(framesOfEdge("60", 149.0), 20);  // far side
  EXPECT_GE(framesOfEdge("20", 496.0), 20);  // the recess on the right
  EXPECT_GE(framesOfEdge("20", 526.0), 20);  // the frame in it
  EXPECT_GE(framesOfEdge("90", 202.0), 20);  // where the blue wall ends
}

}  // namespace
}  // namespace colonnade
