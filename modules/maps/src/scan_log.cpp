// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "scan_log.hpp"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/error.hpp"
#include "mrpt_file.hpp"

namespace colonnade {
namespace {

/// Particle filters draw from the motion and need a covariance they can factorise.
constexpr double kLeastVariance = 1e-10;  ///< metres or radians, squared

}  // namespace

ScanLog::ScanLog(std::filesystem::path path)
    : path_(std::move(path)),
      temporary_(path_.parent_path() /
                 (".partial." + std::to_string(::getpid()) + "." + path_.filename().string())) {}

ScanLog::~ScanLog() {
  if (!file_.is_open()) return;
  file_.close();
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void ScanLog::fail() const {
  throw Error(path_.string() + ": cannot be written after " + std::to_string(scans_) +
              " scans: " + std::strerror(errno));
}

void ScanLog::open() {
  file_.open(temporary_, std::ios::binary | std::ios::trunc);
  if (!file_) fail();
}

void ScanLog::addMotion(const Pose2& T_previous_robot, const Eigen::Matrix3d& covariance) {
  Eigen::Matrix3d J_before;
  Eigen::Matrix3d J_step;
  T_scan_robot_ = compose(T_scan_robot_, T_previous_robot, &J_before, &J_step);
  covariance_ =
      J_before * covariance_ * J_before.transpose() + J_step * covariance * J_step.transpose();
}

void ScanLog::addScan(const mrpt::obs::CObservation2DRangeScan::Ptr& scan, double stamp_s) {
  if (!file_.is_open()) open();
  mrpt::obs::CActionRobotMovement2D motion;
  motion.timestamp = mrpt::Clock::fromDouble(stamp_s);
  // The only kind whose own covariance MRPT stores; for odometry it stores a noise model instead.
  motion.estimationMethod = mrpt::obs::CActionRobotMovement2D::emScan2DMatching;
  auto change = mrpt::poses::CPosePDFGaussian::Create(toMrpt(T_scan_robot_, covariance_));
  for (int i = 0; i < 3; ++i) change->cov(i, i) += kLeastVariance;
  motion.poseChange = change;
  mrpt::obs::CActionCollection actions;
  actions.insert(motion);
  mrpt::obs::CSensoryFrame observations;
  observations.insert(scan);
  const std::string bytes = serialised(actions) + serialised(observations);
  errno = 0;
  file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file_) fail();
  ++scans_;
  T_scan_robot_ = Pose2{};
  covariance_.setZero();
}

void ScanLog::finish() {
  if (!file_.is_open()) return;
  errno = 0;
  file_.close();
  if (!file_) fail();
  writeFileAtomically(path_, [&](const std::filesystem::path& temporary) {
    std::filesystem::rename(temporary_, temporary);
  });
}

}  // namespace colonnade
