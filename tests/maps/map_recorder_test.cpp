// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/maps/map_recorder.hpp"

#include <gmock/gmock.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include <fstream>

#include "colonnade/base/error.hpp"
#include "colonnade/maps/landmarks_map_file.hpp"
#include "hall_drive.hpp"

namespace colonnade {
namespace {

using namespace colonnade::testing;
using ::testing::HasSubstr;

template <class Object>
void read(const std::filesystem::path& path, Object& object) {
  mrpt::io::CFileGZInputStream file(path.string());
  mrpt::serialization::archiveFrom(file) >> object;
}

/// One drive for all tests that only look at its files.
class RecordedMaps : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    MapRecorder recorder(folder_->path(), {}, {});
    MapContents contents;
    contents.trajectory = recordDrive(recorder);
    contents.landmarks = someLandmarks();
    files_ = recorder.finish(contents);
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static inline std::unique_ptr<TemporaryFolder> folder_;
  static inline MapFiles files_;
};

TEST_F(RecordedMaps, LeaveNothingOutAndNoTemporaryFile) {
  EXPECT_TRUE(files_.left_out.empty());
  std::set<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder_->path()))
    found.insert(entry.path());
  EXPECT_EQ(found, std::set<std::filesystem::path>(files_.written.begin(), files_.written.end()));
  EXPECT_EQ(found.size(), 9U);
}

TEST_F(RecordedMaps, GridHasWallsWhereTheyAreAndIsFreeWhereTheRobotDrove) {
  mrpt::maps::COccupancyGridMap2D grid;
  read(*folder_ / "map.gridmap.gz", grid);
  EXPECT_NEAR(grid.getResolution(), 0.05, 1e-6);
  int walls = 0;
  for (double x = 1.0; x < 10.0; x += 0.05)
    for (const double y : {-1.0, 1.0}) {
      double nearest = 1.0;
      for (const double offset : {-0.05, 0.0, 0.05})
        nearest = std::min<double>(
            nearest, grid.getPos(static_cast<float>(x), static_cast<float>(y + offset)));
      walls += nearest < 0.3 ? 1 : 0;
    }
  EXPECT_GT(walls, 210);  // of 360: a third lies behind pillars or is never looked at
  for (const auto& pose : drivePoses())
    if (pose.x > 1.5) {
      EXPECT_GT(grid.getPos(static_cast<float>(pose.x), static_cast<float>(pose.y)), 0.8);
    }
}

TEST_F(RecordedMaps, NavigationMapIsTheGrid) {
  mrpt::maps::COccupancyGridMap2D grid;
  read(*folder_ / "map.gridmap.gz", grid);
  mrpt::maps::COccupancyGridMap2D loaded;
  ASSERT_TRUE(loaded.loadFromROSMapServerYAML((*folder_ / "map.yaml").string()));
  ASSERT_EQ(loaded.getSizeX(), grid.getSizeX());
  ASSERT_EQ(loaded.getSizeY(), grid.getSizeY());
  EXPECT_NEAR(loaded.getXMin(), grid.getXMin(), 0.001);
  EXPECT_NEAR(loaded.getYMin(), grid.getYMin(), 0.001);
  for (unsigned y = 0; y < grid.getSizeY(); ++y)
    for (unsigned x = 0; x < grid.getSizeX(); ++x) {
      const float cell = grid.getCell(static_cast<int>(x), static_cast<int>(y));
      const float copy = loaded.getCell(static_cast<int>(x), static_cast<int>(y));
      if (cell < 0.3F) {
        ASSERT_LT(copy, 0.2F);
      }
      if (cell > 0.85F) {
        ASSERT_GT(copy, 0.8F);
      }
    }
  EXPECT_THAT(contentOf(*folder_ / "map.yaml"), HasSubstr("resolution: 0.05\n"));
}

TEST_F(RecordedMaps, SimpleMapHoldsKeyFramesEveryQuarterMetre) {
  mrpt::maps::CSimpleMap map;
  ASSERT_TRUE(map.loadFromFile((*folder_ / "map.simplemap").string()));
  EXPECT_GE(map.size(), 25U);
  EXPECT_LE(map.size(), 35U);
  for (const auto& [pose, observations] : map) {
    const auto scan = observations->getObservationByClass<mrpt::obs::CObservation2DRangeScan>();
    ASSERT_TRUE(scan);
    EXPECT_TRUE(scan->isPlanarScan(1e-9));
  }
}

