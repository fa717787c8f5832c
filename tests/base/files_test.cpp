// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/base/log_path.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/base/trajectory.hpp"

namespace colonnade {
namespace {

class Files : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        std::filesystem::path(::testing::TempDir()) / (std::string("colonnade_") + info->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string content(const std::filesystem::path& path) const {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }
  std::filesystem::path folder_;
};

TEST_F(Files, AFailedWriteLeavesTheFormerFileAndNoRubbish) {
  const auto path = folder_ / "map.csv";
  writeFileAtomically(path, "whole");
  EXPECT_THROW(writeFileAtomically(path,
                                   [](const std::filesystem::path& temporary) {
                                     std::ofstream(temporary) << "half";
                                     throw Error("disk full");
                                   }),
               Error);
  EXPECT_EQ("whole", content(path));
  EXPECT_EQ(1, std::distance(std::filesystem::directory_iterator(folder_), {}));
  EXPECT_THROW(writeFileAtomically(folder_ / "absent" / "map.csv", "x"), Error);
}

TEST_F(Files, TumRoundTrip) {
  Trajectory trajectory(2);
  trajectory[0].stamp_s = 1341841278.8427;
  trajectory[1].stamp_s = 1341841279.5107;
  trajectory[1].T_world_body = Pose2{1.25, -0.5, 3.0}.toIsometry3();
  const auto path = folder_ / "t.tum";
  writeTum(path, trajectory);
  const Trajectory again = readTum(path);
  ASSERT_EQ(2u, again.size());
  EXPECT_NEAR(trajectory[1].stamp_s, again[1].stamp_s, 1e-6);
  EXPECT_TRUE(again[1].T_world_body.isApprox(trajectory[1].T_world_body, 1e-8));
}

TEST_F(Files, ABadTumLineIsNamed) {
  const auto path = folder_ / "t.tum";
  const auto complaint = [&](const std::string& text) -> std::string {
    writeFileAtomically(path, text);
    try {
      readTum(path);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const std::string good = "1 0 0 0 0 0 0 1\n";
  EXPECT_EQ(path.string() + ":2: a TUM line has 8 numbers (stamp tx ty tz qx qy qz qw), found 3",
            complaint(good + "2 0 0\n"));
  EXPECT_NE(std::string::npos, complaint(good + "1 0 0 0 0 0 0 1\n").find("does not grow"));
  EXPECT_NE(std::string::npos, complaint("1 0 x 0 0 0 0 1\n").find("\"x\" is not a number"));
  EXPECT_NE(std::string::npos, complaint("1 0 0 0 0 0 0 0\n").find("quaternion"));
}

TEST(LogPath, TheStemIsTheLogWithoutItsEndings) {
  EXPECT_EQ("a/b", logStem("a/b.rawlog"));
  EXPECT_EQ("a/b", logStem("a/b.rawlog.gz"));
  EXPECT_EQ("a/b.c", logStem("a/b.c"));
}

TEST(Text, NumbersReadBackAndIgnoreTheLocale) {
  EXPECT_EQ("0.1", formatDouble(0.1));
  EXPECT_EQ(0.1 + 0.2, *parseDouble(formatDouble(0.1 + 0.2)));
  EXPECT_EQ("-3.1416", formatFixed(-3.14159265, 4));
  EXPECT_FALSE(parseDouble("1,5"));
  EXPECT_FALSE(parseDouble(""));
  EXPECT_EQ((std::vector<std::string>{"a", "", "b"}), fields("a, ,b", ','));
  EXPECT_EQ((std::vector<std::string>{"a", "b"}), words("  a\tb "));
}

}  // namespace
}  // namespace colonnade
