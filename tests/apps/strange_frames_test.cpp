// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <mrpt/core/Clock.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/serialization/CArchive.h>

#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "colonnade/frames/rawlog_writer.hpp"
#include "program.hpp"

namespace colonnade {
namespace {

struct StrangeLog {
  cv::Mat image, depth_units;
  double metres_per_unit = 0.001;
};

cv::Mat noise() {
  cv::Mat image(240, 320, CV_8UC1);
  cv::RNG(7).fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

cv::Mat plain(int gray) { return {240, 320, CV_8UC1, cv::Scalar(gray)}; }
cv::Mat depth(int units) { return {240, 320, CV_16UC1, cv::Scalar(units)}; }

/// Frames that show nothing, through the whole of `run`: it ends as usual, nothing is mapped, and
/// the summary counts why.
class StrangeFramesRun : public testing::ProgramTest {
 protected:
  void write(const std::string& name, const StrangeLog& log) const {
    RawlogWriter writer(folder_ / name);
    for (int i = 0; i < kFrames; ++i) {
      FrameRecord record;
      record.stamp_s = 1000.0 + 0.1 * i;
      record.image = log.image;
      record.depth_units = log.depth_units;
      record.metres_per_unit = log.metres_per_unit;
      const int width = log.image.cols, height = log.image.rows;
      record.camera = {width, height, 280.0, 280.0, 0.5 * width, 0.5 * height};
      record.T_odom_robot = Pose2{0.02 * i, 0.0, 0.0};
      writer.add(record);
    }
    writer.finish();
  }
  void expectNothing(const std::string& name, const StrangeLog& log, const std::string& reason) {
    write(name + ".rawlog", log);
    const auto outcome = colonnade("run " + name + ".rawlog -o " + name);
    ASSERT_EQ(0, outcome.exit_code) << name << "\n" << outcome.err;
    const auto s = summary(name);
    EXPECT_EQ(kFrames, s["frames_processed"].get<int>()) << name;
    for (const auto& [kind, count] : s["landmarks"].items()) EXPECT_EQ(0, count) << name << kind;
    ASSERT_TRUE(s["refused"].contains(reason)) << name << ": " << s["refused"];
    EXPECT_EQ(kFrames, s["refused"][reason].get<int>()) << name;
  }
  /// What RawlogWriter refuses to write: images of 16 bits, inside the log or in files beside it.
  void writeSixteenBits(const std::string& name, bool in_files) const {
    mrpt::io::CFileGZOutputStream file((folder_ / (name + ".rawlog")).string());
    auto archive = mrpt::serialization::archiveFrom(file);
    std::filesystem::create_directories(folder_ / (name + "_Images"));
    for (int i = 0; i < kFrames; ++i) {
      mrpt::obs::CObservationImage picture;
      picture.timestamp = mrpt::Clock::fromDouble(1000.0 + 0.1 * i);
      picture.sensorLabel = "CAM";
      picture.cameraParams.ncols = 320;
      picture.cameraParams.nrows = 240;
      picture.cameraParams.setIntrinsicParamsFromValues(280, 280, 160, 120);
      const cv::Mat deep(240, 320, CV_16UC1, cv::Scalar(900));
      const std::string png = std::to_string(i) + ".png";
      if (in_files) {
        ASSERT_TRUE(cv::imwrite((folder_ / (name + "_Images") / png).string(), deep));
        picture.image.setExternalStorage(png);
      } else {
        picture.image = mrpt::img::CImage(deep, mrpt::img::DEEP_COPY);
      }
      archive << picture;
    }
  }
  static constexpr int kFrames = 6;
};

TEST_F(StrangeFramesRun, OfTheImageMapNothingAndAreCounted) {
  expectNothing("black", {plain(0), {}}, "the image has no contrast");
  expectNothing("white", {plain(255), {}}, "the image has no contrast");
  expectNothing("noise", {noise(), {}}, "the image is noise");
}

TEST_F(StrangeFramesRun, OfTheDepthMapNothingAndAreCounted) {
  expectNothing("zero", {plain(0), depth(0)}, "the depth holds no values");
}

TEST_F(StrangeFramesRun, WithDepthThatIsNoNumberAreCountedAsDamage) {
  write("nan.rawlog", {plain(0), depth(900), std::numeric_limits<double>::quiet_NaN()});
  const auto outcome = colonnade("run nan.rawlog -o nan");
  EXPECT_EQ(3, outcome.exit_code) << outcome.err;
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("6 skipped: depth without a unit"));
  const auto written = summary("nan");
  for (const auto& [kind, count] : written["landmarks"].items()) EXPECT_EQ(0, count) << kind;
}

TEST_F(StrangeFramesRun, OfSixteenBitsInTheLogEndInOneLine) {
  writeSixteenBits("deep", false);
  const auto outcome = colonnade("run deep.rawlog -o deep");
  EXPECT_EQ(1, outcome.exit_code);
  EXPECT_EQ(1, outcome.errorLines()) << outcome.err;
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("no camera images or depth"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "deep/landmarks.csv"));
}

TEST_F(StrangeFramesRun, OfSixteenBitsInFilesAreReadAsEight) {
  writeSixteenBits("files", true);
  const auto outcome = colonnade("run files.rawlog -o files");
  EXPECT_EQ(0, outcome.exit_code) << outcome.err;
  EXPECT_EQ(kFrames, summary("files")["refused"]["the image has no contrast"].get<int>());
}

TEST_F(StrangeFramesRun, OfOnePixelEndInOneLine) {
  write("dot.rawlog", {cv::Mat(1, 1, CV_8UC1, cv::Scalar(9)), {}});
  const auto outcome = colonnade("run dot.rawlog -o dot");
  EXPECT_EQ(1, outcome.exit_code);
  EXPECT_EQ(1, outcome.errorLines()) << outcome.err;
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("no camera images or depth"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "dot/landmarks.csv"));
}

}  // namespace
}  // namespace colonnade
