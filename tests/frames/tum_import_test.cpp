// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/frames/tum_import.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/base/log_path.hpp"
#include "colonnade/base/trajectory.hpp"
#include "log_helpers.hpp"
#include "shared_data.hpp"

namespace colonnade {
namespace {

using testing::readLog;
using testing::TemporaryFolder;

void writeText(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path) << text;
}

/// Three pairs of noise, colour as PNG, and a calibration.
class TumFolder {
 public:
  TumFolder() {
    std::filesystem::create_directories(folder_ / "in/rgb");
    std::filesystem::create_directories(folder_ / "in/depth");
    std::string rgb = "# timestamp filename\n", depth = rgb;
    for (int i = 0; i < 3; ++i) {
      const std::string stamp = std::to_string(100 + i);
      cv::imwrite((path() / ("rgb/" + stamp + ".png")).string(), testing::texture(i));
      cv::imwrite((path() / ("depth/" + stamp + ".png")).string(), testing::depthUnits(i));
      rgb += stamp + ".0 rgb/" + stamp + ".png\n";
      depth += stamp + ".015 depth/" + stamp + ".png\n";
    }
    writeText(path() / "rgb.txt", rgb);
    writeText(path() / "depth.txt", depth);
    writeText(path() / "calibration.txt",
              "# pinhole\nfx 60\nfy 61\ncx 31\ncy 24.5\ndepth_units_per_metre 2000\n");
  }
  std::filesystem::path path() const { return folder_ / "in"; }
  std::filesystem::path log() const { return folder_ / "out.rawlog"; }
  TumImportOptions options() const {
    TumImportOptions options;
    options.folder = path();
    options.log = log();
    options.camera_height_m = 1.25;
    options.camera_pitch = 0.2;
    options.camera_roll = 0.0;
    return options;
  }

 private:
  TemporaryFolder folder_;
};

std::string usageError(const TumImportOptions& options) {
  try {
    importTum(options);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage) << error.what();
    return error.what();
  }
  return "";
}

TEST(TumImport, KeepsPixelsAndDepthValues) {
  const TumFolder tum;
  const auto result = importTum(tum.options());
  EXPECT_EQ(result.frames, 3U);
  EXPECT_TRUE(result.skipped.empty());
  EXPECT_FALSE(result.mounting_from_floor);
  const auto read = readLog(tum.log());
  ASSERT_EQ(read.frames.size(), 3U);
  for (int i = 0; i < 3; ++i) {
    const auto& frame = read.frames[static_cast<std::size_t>(i)];
    EXPECT_EQ(frame.stamp_s, 100.0 + i) << "the stamp of the colour image";
    EXPECT_EQ(cv::norm(frame.colour, testing::texture(i), cv::NORM_INF), 0.0);
    cv::Mat units;
    frame.depth_m.convertTo(units, CV_16U, 2000.0);
    EXPECT_EQ(cv::norm(units, testing::depthUnits(i), cv::NORM_INF), 0.0);
    EXPECT_NEAR(frame.T_robot_camera.translation().z(), 1.25, 1e-12);
    EXPECT_NEAR(-std::asin(frame.T_robot_camera.linear()(2, 2)), 0.2, 1e-9);
  }
}

TEST(TumImport, CountsPairsWhoseFilesAreMissing) {
  const TumFolder tum;
  std::filesystem::remove(tum.path() / "rgb/101.png");
  testing::writeFile(tum.path() / "depth/102.png", {1, 2, 3});
  const auto result = importTum(tum.options());
  EXPECT_EQ(result.frames, 1U);
  EXPECT_EQ(result.skipped.at("colour file missing"), 1U);
  EXPECT_EQ(result.skipped.at("depth file unreadable"), 1U);
}

TEST(TumImport, LeavesOutImagesWithoutPartner) {
  const TumFolder tum;
  writeText(tum.path() / "depth.txt", "100.019 depth/100.png\n101.021 depth/101.png\n");
  const auto result = importTum(tum.options());
  EXPECT_EQ(result.frames, 1U);
  EXPECT_EQ(result.colour_without_depth, 2U);
  EXPECT_EQ(result.depth_without_colour, 1U);
}

