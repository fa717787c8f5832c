// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "colonnade/frames/frame.hpp"

namespace mrpt::obs {
class CObservation3DRangeScan;
class CObservationImage;
}  // namespace mrpt::obs
namespace mrpt::poses {
class CPose3D;
}

namespace colonnade {

enum class LensModel { kNone, kPlumbBob, kFisheye };

/// What a log says about a camera: pinhole parameters and a lens (OpenCV's order k1 k2 p1 p2 k3 k4
/// k5 k6; fisheye: k1 k2 k3 k4).
struct Calibration {
  PinholeCamera pinhole;
  LensModel lens = LensModel::kNone;
  std::array<double, 8> distortion{};

  bool operator==(const Calibration& other) const;
};

/// An image as the log has it, before undistortion.
struct ImageView {
  cv::Mat pixels;  ///< CV_8UC1 or CV_8UC3 (BGR)
  Calibration calibration;
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();  ///< optical frame
};

/// A depth image as the log has it.
struct RangeImageView {
  cv::Mat units;  ///< CV_16UC1
  double metres_per_unit = 0.001;
  bool along_axis = true;  ///< depth along the optical axis; false: distance along the ray
  Calibration calibration;
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();  ///< optical frame
};

/// Where the pictures lie that a log keeps in files of their own: STEM_Images beside it, as
/// rawlog-edit makes it, else Images. (CRawlog::detectImagesDirectory of MRPT 2.5.8 joins folder
/// and name without a slash.)
std::filesystem::path imagesFolderOf(const std::filesystem::path& log);

/// Turns MRPT observations into views. Images stored outside the log are read from
/// `images_folder`. Nothing comes back when there is no such part; `problem` then says why when the
/// log promised one.
std::optional<ImageView> imageOf(const mrpt::obs::CObservation3DRangeScan& scan,
                                 const std::filesystem::path& images_folder, std::string* problem);
std::optional<ImageView> imageOf(const mrpt::obs::CObservationImage& observation,
                                 const std::filesystem::path& images_folder, std::string* problem);
std::optional<RangeImageView> depthOf(mrpt::obs::CObservation3DRangeScan& scan,
                                      const std::filesystem::path& images_folder,
                                      std::string* problem);

Eigen::Isometry3d toIsometry(const mrpt::poses::CPose3D& pose);

/// The optical frame (x right, y down, z forward) in a sensor frame with x forward, y left, z up.
Eigen::Matrix3d opticalAxes();

}  // namespace colonnade