TEST_F(RecordedMaps, MetricMapHoldsGridPointsAndLandmarks) {
  mrpt::maps::CMultiMetricMap maps;
  read(*folder_ / "map.metricmap.gz", maps);
  EXPECT_EQ(maps.maps.size(), 3U);
  ASSERT_TRUE(maps.mapByClass<mrpt::maps::COccupancyGridMap2D>());
  ASSERT_TRUE(maps.mapByClass<mrpt::maps::CSimplePointsMap>());
  EXPECT_GT(maps.mapByClass<mrpt::maps::CSimplePointsMap>()->size(), 500U);
  EXPECT_EQ(readLandmarksMap(*folder_ / "map.metricmap.gz").size(), someLandmarks().size());
}

TEST_F(RecordedMaps, SceneLoadsAndShowsTheLandmarks) {
  mrpt::opengl::COpenGLScene scene;
  ASSERT_TRUE(scene.loadFromFile((*folder_ / "map.3Dscene").string()));
  for (const char* name :
       {"metre grid", "occupancy", "vertical landmarks", "floor edges", "trajectory", "legend"})
    EXPECT_TRUE(scene.getByName(name)) << name;
  EXPECT_TRUE(scene.getByName("pillar 3"));
  EXPECT_TRUE(scene.getByName("depth_slope 12"));
  EXPECT_TRUE(scene.getByName("floor_edge 10"));
}

TEST_F(RecordedMaps, ScanLogHoldsTheMotionUsedWithItsCovariance) {
  mrpt::io::CFileGZInputStream file((*folder_ / "scans.rawlog").string());
  auto archive = mrpt::serialization::archiveFrom(file);
  mrpt::obs::CActionCollection::Ptr actions;
  mrpt::obs::CSensoryFrame::Ptr observations;
  std::size_t entry = 0;
  std::size_t pairs = 0;
  Pose2 T_world_robot = drivePoses().front();
  while (mrpt::obs::CRawlog::readActionObservationPair(archive, actions, observations, entry)) {
    const auto motion = actions->getBestMovementEstimation();
    ASSERT_TRUE(motion);
    const auto& mean = motion->poseChange->getMeanVal();
    T_world_robot = T_world_robot * Pose2{mean.x(), mean.y(), mean.phi()};
    const auto gaussian =
        std::dynamic_pointer_cast<mrpt::poses::CPosePDFGaussian>(motion->poseChange.get_ptr());
    ASSERT_TRUE(gaussian);
    EXPECT_NEAR(gaussian->cov(2, 2), 1e-5, 1e-9);
    const auto scan = observations->getObservationByClass<mrpt::obs::CObservation2DRangeScan>();
    ASSERT_TRUE(scan);
    EXPECT_NEAR(mrpt::Clock::toDouble(scan->timestamp),
                kFirstStamp_s + kFramePeriod_s * static_cast<double>(pairs), 1e-5);
    ++pairs;
  }
  EXPECT_EQ(pairs, drivePoses().size());
  EXPECT_NEAR(T_world_robot.x, drivePoses().back().x, 1e-9);
  EXPECT_NEAR(T_world_robot.y, drivePoses().back().y, 1e-9);
}

TEST(MapRecorder, MovesKeyFramesToTheFinalTrajectory) {
  const TemporaryFolder folder;
  MapRecorder recorder(folder.path(), {}, {});
  MapContents contents;
  contents.trajectory = recordDrive(recorder);
  for (auto& pose : contents.trajectory) pose.T_world_body.translation().y() += 3.0;
  recorder.finish(contents);
  mrpt::maps::CSimpleMap map;
  ASSERT_TRUE(map.loadFromFile((folder / "map.simplemap").string()));
  EXPECT_NEAR(map.begin()->pose->getMeanVal().y(), 3.0, 1e-9);
  mrpt::maps::COccupancyGridMap2D grid;
  read(folder / "map.gridmap.gz", grid);
  EXPECT_GT(grid.getYMin(), 1.0F);
}

