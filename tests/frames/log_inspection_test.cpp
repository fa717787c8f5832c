// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/frames/log_inspection.hpp"

#include <gtest/gtest.h>

#include "log_helpers.hpp"
#include "shared_data.hpp"

namespace colonnade {
namespace {

using testing::record;
using testing::TemporaryFolder;

TEST(Inspection, TellsSensorsRatesSizesAndGaps) {
  const TemporaryFolder folder;
  {
    RawlogWriter writer(folder / "a.rawlog", {.camera_label = "XTION"});
    for (const int i : {0, 1, 2, 3, 4, 12, 13, 14, 20, 21}) writer.add(record(i));
    writer.finish();
  }
  const auto log = inspectLog(folder / "a.rawlog");
  EXPECT_STREQ(log.format(), "list");
  EXPECT_TRUE(log.compressed);
  EXPECT_TRUE(log.hasOdometry());
  EXPECT_FALSE(log.damage.any());
  ASSERT_EQ(log.sensors.size(), 2U);
  EXPECT_EQ(log.sensors[0].label, "ODOMETRY");
  const auto& camera = log.sensors[1];
  EXPECT_EQ(camera.label, "XTION");
  EXPECT_EQ(camera.class_name, "CObservation3DRangeScan");
  EXPECT_EQ(camera.count, 10U);
  EXPECT_NEAR(camera.rate_hz(), 10.0, 1e-3);
  EXPECT_EQ(camera.gap_count, 2U);
  ASSERT_EQ(camera.longest_gaps.size(), 2U);
  EXPECT_NEAR(camera.longest_gaps[0].length_s, 0.8, 1e-6);
  EXPECT_NEAR(camera.longest_gaps[0].start_s, 1700000000.4, 1e-6);
  ASSERT_TRUE(camera.colour && camera.depth);
  EXPECT_EQ(camera.colour->width_px, 64);
  EXPECT_EQ(camera.depth->calibration.fy_px, 61.0);
  EXPECT_NEAR(camera.depth_unit_m, 1.0 / 5000.0, 1e-10);
  EXPECT_NEAR(camera.colour->T_robot_camera.translation().z(), 0.7, 1e-9);
  EXPECT_NEAR(*log.last_s - *log.first_s, 2.1, 1e-6);
}

TEST(Inspection, CountsActionsAndReportsACut) {
  const TemporaryFolder folder;
  testing::writeLog(
      folder / "a.rawlog", 4,
      {.format = RawlogWriterOptions::Format::kActionSensoryFramePairs, .gz_level = 0});
  const auto bytes = testing::readFile(folder / "a.rawlog");
  ASSERT_GT(bytes.size(), 100U);
  testing::writeFile(folder / "cut.rawlog", testing::Bytes(bytes.begin(), bytes.end() - 100));
  const auto log = inspectLog(folder / "cut.rawlog");
  EXPECT_STREQ(log.format(), "pairs");
  EXPECT_EQ(log.action_collections, 4U);
  EXPECT_EQ(log.motions, 4U);
  EXPECT_EQ(log.sensory_frames, 3U);
  EXPECT_EQ(log.damage.ending, LogEnding::kCut);
  EXPECT_EQ(log.damage.ending_entry, 7U);
  EXPECT_TRUE(log.damage.any());
}

TEST(Inspection, ReadsMrptsRgbdExample) {
  COLONNADE_REQUIRE_RECORDING(path, "mrpt/tests_rgbd.rawlog");
  const auto log = inspectLog(path);
  ASSERT_EQ(log.sensors.size(), 1U);
  EXPECT_EQ(log.sensors[0].label, "OPENNI2");
  ASSERT_TRUE(log.sensors[0].colour);
  EXPECT_TRUE(log.sensors[0].colour->distorted);
  EXPECT_EQ(log.sensors[0].colour->width_px, 640);
  EXPECT_FALSE(log.hasOdometry());
}

}  // namespace
}  // namespace colonnade
