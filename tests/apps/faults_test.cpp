// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <zlib.h>

#include "colonnade/frames/rawlog_source.hpp"
#include "colonnade/frames/rawlog_writer.hpp"
#include "program.hpp"

namespace colonnade {
namespace {

using testing::contentOf;

/// Bad input: the documented exit code, one line that says what and where, no results half done.
class Faults : public testing::ProgramTest {
 protected:
  void expectRefused(const std::string& arguments, int exit_code, const std::string& words) const {
    const auto outcome = colonnade(arguments);
    EXPECT_EQ(exit_code, outcome.exit_code) << arguments << "\n" << outcome.err;
    EXPECT_EQ(1, outcome.errorLines()) << arguments << "\n" << outcome.err;
    EXPECT_NE(std::string::npos, outcome.err.find(words)) << outcome.err;
  }
  void write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
  }
};

TEST_F(Faults, WhatIsNoLogIsRefused) {
  write("empty.rawlog", "");
  write("picture.rawlog", contentOf(testing::sourceFolder() / "rawlogs/corridor_floor.png"));
  std::filesystem::create_directory(folder_ / "folder.rawlog");
  expectRefused("run absent.rawlog", 1, "absent.rawlog");
  expectRefused("run empty.rawlog", 1, "empty");
  expectRefused("run picture.rawlog", 1, "not an MRPT rawlog");
  expectRefused("run folder.rawlog", 1, "folder.rawlog");
  expectRefused("inspect picture.rawlog", 1, "not an MRPT rawlog");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "picture_results"));
}

TEST_F(Faults, UsageErrorsAreExitTwo) {
  const std::string log = corridor().string();
  expectRefused("", 2, "--help");
  expectRefused("fly", 2, "--help");
  expectRefused("run", 2, "LOG");
  expectRefused("run " + log + " --set Filter.gate_probabilty=0.9", 2, "Filter.gate_probability");
  expectRefused("run " + log + " --set Filter.gate_probability=2", 2, "0.5 .. 0.999999");
  expectRefused("run " + log + " --backend gpu", 2, "gpu");
  expectRefused("run " + log + " -c absent.ini", 2, "absent.ini");
  expectRefused("run " + log + " --ground-truth absent.tum", 1, "absent.tum");
}

TEST_F(Faults, ALogWithoutImagesIsRefusedWithAWordOnWhatItHolds) {
  COLONNADE_REQUIRE_RECORDING(log, "mrpt/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog");
  expectRefused("run '" + log.string() + "' -o r", 1, "no camera images or depth");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "r"));
}

TEST_F(Faults, ACutLogGivesTheResultsOfItsWholePartAndExitThree) {
  const std::string whole = contentOf(corridor());
  write("cut.rawlog", whole.substr(0, whole.size() / 3));
  const auto outcome = colonnade("run cut.rawlog -o r");
  EXPECT_EQ(3, outcome.exit_code) << outcome.err;
  const auto s = summary("r");
  EXPECT_GT(s["frames_processed"].get<int>(), 30);
  EXPECT_EQ("cut", s["damage"]["ending"]);
  EXPECT_GT(s["damage"]["offset"].get<std::uint64_t>(), 0u);
  EXPECT_EQ(1, outcome.errorLines()) << outcome.err;
}

