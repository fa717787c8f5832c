// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "camera_views.hpp"

#include <mrpt/img/CImage.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/poses/CPose3D.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "colonnade/base/log_path.hpp"

namespace colonnade {
namespace {

Calibration toCalibration(const mrpt::img::TCamera& camera) {
  Calibration result;
  result.pinhole.width_px = static_cast<int>(camera.ncols);
  result.pinhole.height_px = static_cast<int>(camera.nrows);
  result.pinhole.fx_px = camera.fx();
  result.pinhole.fy_px = camera.fy();
  result.pinhole.cx_px = camera.cx();
  result.pinhole.cy_px = camera.cy();
  bool distorted = false;
  for (const double k : camera.dist) distorted |= k != 0.0;
  if (!distorted) return result;
  using mrpt::img::DistortionModel;
  if (camera.distortion == DistortionModel::kannala_brandt) {
    result.lens = LensModel::kFisheye;
    result.distortion = {camera.k1(), camera.k2(), camera.k3(), camera.k4(), 0, 0, 0, 0};
  } else if (camera.distortion == DistortionModel::plumb_bob) {
    result.lens = LensModel::kPlumbBob;
    result.distortion = camera.dist;
  }
  return result;
}

std::optional<cv::Mat> pixelsOf(const mrpt::img::CImage& image,
                                const std::filesystem::path& images_folder, std::string* problem) {
  cv::Mat pixels;
  if (image.isExternallyStored()) {
    const auto file = images_folder / image.getExternalStorageFile();  // an absolute path stays
    std::error_code ignored;
    try {
      if (std::filesystem::is_regular_file(file, ignored))
        pixels = cv::imread(file.string(), cv::IMREAD_ANYCOLOR);
    } catch (const cv::Exception&) {
      pixels.release();
    }
    if (pixels.empty()) {
      *problem = "image file missing or unreadable";
      return std::nullopt;
    }
  } else {
    if (!image.isEmpty()) pixels = image.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
    if (pixels.empty()) {
      *problem = "empty image";
      return std::nullopt;
    }
  }
  if (pixels.type() != CV_8UC1 && pixels.type() != CV_8UC3) {
    *problem = "image is neither 8-bit gray nor 8-bit colour";
    return std::nullopt;
  }
  return pixels;
}

}  // namespace

bool Calibration::operator==(const Calibration& other) const {
  const auto& a = pinhole;
  const auto& b = other.pinhole;
  return a.width_px == b.width_px && a.height_px == b.height_px && a.fx_px == b.fx_px &&
         a.fy_px == b.fy_px && a.cx_px == b.cx_px && a.cy_px == b.cy_px && lens == other.lens &&
         distortion == other.distortion;
}

std::filesystem::path imagesFolderOf(const std::filesystem::path& log) {
  const std::filesystem::path own = logStem(log).string() + "_Images";
  const auto shared = log.parent_path() / "Images";
  std::error_code ignored;
  return !std::filesystem::is_directory(own, ignored) &&
                 std::filesystem::is_directory(shared, ignored)
             ? shared
             : own;
}

Eigen::Matrix3d opticalAxes() {
  Eigen::Matrix3d R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return R;
}

Eigen::Isometry3d toIsometry(const mrpt::poses::CPose3D& pose) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  const auto& R = pose.getRotationMatrix();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) T.linear()(row, column) = R(row, column);
  T.translation() << pose.x(), pose.y(), pose.z();
  return T;
}

std::optional<ImageView> imageOf(const mrpt::obs::CObservation3DRangeScan& scan,
                                 const std::filesystem::path& images_folder, std::string* problem) {
  if (!scan.hasIntensityImage) return std::nullopt;
  auto pixels = pixelsOf(scan.intensityImage, images_folder, problem);
  if (!pixels) return std::nullopt;
  ImageView view;
  view.pixels = *pixels;
  view.calibration = toCalibration(scan.cameraParamsIntensity);
  view.T_robot_camera =
      toIsometry(scan.sensorPose) * toIsometry(scan.relativePoseIntensityWRTDepth);
  return view;
}

std::optional<ImageView> imageOf(const mrpt::obs::CObservationImage& observation,
                                 const std::filesystem::path& images_folder, std::string* problem) {
  auto pixels = pixelsOf(observation.image, images_folder, problem);
  if (!pixels) return std::nullopt;
  ImageView view;
  view.pixels = *pixels;
  view.calibration = toCalibration(observation.cameraParams);
  view.T_robot_camera = toIsometry(observation.cameraPose);
  return view;
}

std::optional<RangeImageView> depthOf(mrpt::obs::CObservation3DRangeScan& scan,
                                      const std::filesystem::path& images_folder,
                                      std::string* problem) {
  if (!scan.hasRangeImage) return std::nullopt;
  if (scan.rangeImage_isExternallyStored()) {
    try {
      mrpt::img::CImage::setImagesPathBase(images_folder.string() + "/");
      scan.load();
    } catch (const std::exception&) {
      *problem = "range file missing or unreadable";
      return std::nullopt;
    }
  }
  const auto rows = static_cast<int>(scan.rangeImage.rows());
  const auto columns = static_cast<int>(scan.rangeImage.cols());
  if (rows == 0 || columns == 0) {
    *problem = "empty depth image";
    return std::nullopt;
  }
  if (!std::isfinite(scan.rangeUnits) || scan.rangeUnits <= 0.0F) {
    *problem = "depth without a unit";
    return std::nullopt;
  }
  RangeImageView view;
  view.units = cv::Mat(rows, columns, CV_16UC1, scan.rangeImage.data());
  view.metres_per_unit = static_cast<double>(scan.rangeUnits);
  view.along_axis = scan.range_is_depth;
  view.calibration = toCalibration(scan.cameraParams);
  view.T_robot_camera = toIsometry(scan.sensorPose);
  view.T_robot_camera.linear() = view.T_robot_camera.linear() * opticalAxes();
  return view;
}

}  // namespace colonnade
