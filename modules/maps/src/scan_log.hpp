// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/CObservation2DRangeScan.h>

#include <Eigen/Core>
#include <filesystem>
#include <fstream>

#include "colonnade/base/pose2.hpp"

namespace colonnade {

/// scans.rawlog: pairs of the motion used and a scan, written as they come into a temporary
/// neighbour; `finish` gives the file its name, the destructor removes what was not finished.
class ScanLog {
 public:
  explicit ScanLog(std::filesystem::path path);
  ~ScanLog();
  ScanLog(const ScanLog&) = delete;
  ScanLog& operator=(const ScanLog&) = delete;

  /// Adds motion that the next scan's action covers: composed, with its covariance.
  void addMotion(const Pose2& T_previous_robot, const Eigen::Matrix3d& covariance);
  /// Writes one pair: the motion since the former scan, and the scan.
  void addScan(const mrpt::obs::CObservation2DRangeScan::Ptr& scan, double stamp_s);
  std::size_t scans() const { return scans_; }
  /// Flushes to the disk and renames. Without any scan no file is left.
  void finish();

 private:
  void open();
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  std::ofstream file_;
  std::size_t scans_ = 0;
  Pose2 T_scan_robot_;  ///< motion since the former scan
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

}  // namespace colonnade