TEST(TumImport, AsksForWhatItCannotKnow) {
  const TumFolder tum;
  auto options = tum.options();
  options.camera_pitch.reset();
  EXPECT_NE(usageError(options).find("--camera-height"), std::string::npos) << "noise has no floor";
  std::filesystem::remove(tum.path() / "calibration.txt");
  EXPECT_NE(usageError(tum.options()).find("--intrinsics"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(tum.log()));
}

TEST(TumImport, NamesTheLineOfAWrongCalibration) {
  const TumFolder tum;
  writeText(tum.path() / "calibration.txt", "fx 60\nfy 61\nk1 0.1\n");
  const auto unknown = usageError(tum.options());
  EXPECT_NE(unknown.find("calibration.txt:3: unknown key k1"), std::string::npos) << unknown;
  writeText(tum.path() / "calibration.txt", "fx 60\nfy 61\ncx 31\n");
  EXPECT_NE(usageError(tum.options()).find("cy is missing"), std::string::npos);
}

TEST(TumImport, GroundTruthBecomesTheRobotOnTheFloor) {
  const TumFolder tum;
  // A camera 1.5 m up that looks along the world's y axis, 30 degrees down (z-up world).
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  StampedPose camera;
  camera.stamp_s = 100.0;
  camera.T_world_body.linear() = Eigen::AngleAxisd(radians(90), Eigen::Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(radians(30), Eigen::Vector3d::UnitY()) * axes;
  camera.T_world_body.translation() << 2.0, 3.0, 1.5;
  writeTum(tum.path() / "groundtruth.txt", {camera});
  const auto result = importTum(tum.options());
  ASSERT_TRUE(result.ground_truth);
  EXPECT_EQ(result.ground_truth_world, GroundTruthWorld::kZUp);
  EXPECT_EQ(result.ground_truth->filename(), "out_ground_truth.tum");
  const auto robot = readTum(*result.ground_truth);
  ASSERT_EQ(robot.size(), 1U);
  EXPECT_TRUE(robot[0].T_world_body.isApprox(Pose2{2.0, 3.0, radians(90)}.toIsometry3(), 1e-6));
}

TEST(TumImport, AFirstCameraWorldIsLevelledByTheMounting) {
  const TumFolder tum;
  // The camera looks 0.2 rad down and moves 1 m ahead over level ground: in the first camera's
  // axes that is forward and up.
  StampedPose first, second;
  first.stamp_s = 100.0;
  second.stamp_s = 101.0;
  second.T_world_body.translation() << 0.0, -std::sin(0.2), std::cos(0.2);
  writeTum(tum.path() / "reference.tum", {first, second});
  const auto result = importTum(tum.options());
  EXPECT_EQ(result.ground_truth_world, GroundTruthWorld::kFirstCamera);
  const auto robot = readTum(*result.ground_truth);
  ASSERT_EQ(robot.size(), 2U);
  EXPECT_TRUE(robot[0].T_world_body.isApprox(Eigen::Isometry3d::Identity(), 1e-6));
  EXPECT_TRUE(robot[1].T_world_body.isApprox(Pose2{1.0, 0.0, 0.0}.toIsometry3(), 1e-6));
}

TEST(TumImport, APartOfAReferenceIsLevelledAsTheWholeIs) {
  const TumFolder tum;
  // The world is a camera of before the first pose, which looked 0.2 rad down as this one does.
  StampedPose first, second;
  first.stamp_s = 100.0;
  second.stamp_s = 101.0;
  first.T_world_body.translation() << 0.5, 0.0, 0.0;
  second.T_world_body.translation() << 0.5, -std::sin(0.2), std::cos(0.2);
  writeTum(tum.path() / "reference.tum", {first, second});
  const auto result = importTum(tum.options());
  EXPECT_EQ(result.ground_truth_world, GroundTruthWorld::kFirstCamera);
  const auto robot = readTum(*result.ground_truth);
  ASSERT_EQ(robot.size(), 2U);
  EXPECT_TRUE(robot[0].T_world_body.isApprox(Pose2{0.0, -0.5, 0.0}.toIsometry3(), 1e-6));
  EXPECT_TRUE(robot[1].T_world_body.isApprox(Pose2{1.0, -0.5, 0.0}.toIsometry3(), 1e-6));
}

TEST(TumImport, StemsDropBothEndings) {
  EXPECT_EQ(logStem("a/b.rawlog"), "a/b");
  EXPECT_EQ(logStem("a/b.rawlog.gz"), "a/b");
  EXPECT_EQ(logStem("a.b/c.d.rawlog"), "a.b/c.d");
}

TEST(TumImport, TheCorridorRecordingKeepsEveryDepthValue) {
  COLONNADE_REQUIRE_RECORDING(corridor, "corridor_xtion");
  const TemporaryFolder folder;
  TumImportOptions options;
  options.folder = corridor;
  options.log = folder / "corridor.rawlog";
  options.gz_level = 1;
  const auto result = importTum(options);
  EXPECT_EQ(result.frames, 120U);
  EXPECT_TRUE(result.skipped.empty());
  EXPECT_TRUE(result.mounting_from_floor);
  EXPECT_NEAR(result.T_robot_camera.translation().z(), 1.3, 0.15);
  EXPECT_EQ(result.ground_truth_world, GroundTruthWorld::kFirstCamera);
  EXPECT_LT(std::filesystem::file_size(options.log), 27'000'000U) << "larger than the folder";

  RawlogSource source(options.log);
  std::size_t frames = 0;
  while (const auto frame = source.next()) {
    char name[64];
    std::snprintf(name, sizeof name, "%017.6f", frame->stamp_s);
    const cv::Mat depth = cv::imread((corridor / "depth" / (std::string(name) + ".png")).string(),
                                     cv::IMREAD_UNCHANGED);
    const cv::Mat colour =
        cv::imread((corridor / "rgb" / (std::string(name) + ".jpg")).string(), cv::IMREAD_COLOR);
    ASSERT_FALSE(depth.empty()) << name;
    cv::Mat units;
    frame->depth_m.convertTo(units, CV_16U, 1000.0);
    ASSERT_EQ(cv::norm(units, depth, cv::NORM_INF), 0.0) << name;
    ASSERT_LE(cv::norm(frame->colour, colour, cv::NORM_INF), 4.0) << "decoders may differ a little";
    ++frames;
  }
  EXPECT_EQ(frames, 120U);
  EXPECT_FALSE(source.damage().any());

  // Levelled by the floor, the walk of the reference stays in the plane: its path keeps its length.
  const auto cameras = readTum(corridor / "reference.tum");
  const auto robots = readTum(*result.ground_truth);
  ASSERT_EQ(robots.size(), cameras.size());
  double camera_path = 0.0, robot_path = 0.0;
  for (std::size_t i = 1; i < robots.size(); ++i) {
    camera_path +=
        (cameras[i].T_world_body.translation() - cameras[i - 1].T_world_body.translation()).norm();
    robot_path +=
        (robots[i].T_world_body.translation() - robots[i - 1].T_world_body.translation()).norm();
  }
  EXPECT_GT(robot_path, 0.98 * camera_path);
  const auto last = planarPart(robots.back().T_world_body);
  EXPECT_NEAR(degrees(last.phi), 75.0, 4.0) << "one left turn of 75 degrees";
}

}  // namespace
}  // namespace colonnade
