// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <opencv2/core/types.hpp>

#include "program.hpp"

namespace colonnade::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using AcceleratorVerb = ProgramTest;

TEST_F(AcceleratorVerb, ReportsEveryFigureAsJson) {
  const auto outcome = colonnade("accelerator report --json -o figures");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(outcome.out, contentOf(folder_ / "figures/accelerator.json"));
  for (const char* figure : {"figure_53", "figure_61", "figure_67"}) {
    for (const char* side : {"thesis", "ours"})
      EXPECT_TRUE(json[figure].contains(side)) << figure << " " << side;
  }
  for (const char* figure : {"figure_53", "figure_61", "figure_67", "whole"}) {
    for (const char* family : {"xc6s", "xc7"}) EXPECT_TRUE(json[figure].contains(family)) << figure;
  }
  // What was asked of the thesis' configuration, on the RTL as committed.
  const auto total = [&](const char* key) {
    return json["figure_53"]["xc6s"][key].get<int>() + json["figure_67"]["xc6s"][key].get<int>();
  };
  EXPECT_LE(total("lut") + total("shift_register_lut"), 3000);
  EXPECT_LE(total("flip_flop"), 2500);
  EXPECT_EQ(total("dsp"), 0);
  EXPECT_LE(json["whole"]["xc6s"]["lut"], 4000);
  EXPECT_LE(json["whole"]["xc6s"]["flip_flop"], 3500);
  EXPECT_EQ(json["whole"]["xc6s"]["dsp"], 0);
  EXPECT_GE(json["clock_rate"]["canny"]["median_mhz"], 150.0);
  EXPECT_GE(json["clock_rate"]["image_stage"]["median_mhz"], 90.0);
  ASSERT_EQ(json["figure_72"]["ours"].size(), 3U);
  for (const auto& times : json["figure_72"]["ours"]) EXPECT_GT(times["fixed_ms"], 0.0);
  ASSERT_EQ(json["figure_73"]["ours"].size(), 4U);
  for (const auto& times : json["figure_73"]["ours"]) {
    EXPECT_LT(times["canny_clocks"], times["clocks"]);
    EXPECT_LE(times["clocks_after_last_pixel"], times["clocks_after_last_pixel_at_most"].get<int>() +
                                                    times["lines_that_wait"].get<int>());
    const cv::Size size = times["size"] == "120x120"   ? cv::Size(120, 120)
                          : times["size"] == "320x240" ? cv::Size(320, 240)
                                                       : cv::Size(640, 480);
    EXPECT_EQ(times["sustained_clocks_per_frame"],
              size.area() / times["pixels_per_clock"].get<int>());
    if (times["size"] != "120x120") continue;
    const int per_clock = times["pixels_per_clock"];
    EXPECT_LE(times["clocks"], per_clock == 1 ? 15400 : 4400);
    EXPECT_LE(times["clocks_after_last_pixel"], 1000);
    EXPECT_LE(times["clocks_after_last_pixel"], times["clocks_after_last_pixel_at_most"]);
  }
  EXPECT_THAT(contentOf(folder_ / "figures/accelerator.md"), HasSubstr("**Figure 73**"));
}

TEST_F(AcceleratorVerb, RunsALogAndSaysWhatABoardWouldTake) {
  const auto outcome = colonnade("accelerator run " + corridor().string() +
                                 " --every 50 --max-frames 3 --clock-mhz 50");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("3 of 320x240, edges and lines of each equal to fixed"));
  EXPECT_THAT(outcome.out, HasSubstr("at 50 MHz"));
  EXPECT_THAT(outcome.out, HasSubstr("times fixed on average"));
}

TEST_F(AcceleratorVerb, RefusesWhatNoModelTakes) {
  const auto size = colonnade("accelerator run " + corridor().string() + " --size 200x200");
  EXPECT_EQ(size.exit_code, 2);
  EXPECT_THAT(size.err, HasSubstr("320x240"));
  EXPECT_EQ(colonnade("accelerator run nothing.rawlog").exit_code, 1);
  EXPECT_EQ(colonnade("accelerator run " + corridor().string() + " --clock-mhz 0").exit_code, 2);
  EXPECT_EQ(colonnade("accelerator report --image nothing.png").exit_code, 2);
}

TEST_F(AcceleratorVerb, TheMapIsThatOfFixedByteForByte) {
  // COLONNADE_RTL_LOG=rawlogs/corridor.rawlog for the whole sample log, a minute of one core.
  const char* wanted = std::getenv("COLONNADE_RTL_LOG");
  const auto log = wanted ? sourceFolder() / wanted : folder_ / "hall.rawlog";
  if (!wanted) {
    std::ofstream(folder_ / "hall.world")
        << "room hall -1 -1  4 -1  4 1  -1 1  hallway=0\npilaster wall=hall.1 at_m=2.6\n"
           "camera width_px=320 height_px=240 rate_hz=5\nstart 0 0 heading_deg=0\n"
           "drive 1.6 0 speed_m_per_s=0.8\n";
    const auto outcome = colonnade("simulate hall.world -o hall.rawlog");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  for (const char* backend : {"fixed", "rtl"}) {
    const auto outcome =
        colonnade("run " + log.string() + " --backend " + backend + " -o " + backend);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    if (std::string(backend) == "rtl") {
      // Its answers are those of the CPU in any case: that the device gave them stands in the notes.
      const auto summary =
          nlohmann::json::parse(contentOf(folder_ / "rtl/summary.json"));
      EXPECT_THAT(outcome.err, HasSubstr("rtl: " + summary["frames_processed"].dump() + " frames of "));
      EXPECT_THAT(outcome.err, HasSubstr("equal to fixed"));
      EXPECT_THAT(outcome.err, Not(HasSubstr("answered by the CPU")));
    }
  }
  for (const char* file : {"landmarks.csv", "trajectory.tum", "map.simplemap", "map.gridmap.gz",
                           "map.landmarksmap.gz", "map.3Dscene", "map.metricmap.gz"}) {
    const std::string expected = contentOf(folder_ / "fixed" / file);
    EXPECT_FALSE(expected.empty()) << file;
    EXPECT_TRUE(contentOf(folder_ / "rtl" / file) == expected) << file;
  }
}

}  // namespace
}  // namespace colonnade::testing