/// The uncompressed beginning of the corridor log, cut at a hundred places: every whole entry is
/// read, nothing crashes, and the ending tells a cut from an end.
TEST_F(Faults, AHundredCutsLoseOnlyWhatIsBehindThem) {
  gzFile file = gzopen(corridor().c_str(), "rb");
  ASSERT_NE(nullptr, file);
  std::string plain(600000, '\0');
  const int read = gzread(file, plain.data(), static_cast<unsigned>(plain.size()));
  gzclose(file);
  ASSERT_EQ(static_cast<int>(plain.size()), read);
  std::size_t entries_before = 0;
  for (std::size_t i = 1; i <= 100; ++i) {
    const std::size_t cut = i * plain.size() / 100;
    write("cut.rawlog", plain.substr(0, cut));
    RawlogSource source(folder_ / "cut.rawlog");
    while (source.next()) {
    }
    const Damage& damage = source.damage();
    EXPECT_NE(LogEnding::kDamaged, damage.ending) << cut << ": " << damage.detail;
    EXPECT_GE(damage.entries_read, entries_before) << cut;
    EXPECT_LE(damage.ending_offset, cut);
    EXPECT_EQ(damage.ending == LogEnding::kCut, !damage.detail.empty());
    entries_before = damage.entries_read;
  }
  EXPECT_GT(entries_before, 2u);
}

TEST_F(Faults, AWrongTruthCostsTheScoreButNotTheMap) {
  write("other.tum", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n");
  const auto outcome = colonnade("run '" + corridor().string() + "' -o r --ground-truth other.tum");
  EXPECT_EQ(1, outcome.exit_code);
  EXPECT_NE(std::string::npos, outcome.err.find("not scored")) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "r/map.3Dscene"));
  EXPECT_EQ(226, summary("r")["frames_processed"]);
}

TEST_F(Faults, AnInterruptedRunWritesItsResults) {
  // The signal comes a moment after the run has begun: the folder stands, most frames are ahead.
  write("interrupt.sh",
        "\"$1\" run \"$2\" -o r >/dev/null 2>&1 &\n"
        "while kill -0 $! && ! test -f r/config.ini; do sleep 0.02; done\n"
        "sleep 0.1\nkill -INT $!\nwait $!\n");
  const int status = std::system(("cd '" + folder_.string() + "' && bash -m interrupt.sh '" +
                                  testing::program().string() + "' '" + corridor().string() + "'")
                                     .c_str());
  EXPECT_EQ(130, WEXITSTATUS(status));
  EXPECT_EQ(true, summary("r")["interrupted"]);
  EXPECT_LT(summary("r")["frames_processed"].get<int>(), 226);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "r/landmarks.csv"));
}

TEST_F(Faults, ALogWithoutDepthIsMappedFromItsImages) {
  ASSERT_EQ(0, colonnade("simulate '" +
                         (testing::sourceFolder() / "rawlogs/worlds/corridor.world").string() +
                         "' -o m.rawlog --set depth.enabled=0")
                   .exit_code)
      << contentOf(folder_ / "stderr.txt");
  const auto outcome = colonnade("run m.rawlog -o r --ground-truth m_ground_truth.tum");
  EXPECT_EQ(0, outcome.exit_code) << outcome.err;
  const auto s = summary("r");
  EXPECT_GT(s["landmarks"]["pillar"].get<int>() + s["landmarks"]["floor_edge"].get<int>(), 5);
  EXPECT_EQ(0, s["landmarks"]["depth_slope"]);
  EXPECT_FALSE(s["left_out"].empty());
}

TEST_F(Faults, ACameraWithoutCalibrationAsksForOne) {
  // An observation with an image, but with MRPT's untouched camera parameters, as a user's own
  // grabber may write it.
  RawlogWriter writer(folder_ / "u.rawlog", {});
  FrameRecord record;
  for (int i = 0; i < 3; ++i) {
    record.stamp_s = 1.7e9 + 0.1 * i;
    record.image = cv::Mat(240, 320, CV_8UC3, cv::Scalar(90, 120, 150));
    writer.add(record);
  }
  writer.finish();
  expectRefused("run u.rawlog -o r", 2, "Camera.fx_px");
  EXPECT_EQ(0, colonnade("run -o r --set Camera.fx_px=300 --set Camera.fy_px=300 --set "
                         "Camera.cx_px=160 --set Camera.cy_px=120 --set Camera.height_m=1 u.rawlog")
                   .exit_code);
}

}  // namespace
}  // namespace colonnade
