// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/frames/mrclam_import.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "colonnade/base/error.hpp"
#include "colonnade/base/trajectory.hpp"
#include "colonnade/frames/rawlog_source.hpp"
#include "shared_data.hpp"

namespace colonnade {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A small data set of its own in a folder that disappears with the test.
class MrclamImport : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "mrclam-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    write("Barcodes.dat", "# Subject # Barcode #\n 1 5\n 2 14\n 6 63\n 7 81\n");
    write("Landmark_Groundtruth.dat", "# s x y sx sy\n6 1.5 -2.5 0.001 0.002\n7 3 4 0.001 0.001\n");
    write("Robot1_Groundtruth.dat", "10.0 1 2 0.5\n10.5 1.1 2 0.6\n10.5 1.1 2 0.6\n11 1.2 2 0.7\n");
    write("Robot1_Odometry.dat", "10.0 0.2 0.0\n10.4 0.2 1.0\n10.8 0.0 0.0\n");
    write("Robot1_Measurement.dat",
          "# t b r b\n10.2 63 2.5 0.25\n10.2 14 1.0 0.0\n10.6 14 1.1 0.1\n11.0 81 3.5 -0.5\n"
          "11.0 63 2.0 0.75\n11.2 99 1.0 0.0\n");
    options_.folder = folder_;
    options_.log = folder_ / "robot1.rawlog";
    options_.calibration = MrclamCalibration::asRecorded();
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  std::string refusal() const {
    try {
      importMrclam(options_);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  /// rms of how far the heading by odometry drifts in 30 s.
  static double headingDrift(const fs::path& truth_file, const fs::path& log) {
    const Trajectory truth = readTum(truth_file);
    std::vector<std::pair<double, double>> off;  // stamp, heading by odometry minus true one
    RawlogSource source(log);
    while (const auto frame = source.next()) {
      const auto at = std::lower_bound(
          truth.begin(), truth.end(), frame->stamp_s,
          [](const StampedPose& pose, double stamp_s) { return pose.stamp_s < stamp_s; });
      if (at == truth.end() || at->stamp_s - frame->stamp_s > 0.05) continue;
      off.emplace_back(frame->stamp_s,
                       frame->odometry->T_odom_robot.phi - planarPart(at->T_world_body).phi);
    }
    double sum = 0.0;
    std::size_t count = 0, later = 0;
    for (const auto& [stamp_s, angle] : off) {
      while (later < off.size() && off[later].first < stamp_s + 30.0) ++later;
      if (later == off.size()) break;
      const double drift = wrapAngle(off[later].second - angle);
      sum += drift * drift;
      ++count;
    }
    return std::sqrt(sum / static_cast<double>(count));
  }

  fs::path folder_;
  MrclamImportOptions options_;
};

TEST_F(MrclamImport, OneSensoryFrameForEachStampWithSubjectsAsIdentities) {
  const auto result = importMrclam(options_);
  EXPECT_EQ(result.frames, 4u);
  EXPECT_EQ(result.readings, 3u);
  EXPECT_EQ(result.robot_readings.at(2), 2u);
  EXPECT_EQ(result.unknown_barcodes.at(99), 1u);
  ASSERT_EQ(result.landmarks.size(), 2u);
  EXPECT_EQ(result.ground_truth_poses, 3u);
  EXPECT_EQ(readTum(folder_ / "robot1_ground_truth.tum").size(), 3u);

  RawlogSource source(options_.log);
  std::vector<Frame> frames;
  while (auto frame = source.next()) frames.push_back(*frame);
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_NEAR(frames[0].stamp_s, 10.2, 1e-6);
  EXPECT_NEAR(frames[3].stamp_s, 11.2, 1e-6);
  ASSERT_TRUE(frames[2].range_bearing);
  const auto& scan = *frames[2].range_bearing;
  ASSERT_EQ(scan.readings.size(), 2u);
  EXPECT_EQ(scan.readings[0].id, 7);
  EXPECT_NEAR(scan.readings[0].range_m, 3.5, 1e-6);
  EXPECT_NEAR(scan.readings[0].yaw, -0.5, 1e-6);
  EXPECT_NEAR(scan.range_sigma_m, options_.range_sigma_m, 1e-6);
  EXPECT_NEAR(scan.yaw_sigma, options_.bearing_sigma, 1e-6);
  EXPECT_TRUE(frames[1].range_bearing->readings.empty());
}

TEST_F(MrclamImport, IntegratesWheelSpeedsAsArcs) {
  importMrclam(options_);
  RawlogSource source(options_.log);
  std::vector<Pose2> poses;
  Eigen::Matrix3d covariance;  // of the second frame
  while (auto frame = source.next()) {
    poses.push_back(frame->odometry->T_odom_robot);
    if (poses.size() == 2) covariance = frame->odometry->increment_covariance.value();
  }
  ASSERT_EQ(poses.size(), 4u);
  ArcSum half{options_.odometry};
  half.add(0.2, 0.0, 0.2);
  half.add(0.2, 1.0, 0.2);
  EXPECT_TRUE(covariance.isApprox(half.covariance(), 1e-9)) << covariance;
  // 0.2 s straight, 0.2 s on a circle of 0.2 m; then 0.2 s more of it and rest.
  const Pose2 first = poses[0].inverse() * poses[1];
  EXPECT_NEAR(first.x, 0.04 + 0.2 * std::sin(0.2), 1e-9);
  EXPECT_NEAR(first.y, 0.2 * (1.0 - std::cos(0.2)), 1e-9);
  EXPECT_NEAR(first.phi, 0.2, 1e-9);
  const Pose2 whole = poses[0].inverse() * poses[3];
  EXPECT_NEAR(whole.x, 0.04 + 0.2 * std::sin(0.4), 1e-9);
  EXPECT_NEAR(whole.phi, 0.4, 1e-9);
}

TEST_F(MrclamImport, TurnsCommandsIntoMotionAndBarcodeHeightsIntoRanges) {
  MrclamCalibration& c = options_.calibration;
  c = MrclamCalibration{};
  c.drive_delay_s = 0.1;
  c.camera_delay_s = 0.05;
  importMrclam(options_);
  RawlogSource source(options_.log);
  std::vector<Frame> frames;
  while (auto frame = source.next()) frames.push_back(*frame);
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_NEAR(frames[0].stamp_s, 10.2, 1e-6);  // stamps stay those of the data set
  // From 10.2 to 10.55 straight with the first command, then 0.4 s turning with the second, which
  // slows the robot down and begins once the command has run up a little, then rest.
  const Pose2 whole = frames[0].odometry->T_odom_robot.inverse() * frames[3].odometry->T_odom_robot;
  const double meant = 1.0 - c.turn_offset;
  const double idle_s = c.breakaway_on_the_way / meant;
  const double speed_m_s = c.speed_gain * 0.2 - c.slowed_by_turn * meant;
  const double straight_m = 0.35 * c.speed_gain * 0.2 + idle_s * speed_m_s;
  const double turn = (0.4 - idle_s) * c.turn_gain * meant;
  const double radius_m = speed_m_s / (c.turn_gain * meant);
  EXPECT_NEAR(whole.phi, turn, 1e-9);
  EXPECT_NEAR(whole.x, straight_m + radius_m * std::sin(turn), 1e-9);
  EXPECT_NEAR(whole.y, radius_m * (1.0 - std::cos(turn)), 1e-9);
  // A landmark 0.75 rad beside the axis is farther away than its depth.
  const RangeBearing& beside = frames[2].range_bearing->readings[1];
  EXPECT_NEAR(beside.range_m, (2.0 - c.depth_offset_m) / c.depth_gain / std::cos(0.75), 1e-6);
  EXPECT_NEAR(beside.yaw, 0.75, 1e-6);
}

/// The turn of the robot over the whole log of these commands.
class MrclamTurns : public MrclamImport {
 protected:
  double turnUnder(const std::string& commands) {
    write("Robot1_Odometry.dat", commands);
    write("Robot1_Measurement.dat", "10 63 2.5 0.25\n20 63 2.5 0.25\n");
    options_.calibration = MrclamCalibration{};
    options_.log = folder_ / ("turns" + std::to_string(++logs_) + ".rawlog");
    importMrclam(options_);
    RawlogSource source(options_.log);
    const Pose2 start = source.next()->odometry->T_odom_robot;
    return (start.inverse() * source.next()->odometry->T_odom_robot).phi;
  }
  const MrclamCalibration c_;
  int logs_ = 0;
};

TEST_F(MrclamTurns, RecordsToTheLeftAndRightDifferButTheTurnsDoNot) {
  const double left = turnUnder("10 0.1 0.3\n12 0 0\n");
  const double right =
      turnUnder("10 0.1 " + std::to_string(2.0 * c_.turn_offset - 0.3) + "\n12 0 0\n");
  EXPECT_NEAR(left, -right, 1e-6);
  EXPECT_NEAR(left, c_.turn_gain * (2.0 * (0.3 - c_.turn_offset) - c_.breakaway_on_the_way), 1e-6);
  EXPECT_NEAR(turnUnder("10 0.1 0.0\n12 0 0\n"), 0.0, 1e-9);
}

TEST_F(MrclamTurns, WideArcsAreOneAndTheSame) {
  EXPECT_NEAR(turnUnder("10 0.067 0.02\n12 0 0\n"), 2.0 * c_.least_turn_rate, 1e-9);
  EXPECT_NEAR(turnUnder("10 0.067 0.04\n12 0 0\n"), 2.0 * c_.least_turn_rate, 1e-9);
  EXPECT_NEAR(turnUnder("10 0.067 0.002\n12 0 0\n"), -2.0 * c_.least_turn_rate, 1e-9);
}

TEST_F(MrclamTurns, OnTheSpotEveryStartCostsTheSameAngle) {
  const double meant = 0.4 - c_.turn_offset;
  const double once = turnUnder("10 0 0.4\n12 0 0\n");
  EXPECT_NEAR(once, c_.turn_gain_on_spot * (2.0 * meant - c_.breakaway_on_spot), 1e-6);
  // A flicker of the log is no new start, a pause is one, and so is the other direction.
  const double missing = c_.turn_gain_on_spot * meant;
  EXPECT_NEAR(turnUnder("10 0 0.4\n11 0 0\n11.05 0 0.4\n12 0 0\n"), once - 0.05 * missing, 1e-6);
  EXPECT_NEAR(turnUnder("10 0 0.4\n11 0 0\n11.5 0 0.4\n12 0 0\n"),
              once - 0.5 * missing - c_.turn_gain_on_spot * c_.breakaway_on_spot, 1e-6);
  const std::string back = std::to_string(2.0 * c_.turn_offset - 0.4);
  EXPECT_NEAR(turnUnder("10 0 0.4\n11 0 " + back + "\n12 0 0\n"), 0.0, 1e-6);
  EXPECT_NEAR(turnUnder("10 0 0.02\n11 0 0\n"), 0.0, 1e-9) << "never gets going";
}

TEST_F(MrclamImport, CalibrationBringsRobotsItWasNotMadeFromNearerToTheTruth) {
  COLONNADE_REQUIRE_RECORDING(data, "mrclam7");
  options_.folder = data;
  for (const int robot : {4, 5}) {
    options_.robot = robot;
    const auto recorded = importMrclam(options_);
    const double recorded_drift = headingDrift(recorded.ground_truth, options_.log);
    options_.calibration = MrclamCalibration{};
    options_.log = folder_ / ("calibrated" + std::to_string(robot) + ".rawlog");
    const auto calibrated = importMrclam(options_);
    const double drift = headingDrift(calibrated.ground_truth, options_.log);
    options_.calibration = MrclamCalibration::asRecorded();
    options_.log = folder_ / ("recorded" + std::to_string(robot + 1) + ".rawlog");
    const Trajectory truth = readTum(calibrated.ground_truth);
    // Standing still, motion capture trembles by less than this between poses 0.5 s apart.
    double way_m = 0.0;
    Eigen::Vector3d last = truth.front().T_world_body.translation();
    for (const StampedPose& pose : truth)
      if ((pose.T_world_body.translation() - last).norm() > 0.02) {
        way_m += (pose.T_world_body.translation() - last).norm();
        last = pose.T_world_body.translation();
      }
    EXPECT_NEAR(calibrated.path_m / way_m, 1.0, 0.03) << robot;
    EXPECT_GT(recorded.path_m / way_m, 1.05) << robot;
    EXPECT_LT(drift, 0.9 * recorded_drift) << robot;
  }
}

TEST_F(MrclamImport, CovarianceDoesNotDependOnHowAnArcIsCut) {
  WheelSpeedNoise noise;
  ArcSum once(noise), often(noise);
  once.add(0.3, 0.4, 2.0);
  for (int i = 0; i < 2000; ++i) often.add(0.3, 0.4, 0.001);
  EXPECT_NEAR(once.motion().x, often.motion().x, 1e-9);
  EXPECT_NEAR(once.covariance()(2, 2), often.covariance()(2, 2), 1e-9);
  EXPECT_NEAR(once.covariance()(0, 0) / often.covariance()(0, 0), 1.0, 0.15);
  // A heading that walks randomly shifts the end across, which one piece cannot tell.
  EXPECT_GT(often.covariance()(1, 1), once.covariance()(1, 1));
}

TEST_F(MrclamImport, SameInputSameBytes) {
  importMrclam(options_);
  const auto bytes = [](const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string first = bytes(options_.log);
  options_.log = folder_ / "again.rawlog";
  importMrclam(options_);
  EXPECT_EQ(first, bytes(options_.log));
}

TEST_F(MrclamImport, NamesFileAndLineOfWhatCannotBeRead) {
  write("Robot1_Measurement.dat", "# t b r b\n10.2 63 2.5 0.25\n10.3 63 2.5\n");
  EXPECT_THAT(refusal(),
              HasSubstr("Robot1_Measurement.dat:3: expected `time barcode range bearing`"));
  write("Robot1_Measurement.dat", "10.2 63 nan 0.25\n");
  EXPECT_THAT(refusal(), HasSubstr("Robot1_Measurement.dat:1: `nan`"));
  write("Robot1_Measurement.dat", "10.2 63 1 0.25\n10.1 63 1 0.25\n");
  EXPECT_THAT(refusal(), HasSubstr("Robot1_Measurement.dat:2: stamp 10.100 goes back"));
  write("Robot1_Measurement.dat", "# nothing\n");
  EXPECT_THAT(refusal(), HasSubstr("holds no line"));
  fs::remove(folder_ / "Robot1_Measurement.dat");
  EXPECT_THAT(refusal(), HasSubstr("Robot1_Measurement.dat: No such file"));
  write("Robot1_Measurement.dat", "10.2 63 2.5 0.25\n");
  write("Barcodes.dat", "6 63\n7 63\n");
  EXPECT_THAT(refusal(), HasSubstr("Barcodes.dat:2: barcode 63 stands twice"));
  EXPECT_FALSE(fs::exists(options_.log));
}

TEST_F(MrclamImport, RealRobot) {
  COLONNADE_REQUIRE_RECORDING(data, "mrclam7");
  options_.folder = data;
  options_.robot = 4;
  const auto result = importMrclam(options_);
  EXPECT_EQ(result.frames, 1463u);
  EXPECT_EQ(result.readings, 1822u);
  EXPECT_EQ(result.landmarks.size(), 15u);
  EXPECT_NEAR(result.path_m, 37.1, 0.3);  // chords between stamps of 38.4 m of arcs
}

}  // namespace
}  // namespace colonnade
