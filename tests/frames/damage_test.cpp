// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "colonnade/base/error.hpp"
#include "log_helpers.hpp"
#include "shared_data.hpp"

namespace colonnade {
namespace {

using testing::Bytes;
using testing::readFile;
using testing::readLog;
using testing::record;
using testing::TemporaryFolder;
using testing::writeFile;
using testing::writeLog;
using Format = RawlogWriterOptions::Format;

std::string refusal(const std::filesystem::path& path) {
  try {
    RawlogSource source(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kFailed);
    return error.what();
  }
  return "";
}

/// A log with an entry count that tells where entries end.
struct SmallLog {
  Bytes bytes;
  std::vector<std::size_t> entry_ends;  ///< of the plain log
};

SmallLog smallLog(const TemporaryFolder& folder, int gz_level) {
  SmallLog log;
  for (int frames = 1; frames <= 4; ++frames) {
    writeLog(folder / "whole.rawlog", frames, {.gz_level = gz_level});
    log.bytes = readFile(folder / "whole.rawlog");
    log.entry_ends.push_back(log.bytes.size());
  }
  return log;
}

TEST(Damage, APlainLogCutAnywhereGivesAllWholeEntriesBefore) {
  const TemporaryFolder folder;
  const auto log = smallLog(folder, 0);
  const auto cut = folder / "cut.rawlog";
  for (std::size_t i = 1; i <= 100; ++i) {
    const std::size_t length = log.bytes.size() * i / 101;
    writeFile(cut,
              Bytes(log.bytes.begin(), log.bytes.begin() + static_cast<std::ptrdiff_t>(length)));
    const auto read = readLog(cut);
    const auto whole = static_cast<std::size_t>(
        std::upper_bound(log.entry_ends.begin(), log.entry_ends.end(), length) -
        log.entry_ends.begin());
    EXPECT_EQ(read.frames.size(), whole) << "cut at " << length;
    EXPECT_EQ(read.damage.ending, LogEnding::kCut) << "cut at " << length;
    EXPECT_LE(read.damage.ending_offset, length);
    EXPECT_EQ(read.damage.ending_entry, read.damage.entries_read);
    EXPECT_TRUE(read.damage.any());
  }
}

TEST(Damage, ACutBetweenTwoObjectsIsAnEnd) {
  const TemporaryFolder folder;
  const auto log = smallLog(folder, 0);
  writeFile(
      folder / "cut.rawlog",
      Bytes(log.bytes.begin(), log.bytes.begin() + static_cast<std::ptrdiff_t>(log.entry_ends[1])));
  const auto read = readLog(folder / "cut.rawlog");
  EXPECT_EQ(read.frames.size(), 2U);
  EXPECT_EQ(read.damage.ending, LogEnding::kEnd);
}

TEST(Damage, AGzLogCutAnywhereIsCutAndKeepsWhatCameBefore) {
  const TemporaryFolder folder;
  const auto log = smallLog(folder, 1);
  std::size_t most = 0;
  for (std::size_t i = 1; i <= 100; ++i) {
    const auto length = static_cast<std::ptrdiff_t>(log.bytes.size() * i / 101);
    writeFile(folder / "cut.rawlog", Bytes(log.bytes.begin(), log.bytes.begin() + length));
    const auto read = readLog(folder / "cut.rawlog");
    EXPECT_EQ(read.damage.ending, LogEnding::kCut) << "cut at " << length;
    EXPECT_GE(read.frames.size(), most) << "a longer piece gave fewer frames";
    most = std::max(most, read.frames.size());
  }
  EXPECT_EQ(most, 3U);
}

bool sameFrames(const std::vector<Frame>& a, const std::vector<Frame>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Frame& x, const Frame& y) {
    return x.stamp_s == y.stamp_s && cv::norm(x.colour, y.colour, cv::NORM_INF) == 0.0 &&
           cv::norm(x.depth_m, y.depth_m, cv::NORM_INF) == 0.0;
  });
}

class Flips : public ::testing::TestWithParam<int> {};

