// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/CLandmarksMap.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/serialization/CArchive.h>

#include "colonnade/base/error.hpp"
#include "colonnade/maps/landmarks_map_file.hpp"
#include "synthetic_hall.hpp"

namespace colonnade {
namespace {

using namespace colonnade::testing;

TEST(LandmarksMap, BringsTheLandmarksBack) {
  const TemporaryFolder folder;
  const auto file = folder / "map.landmarksmap.gz";
  const auto written = someLandmarks();
  writeLandmarksMap(file, written);
  const auto read = readLandmarksMap(file);
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].id, written[i].id);
    EXPECT_EQ(read[i].kind, written[i].kind);
    EXPECT_TRUE(read[i].p_world.isApprox(written[i].p_world, 1e-12));
    EXPECT_TRUE(read[i].covariance.isApprox(written[i].covariance, 1e-6));
    EXPECT_EQ(read[i].pair_id, written[i].pair_id);
    EXPECT_EQ(read[i].observations, written[i].observations);
    EXPECT_NEAR(read[i].last_stamp_s, written[i].last_stamp_s, 1e-6);
    ASSERT_EQ(read[i].direction.has_value(), written[i].direction.has_value());
    if (read[i].direction) {
      EXPECT_NEAR(*read[i].direction, *written[i].direction, 1e-6);
    }
    EXPECT_NEAR(read[i].direction_sigma, written[i].direction_sigma, 1e-6);
    EXPECT_TRUE(read[i].extent_a.isApprox(written[i].extent_a, 1e-12));
    EXPECT_TRUE(read[i].extent_b.isApprox(written[i].extent_b, 1e-12));
  }
}

TEST(LandmarksMap, IsAnMrptMapWithIdsMeansAndCovariances) {
  const TemporaryFolder folder;
  writeLandmarksMap(folder / "map.gz", someLandmarks());
  mrpt::io::CFileGZInputStream file((folder / "map.gz").string());
  mrpt::maps::CLandmarksMap map;
  mrpt::serialization::archiveFrom(file) >> map;
  ASSERT_EQ(map.size(), 5U);  // the floor edge is two
  const auto* pillar = map.landmarks.getByID(3);
  ASSERT_NE(pillar, nullptr);
  EXPECT_DOUBLE_EQ(pillar->pose_mean.x, 1.5);
  EXPECT_FLOAT_EQ(pillar->pose_cov_22, 0.03F);
  const auto* far_end = map.landmarks.getByID(1'000'000'010);
  ASSERT_NE(far_end, nullptr);
  EXPECT_DOUBLE_EQ(far_end->pose_mean.x, 11.0);
}

TEST(LandmarksMap, HasTheSameBytesEveryTime) {
  const TemporaryFolder folder;
  writeLandmarksMap(folder / "a.gz", someLandmarks());
  std::vector<char> dirt(1 << 16, 'x');  // what a second run may find in fresh memory
  dirt.clear();
  dirt.shrink_to_fit();
  writeLandmarksMap(folder / "b.gz", someLandmarks());
  EXPECT_EQ(contentOf(folder / "a.gz"), contentOf(folder / "b.gz"));
}

TEST(LandmarksMap, TakesLandmarksOfAnotherProgram) {
  const TemporaryFolder folder;
  {
    mrpt::maps::CLandmarksMap map;
    for (int i = 0; i < 3; ++i) {
      mrpt::maps::CLandmark landmark;  // without an ID
      landmark.pose_mean = {1.0 * i, 2.0, 0.5};
      landmark.pose_cov_11 = landmark.pose_cov_22 = 0.1F;
      map.landmarks.push_back(landmark);
    }
    mrpt::io::CFileGZOutputStream file((folder / "other.gz").string());
    mrpt::serialization::archiveFrom(file) << map;
  }
  const auto map = readLandmarksMap(folder / "other.gz");
  ASSERT_EQ(map.size(), 3U);
  EXPECT_EQ(map[2].kind, LandmarkKind::kPillarEdge);
  EXPECT_DOUBLE_EQ(map[2].p_world.x(), 2.0);
}

TEST(LandmarksMap, RefusesOtherFilesByName) {
  const TemporaryFolder folder;
  writeText(folder / "text.gz", "this is no map");
  EXPECT_THROW(readLandmarksMap(folder / "text.gz"), Error);
  EXPECT_THROW(readLandmarksMap(folder / "absent.gz"), Error);
  {
    mrpt::io::CFileGZOutputStream file((folder / "pose.gz").string());
    mrpt::serialization::archiveFrom(file) << mrpt::poses::CPose2D(1, 2, 3);
  }
  try {
    readLandmarksMap(folder / "pose.gz");
    FAIL() << "a pose was read as a map";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("CPose2D"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("CLandmarksMap"));
  }
}

}  // namespace
}  // namespace colonnade
