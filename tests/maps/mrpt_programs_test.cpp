// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// The maps are good when MRPT's own programs can use them.
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/serialization/CArchive.h>

#include <cstdlib>

#include "colonnade/base/text.hpp"
#include "hall_drive.hpp"

namespace colonnade {
namespace {

using namespace colonnade::testing;

bool isInstalled(const std::string& program) {
  return std::system(("command -v " + program + " > /dev/null 2>&1").c_str()) == 0;
}

/// Runs a program in a folder; MRPT's wait for a key on errors, hence no input.
int runIn(const std::filesystem::path& folder, const std::string& command) {
  return std::system(
      ("cd '" + folder.string() + "' && timeout 120 " + command + " > output.txt 2>&1 < /dev/null")
          .c_str());
}

void recordMaps(const TemporaryFolder& folder, double motion_scale) {
  MapRecorder recorder(folder.path(), {}, {});
  MapContents contents;
  contents.trajectory = recordDrive(recorder, motion_scale);
  recorder.finish(contents);
}

TEST(MrptPrograms, Observations2mapBuildsFromTheSimpleMap) {
  if (!isInstalled("observations2map")) GTEST_SKIP() << "observations2map is not installed";
  const TemporaryFolder folder;
  recordMaps(folder, 1.0);
  writeText(folder / "o2m.ini",
            "[MappingApplication]\n"
            "occupancyGrid_count = 1\n"
            "pointsMap_count = 1\n"
            "[MappingApplication_occupancyGrid_00_creationOpts]\n"
            "resolution = 0.05\n"
            "[MappingApplication_occupancyGrid_00_insertOpts]\n"
            "maxOccupancyUpdateCertainty = 0.7\n"
            "considerInvalidRangesAsFreeSpace = false\n");
  ASSERT_EQ(runIn(folder.path(), "observations2map o2m.ini map.simplemap built"), 0)
      << contentOf(folder / "output.txt");
  ASSERT_TRUE(std::filesystem::exists(folder / "built_gridmap_no00.gridmap"));
  mrpt::maps::COccupancyGridMap2D grid;
  mrpt::io::CFileGZInputStream file((folder / "built_gridmap_no00.gridmap").string());
  mrpt::serialization::archiveFrom(file) >> grid;
  int occupied = 0;
  for (unsigned y = 0; y < grid.getSizeY(); ++y)
    for (unsigned x = 0; x < grid.getSizeX(); ++x)
      occupied += grid.getCell(static_cast<int>(x), static_cast<int>(y)) < 0.3F ? 1 : 0;
  EXPECT_GT(occupied, 300);  // two walls of some 9 m in cells of 5 cm
}

TEST(MrptPrograms, PfLocalizationLocalisesOnTheGridWithTheScans) {
  if (!isInstalled("pf-localization")) GTEST_SKIP() << "pf-localization is not installed";
  const TemporaryFolder folder;
  recordMaps(folder, 1.05);  // the motion it gets is 5 % too long: 0.4 m at the end
  writeText(folder / "pf.ini",
            "[KLD_options]\n"
            "KLD_minSampleSize = 500\n"
            "KLD_maxSampleSize = 3000\n"
            "[PF_options]\n"
            "PF_algorithm = 0\n"
            "resamplingMethod = 3\n"
            "adaptiveSampleSize = 0\n"
            "BETA = 0.5\n"
            "sampleSize = 1\n"
            "[LocalizationExperiment]\n"
            "map_file = map.gridmap.gz\n"
            "rawlog_file = scans.rawlog\n"
            "logOutput_dir = pf_log\n"
            "3DSceneFrequency = 1000\n"
            "experimentRepetitions = 1\n"
            "particles_count = 3000\n"
            "init_PDF_mode = 1\n"
            "init_PDF_min_x = -0.5\n"
            "init_PDF_max_x = 0.5\n"
            "init_PDF_min_y = -0.5\n"
            "init_PDF_max_y = 0.5\n"
            "init_PDF_min_phi_deg = -30\n"
            "init_PDF_max_phi_deg = 50\n"
            "SHOW_PROGRESS_3D_REAL_TIME = false\n"
            "[MetricMap]\n"
            "occupancyGrid_count = 1\n"
            "likelihoodMapSelection = -1\n"
            "[MetricMap_occupancyGrid_00_creationOpts]\n"
            "resolution = 0.05\n"
            "[MetricMap_occupancyGrid_00_insertOpts]\n"
            "[MetricMap_occupancyGrid_00_likelihoodOpts]\n"
            "likelihoodMethod = 4\n"
            "LF_decimation = 4\n"
            "LF_stdHit = 0.2\n"
            "LF_maxCorrsDistance = 0.3\n"
            "LF_zHit = 0.95\n"
            "LF_zRandom = 0.05\n"
            "LF_maxRange = 6\n");
  ASSERT_EQ(runIn(folder.path(), "pf-localization pf.ini"), 0) << contentOf(folder / "output.txt");
  const std::string output = contentOf(folder / "output.txt");
  const auto last = output.rfind("PDF estimation: (");
  ASSERT_NE(last, std::string::npos) << output;
  const auto numbers = fields(output.substr(last + 17, output.find("deg)", last) - last - 17), ',');
  ASSERT_EQ(numbers.size(), 3U);
  const auto truth = drivePoses().back();
  EXPECT_NEAR(parseDouble(numbers[0]).value_or(1e9), truth.x, 0.2);
  EXPECT_NEAR(parseDouble(numbers[1]).value_or(1e9), truth.y, 0.2);
  EXPECT_NEAR(parseDouble(numbers[2]).value_or(1e9), degrees(truth.phi), 4.0);
}

}  // namespace
}  // namespace colonnade