TEST_P(Flips, OneWrongBitNeverCrashesAndNeverGoesUnnoticedInGz) {
  const TemporaryFolder folder;
  auto log = smallLog(folder, GetParam());
  writeFile(folder / "whole.rawlog", log.bytes);
  const auto whole = readLog(folder / "whole.rawlog");
  std::mt19937 random(7);  // the engine's numbers are the same everywhere
  for (int i = 0; i < 150; ++i) {
    auto bytes = log.bytes;
    // Half of the flips near the beginning of an object, where its sizes stand.
    const std::size_t at = i % 2 == 0 ? random() % bytes.size() : random() % 600;
    bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1U << (random() % 8)));
    writeFile(folder / "flip.rawlog", bytes);
    try {
      const auto read = readLog(folder / "flip.rawlog");
      EXPECT_NE(read.damage.ending, LogEnding::kNotReached);
      EXPECT_LE(read.frames.size(), 4U);
      const bool in_gz_data = GetParam() > 0 && at >= 10;
      if (in_gz_data && !read.damage.any()) {  // a bit the compressed data does not depend on
        EXPECT_TRUE(sameFrames(read.frames, whole.frames)) << "bit flipped in byte " << at;
      }
    } catch (const Error&) {
      EXPECT_LT(at, 600U) << "only a damaged beginning may be refused altogether";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(PlainAndGz, Flips, ::testing::Values(0, 1));

TEST(Damage, AWrongChecksumLosesNoEntry) {
  const TemporaryFolder folder;
  auto log = smallLog(folder, 1);
  log.bytes[log.bytes.size() - 6] ^= 0x10U;  // in the CRC, which 4 bytes of length follow
  writeFile(folder / "crc.rawlog", log.bytes);
  const auto read = readLog(folder / "crc.rawlog");
  EXPECT_EQ(read.frames.size(), 4U);
  EXPECT_EQ(read.damage.ending, LogEnding::kDamaged);
  EXPECT_NE(read.damage.detail.find("check"), std::string::npos);
}

TEST(Damage, TwoGzMembersInARowAreOneLog) {
  const TemporaryFolder folder;
  const auto log = smallLog(folder, 1);
  writeLog(folder / "a.rawlog", 2);
  auto bytes = readFile(folder / "a.rawlog");
  RawlogWriter writer(folder / "b.rawlog");
  writer.add(record(2));
  writer.finish();
  const auto more = readFile(folder / "b.rawlog");
  bytes.insert(bytes.end(), more.begin(), more.end());
  writeFile(folder / "ab.rawlog", bytes);
  const auto read = readLog(folder / "ab.rawlog");
  EXPECT_EQ(read.frames.size(), 3U);
  EXPECT_EQ(read.damage.ending, LogEnding::kEnd);
}

TEST(Damage, HugeCountsAreRefusedBeforeMemoryIsMade) {
  const TemporaryFolder folder;
  writeLog(folder / "plain.rawlog", 2, {.gz_level = 0});
  auto bytes = readFile(folder / "plain.rawlog");
  // Rows and columns of the range image: the first place where its size stands.
  const Bytes size{48, 0, 0, 0, 64, 0, 0, 0};
  const std::string name = "CObservation3DRangeScan";  // of the last object
  const auto object = std::find_end(bytes.begin(), bytes.end(), name.begin(), name.end());
  const auto found = std::search(object, bytes.end(), size.begin(), size.end());
  ASSERT_NE(found, bytes.end());
  std::fill(found, found + 8, std::uint8_t{0x7f});
  writeFile(folder / "huge.rawlog", bytes);
  const auto read = readLog(folder / "huge.rawlog");
  EXPECT_EQ(read.damage.ending, LogEnding::kDamaged);
  EXPECT_EQ(read.frames.size(), 1U);
  EXPECT_NE(read.damage.detail.find("absurd"), std::string::npos) << read.damage.detail;
}

TEST(Damage, AMotionWhosePoseIsMissingIsDamageNotACrash) {
  const TemporaryFolder folder;
  writeLog(folder / "a.rawlog", 3, {.format = Format::kActionSensoryFramePairs, .gz_level = 0});
  auto bytes = readFile(folder / "a.rawlog");
  // The class of the pose inside the second action, replaced by another registered class of the
  // same length: MRPT 2.5.8 follows a null pointer there.
  const std::string name = "mrpt::poses::CPose2D", other = "mrpt::poses::CPose3D";
  auto at = std::search(bytes.begin(), bytes.end(), name.begin(), name.end());
  at = std::search(at + 1, bytes.end(), name.begin(), name.end());
  ASSERT_NE(at, bytes.end());
  std::copy(other.begin(), other.end(), at);
  writeFile(folder / "b.rawlog", bytes);
  const auto read = readLog(folder / "b.rawlog");
  EXPECT_EQ(read.damage.ending, LogEnding::kDamaged);
  EXPECT_EQ(read.frames.size(), 1U);
  EXPECT_NE(read.damage.detail.find("CPose3D"), std::string::npos) << read.damage.detail;
}

TEST(Damage, AnUnknownClassIsNamed) {
  const TemporaryFolder folder;
  writeLog(folder / "a.rawlog", 2, {.gz_level = 0});
  auto bytes = readFile(folder / "a.rawlog");
  const std::string name = "CObservationOdometry", other = "CObservationTelepathy";
  auto at = std::search(bytes.begin(), bytes.end(), name.begin(), name.end());
  at = std::search(at + 1, bytes.end(), name.begin(), name.end());
  ASSERT_NE(at, bytes.end());
  std::copy(other.begin(), other.begin() + static_cast<std::ptrdiff_t>(name.size()), at);
  writeFile(folder / "b.rawlog", bytes);
  const auto read = readLog(folder / "b.rawlog");
  EXPECT_EQ(read.frames.size(), 1U);
  EXPECT_EQ(read.damage.ending, LogEnding::kDamaged);
  EXPECT_NE(read.damage.detail.find("CObservationTelepath"), std::string::npos);
}

TEST(Damage, SensorsNobodyAsksForAreCountedAndNoLoss) {
  const TemporaryFolder folder;
  {
    testing::MrptLog log(folder / "a.rawlog");
    mrpt::obs::CObservationIMU imu;
    imu.timestamp = testing::stamp(1.0);
    mrpt::obs::CObservation2DRangeScan scan;
    scan.resizeScanAndAssign(181, 1.0F, true, 0);
    log.add(imu);
    log.add(scan);
    log.add(imu);
  }
  const auto read = readLog(folder / "a.rawlog");
  EXPECT_EQ(read.damage.ending, LogEnding::kEnd);
  EXPECT_EQ(read.damage.entries_read, 3U);
  EXPECT_FALSE(read.damage.any());
  EXPECT_EQ(read.damage.ignored.at("mrpt::obs::CObservationIMU"), 2U);
}

TEST(Refusal, SaysWhatIsWrongWithAFileThatIsNoLog) {
  const TemporaryFolder folder;
  writeFile(folder / "empty.rawlog", {});
  EXPECT_NE(refusal(folder / "empty.rawlog").find("empty file, no frames"), std::string::npos);

  cv::Mat image(20, 20, CV_8UC1, cv::Scalar(7));
  writeFile(folder / "picture.rawlog", {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0, 0, 0, 13});
  EXPECT_NE(refusal(folder / "picture.rawlog").find("not an MRPT rawlog"), std::string::npos);

  Bytes text;
  for (const char c : std::string("# timestamp tx ty tz\n"))
    text.push_back(static_cast<std::uint8_t>(c));
  writeFile(folder / "text.rawlog", text);
  EXPECT_NE(refusal(folder / "text.rawlog").find("not an MRPT rawlog"), std::string::npos);

  const auto missing = refusal(folder / "none.rawlog");
  EXPECT_NE(missing.find("none.rawlog: No such file"), std::string::npos) << missing;
  EXPECT_NE(refusal(folder.path()).find("Is a directory"), std::string::npos);
}

TEST(Refusal, APictureOfTheRecordingIsNoLog) {
  COLONNADE_REQUIRE_RECORDING(images, "corridor_images/rgb_0050.png");
  EXPECT_NE(refusal(images).find("not an MRPT rawlog"), std::string::npos);
}

}  // namespace
}  // namespace colonnade
