// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// Wheel motion since the former record, in the axes of the robot there.
struct MotionRecord {
  Pose2 T_previous_robot;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< x, y, phi
};

/// An image of a further camera, logged as a CObservationImage.
struct ImageRecord {
  std::string label;  ///< the observation's sensor label
  cv::Mat image;      ///< CV_8UC3 (BGR) or CV_8UC1
  PinholeCamera camera;
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();  ///< optical frame
};

/// What one instant puts into a rawlog. Empty parts are left out.
struct FrameRecord {
  double stamp_s = 0.0;
  cv::Mat image;                            ///< CV_8UC3 (BGR) or CV_8UC1
  std::vector<std::uint8_t> encoded_image;  ///< or a colour JPEG file, kept byte by byte
  cv::Mat depth_units;                      ///< CV_16UC1, registered to the image unless
  double metres_per_unit = 0.001;           ///< T_camera_depth and depth_camera say otherwise
  PinholeCamera camera;
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();  ///< optical frame
  std::optional<PinholeCamera> depth_camera;                         ///< nothing: `camera`
  Eigen::Isometry3d T_camera_depth = Eigen::Isometry3d::Identity();  ///< both optical
  std::optional<MotionRecord> motion;  ///< an action, in the pairs format
  std::optional<Pose2> T_odom_robot;   ///< a CObservationOdometry, in the list format
  std::optional<RangeBearingScan> range_bearing;
  std::vector<ImageRecord> more_images;  ///< of other cameras at the same instant
};

struct RawlogWriterOptions {
  enum class Format { kObservationList, kActionSensoryFramePairs };
  Format format = Format::kObservationList;
  int gz_level = 1;      ///< 0: plain file, 1 fast ... 9 small
  int jpeg_quality = 0;  ///< 0: `image` is stored raw, without loss; else 1 to 100
  std::string camera_label = "RGBD";
  /// Of an action it calls odometry MRPT stores the reading alone and computes a covariance of its
  /// own on loading. true: motions are stored as estimates (emScan2DMatching), which keep theirs.
  bool keep_motion_covariance = false;
};

/// Writes an MRPT rawlog, whole or not at all: into a temporary neighbour that `finish()` renames.
/// The same records give the same bytes.
class RawlogWriter {
 public:
  /// Throws Error when the file cannot be created.
  explicit RawlogWriter(const std::filesystem::path& path, const RawlogWriterOptions& options = {});
  /// Without finish() the temporary file is removed and a former file of that name stays.
  ~RawlogWriter();

  /// Throws Error when the disk takes no more or a part has the wrong type.
  void add(const FrameRecord& record);
  /// Flushes to the disk and gives the file its name.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colonnade
