// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/maps/landmark_csv.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>

#include "colonnade/base/error.hpp"
#include "synthetic_hall.hpp"

namespace colonnade {
namespace {

using namespace colonnade::testing;
using ::testing::HasSubstr;

std::string errorOf(const std::filesystem::path& path) {
  try {
    readLandmarksCsv(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(LandmarkCsv, BringsEveryColumnBack) {
  const TemporaryFolder folder;
  const auto written = someLandmarks();
  writeLandmarksCsv(folder / "landmarks.csv", written);
  const auto read = readLandmarksCsv(folder / "landmarks.csv");
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].id, written[i].id);
    EXPECT_EQ(read[i].kind, written[i].kind);
    EXPECT_EQ(read[i].p_world, written[i].p_world);
    EXPECT_EQ(read[i].covariance, written[i].covariance);
    EXPECT_EQ(read[i].direction, written[i].direction);
    EXPECT_EQ(read[i].extent_a, written[i].extent_a);
    EXPECT_EQ(read[i].extent_b, written[i].extent_b);
    EXPECT_EQ(read[i].hallway, written[i].hallway);
    EXPECT_EQ(read[i].pair_id, written[i].pair_id);
    EXPECT_EQ(read[i].observations, written[i].observations);
    EXPECT_NEAR(read[i].first_stamp_s, written[i].first_stamp_s, 1e-6);
    EXPECT_NEAR(read[i].last_stamp_s, written[i].last_stamp_s, 1e-6);
  }
}

TEST(LandmarkCsv, KeepsAnEmptyMapEmpty) {
  const TemporaryFolder folder;
  writeLandmarksCsv(folder / "landmarks.csv", {});
  EXPECT_TRUE(readLandmarksCsv(folder / "landmarks.csv").empty());
}

TEST(LandmarkCsv, TakesColumnsInAnyOrderAndFurtherOnes) {
  const TemporaryFolder folder;
  writeText(folder / "a.csv",
            "note,kind,id,x,y,direction,extent_ax,extent_ay,extent_bx,extent_by,cov_xx,cov_xy,"
            "cov_yy,hallway,pair_id,observations,first_stamp,last_stamp\n"
            "hi,floor_edge,7,1,2,0.5,0,0,2,4,1,0,1,-1,,3,0,1\n");
  const auto map = readLandmarksCsv(folder / "a.csv");
  ASSERT_EQ(map.size(), 1U);
  EXPECT_EQ(number(map[0].id), 7);
  EXPECT_EQ(map[0].kind, LandmarkKind::kFloorEdge);
  EXPECT_DOUBLE_EQ(*map[0].direction, 0.5);
  EXPECT_FALSE(map[0].pair_id);
}

TEST(LandmarkCsv, NamesFileLineAndColumnOfAMistake) {
  const TemporaryFolder folder;
  const auto file = folder / "landmarks.csv";
  writeLandmarksCsv(file, someLandmarks());
  const std::string good = contentOf(file);
  const auto with = [&](const std::string& old_text, const std::string& new_text) {
    std::string text = good;
    text.replace(text.find(old_text), old_text.size(), new_text);
    writeText(file, text);
    return errorOf(file);
  };
  EXPECT_THAT(with("4,pillar", "4,column"), HasSubstr("landmarks.csv:3: column kind"));
  EXPECT_THAT(with("\n4,pillar", "\n3,pillar"), HasSubstr("landmarks.csv:3: id 3 stands twice"));
  EXPECT_THAT(with("1.8", "1.8m"), HasSubstr("\"1.8m\" is not a number"));
  EXPECT_THAT(with(",0.002,", ",x,"), HasSubstr("column cov_xy: \"x\" is not a number"));
  EXPECT_THAT(with("cov_xy,", ""), HasSubstr("landmarks.csv:1: column cov_xy is missing"));
  EXPECT_THAT(with("floor_edge,", "floor_edge,5,"),
              HasSubstr("landmarks.csv:4: the header has 17"));
  EXPECT_THAT(errorOf(folder / "none.csv"), HasSubstr("none.csv: cannot be read"));
}

TEST(LandmarkCsv, LeavesTheFormerFileWhenTheDiskIsFull) {
  const TemporaryFolder folder;
  const auto file = folder / "landmarks.csv";
  writeLandmarksCsv(file, someLandmarks());
  const std::string former = contentOf(file);
  LandmarkMap large;
  for (int i = 0; i < 2000; ++i) {
    large.push_back(someLandmarks().front());
    large.back().id = LandmarkId{i};
  }
  rlimit limit{};
  getrlimit(RLIMIT_FSIZE, &limit);
  const rlimit small{20000, limit.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW(writeLandmarksCsv(file, large), Error);
  setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(contentOf(file), former);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

}  // namespace
}  // namespace colonnade
