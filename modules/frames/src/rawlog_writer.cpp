// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/frames/rawlog_writer.hpp"

#include <fcntl.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/archiveFrom_std_vector.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>

#include "colonnade/base/error.hpp"
#include "observation_record.hpp"
#include "stamps.hpp"

namespace colonnade {
namespace {

mrpt::obs::CActionCollection actionsOf(const FrameRecord& record, bool keep_covariance) {
  const MotionRecord motion = record.motion.value_or(MotionRecord{});
  const auto& T = motion.T_previous_robot;
  mrpt::obs::CActionRobotMovement2D movement;
  movement.timestamp = stampOf(record.stamp_s);
  movement.estimationMethod = keep_covariance ? mrpt::obs::CActionRobotMovement2D::emScan2DMatching
                                              : mrpt::obs::CActionRobotMovement2D::emOdometry;
  movement.rawOdometryIncrementReading = mrpt::poses::CPose2D(T.x, T.y, T.phi);
  auto change = std::make_shared<mrpt::poses::CPosePDFGaussian>();
  change->mean = mrpt::poses::CPose2D(T.x, T.y, T.phi);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      change->cov(row, column) = motion.covariance(row, column);
  movement.poseChange = mrpt::poses::CPosePDF::Ptr(change);
  mrpt::obs::CActionCollection actions;
  actions.insert(movement);
  return actions;
}

}  // namespace

struct RawlogWriter::Impl {
  std::filesystem::path path, temporary;
  RawlogWriterOptions options;
  gzFile file = nullptr;

  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(path.string() + ": cannot be written: " + reason);
  }

  void write(const std::vector<std::uint8_t>& bytes) {
    if (bytes.empty()) return;
    errno = 0;
    if (gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size())) ==
        static_cast<int>(bytes.size()))
      return;
    const int system_error = errno;
    int code = 0;
    const char* text = gzerror(file, &code);
    fail(system_error != 0 ? std::strerror(system_error) : text);
  }
};

RawlogWriter::RawlogWriter(const std::filesystem::path& path, const RawlogWriterOptions& options)
    : impl_(std::make_unique<Impl>()) {
  impl_->path = path;
  impl_->options = options;
  impl_->temporary = path.parent_path() /
                     (".partial." + std::to_string(::getpid()) + "." + path.filename().string());
  const std::string mode =
      options.gz_level == 0 ? "wbeT" : "wbe" + std::to_string(options.gz_level);
  errno = 0;
  impl_->file = gzopen(impl_->temporary.c_str(), mode.c_str());
  if (!impl_->file) impl_->fail(std::strerror(errno));
  gzbuffer(impl_->file, 256 * 1024);
}

RawlogWriter::~RawlogWriter() {
  if (!impl_->file) return;
  gzclose(impl_->file);
  std::error_code ignored;
  std::filesystem::remove(impl_->temporary, ignored);
}

void RawlogWriter::add(const FrameRecord& record) {
  std::vector<std::uint8_t> bytes;
  {
    auto archive = mrpt::serialization::archiveFrom(bytes);
    const auto observations = observationsOf(record, impl_->options);
    if (impl_->options.format == RawlogWriterOptions::Format::kActionSensoryFramePairs) {
      archive << actionsOf(record, impl_->options.keep_motion_covariance);
      mrpt::obs::CSensoryFrame frame;
      for (const auto& observation : observations) frame.insert(observation);
      archive << frame;
    } else {
      if (record.T_odom_robot) {
        mrpt::obs::CObservationOdometry odometry;
        odometry.timestamp = stampOf(record.stamp_s);
        odometry.sensorLabel = "ODOMETRY";
        odometry.odometry = mrpt::poses::CPose2D(record.T_odom_robot->x, record.T_odom_robot->y,
                                                 record.T_odom_robot->phi);
        archive << odometry;
      }
      for (const auto& observation : observations) archive << *observation;
    }
  }
  impl_->write(withImages(std::move(bytes), record, impl_->options.jpeg_quality));
}

void RawlogWriter::finish() {
  errno = 0;
  const int status = gzclose(impl_->file);
  impl_->file = nullptr;
  std::error_code error;
  if (status != Z_OK) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "zlib reports an error";
    std::filesystem::remove(impl_->temporary, error);
    impl_->fail(reason);
  }
  const int file = ::open(impl_->temporary.c_str(), O_RDONLY | O_CLOEXEC);
  if (file >= 0) {
    ::fsync(file);
    ::close(file);
  }
  std::filesystem::rename(impl_->temporary, impl_->path, error);
  if (error) {
    std::error_code ignored;
    std::filesystem::remove(impl_->temporary, ignored);
    impl_->fail(error.message());
  }
}

}  // namespace colonnade