TEST(MapRecorder, AddsTheMotionOfFramesWithoutDepthToTheNextScan) {
  const TemporaryFolder folder;
  MapRecorder recorder(folder.path(), {}, {});
  const auto T_robot_camera = mountCamera(0.0, 0.9, 0.1);
  const Pose2 step{0.1, 0.0, 0.2};
  const Eigen::Matrix3d P = Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal();
  Pose2 T_world_robot;
  for (int i = 0; i < 5; ++i) {
    auto frame = renderFrame(corridor(), T_world_robot, T_robot_camera, i);
    if (i % 4 != 0) frame.depth_m.release();
    recorder.add(frame, T_world_robot, P, i == 0 ? Pose2{} : step, P);
    T_world_robot = T_world_robot * step;
  }
  recorder.finish({});
  mrpt::obs::CRawlog log;
  ASSERT_TRUE(log.loadFromRawLogFile((folder / "scans.rawlog").string()));
  ASSERT_EQ(log.size(), 4U);
  const auto change = log.getAsAction(2)->getBestMovementEstimation()->poseChange->getMeanVal();
  const Pose2 expected = step * step * step * step;
  EXPECT_NEAR(change.x(), expected.x, 1e-12);
  EXPECT_NEAR(change.phi(), expected.phi, 1e-12);
}

TEST(MapRecorder, SaysWhatALogWithoutDepthCannotGive) {
  const TemporaryFolder folder;
  MapRecorder recorder(folder.path(), {}, {});
  recorder.add(Frame{}, {}, Eigen::Matrix3d::Zero(), {}, Eigen::Matrix3d::Zero());
  MapContents contents;
  contents.landmarks = someLandmarks();
  const auto files = recorder.finish(contents);
  ASSERT_EQ(files.left_out.size(), 2U);
  EXPECT_THAT(files.left_out[0], HasSubstr("scans.rawlog: no frame has depth"));
  EXPECT_THAT(files.left_out[1], HasSubstr("map.gridmap.gz"));
  for (const auto& file : files.written) EXPECT_TRUE(std::filesystem::exists(file)) << file;
  EXPECT_FALSE(std::filesystem::exists(folder / "scans.rawlog"));
  EXPECT_EQ(readLandmarksMap(folder / "map.metricmap.gz").size(), 4U);
}

TEST(MapRecorder, WritesAnEmptyMapAndOddNumbers) {
  const TemporaryFolder folder;
  MapRecorder recorder(folder.path(), {}, {});
  recorder.finish({});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  MapContents contents;
  contents.landmarks = someLandmarks();
  contents.landmarks[0].covariance.setConstant(nan);
  contents.landmarks[1].covariance.setZero();
  contents.landmarks[3].covariance.setConstant(-1.0);
  EXPECT_NO_THROW(recorder.finish(contents));
}

TEST(MapRecorder, WritesTheSameBytesEveryTime) {
  const TemporaryFolder first;
  const TemporaryFolder second;
  MapFiles files;
  for (const auto* folder : {&first, &second}) {
    MapRecorder recorder(folder->path(), {}, {});
    MapContents contents;
    contents.trajectory = recordDrive(recorder);
    contents.landmarks = someLandmarks();
    files = recorder.finish(contents);
  }
  for (const auto& file : files.written)
    EXPECT_EQ(contentOf(file), contentOf(first / file.filename().string())) << file.filename();
}

TEST(MapRecorder, LeavesNothingBehindWhenTheRunIsGivenUp) {
  const TemporaryFolder folder;
  {
    MapRecorder recorder(folder.path(), {}, {});
    recordDrive(recorder);
    EXPECT_FALSE(std::filesystem::is_empty(folder.path()));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(MapRecorder, NamesTheFileItCannotWrite) {
  const TemporaryFolder folder;
  MapRecorder recorder(folder / "absent", {}, {});
  try {
    recorder.finish({});
    FAIL() << "written into a folder that does not exist";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("absent/map.landmarksmap.gz"));
  }
}

}  // namespace
}  // namespace colonnade
