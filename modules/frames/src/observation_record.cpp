// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "observation_record.hpp"

#include <mrpt/img/CImage.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/archiveFrom_std_vector.h>

#include <algorithm>
#include <cstring>
#include <opencv2/imgcodecs.hpp>

#include "camera_views.hpp"
#include "colonnade/base/error.hpp"
#include "stamps.hpp"

namespace colonnade {
namespace {

using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationBearingRange;
using mrpt::obs::CObservationImage;

/// Stands for an image until it is encoded: 0 the first camera's, then `more_images`.
std::string imageMark(std::size_t index) {
  return "\x01 colonnade: image " + std::to_string(index) + " goes here \x02";
}

mrpt::poses::CPose3D toPose(const Eigen::Isometry3d& T) {
  mrpt::math::CMatrixDouble44 matrix;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix(row, column) = T.matrix()(row, column);
  return mrpt::poses::CPose3D(matrix);
}

mrpt::img::TCamera toCamera(const PinholeCamera& camera) {
  mrpt::img::TCamera result;
  result.ncols = static_cast<std::uint32_t>(camera.width_px);
  result.nrows = static_cast<std::uint32_t>(camera.height_px);
  result.setIntrinsicParamsFromValues(camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px);
  return result;
}

bool hasImage(const FrameRecord& record) {
  return !record.image.empty() || !record.encoded_image.empty();
}

mrpt::img::CImage markedImage(std::size_t index) {
  mrpt::img::CImage image;
  image.setExternalStorage(imageMark(index));
  return image;
}

std::shared_ptr<CObservationImage> imageOf(const PinholeCamera& camera,
                                           const Eigen::Isometry3d& T_robot_camera,
                                           std::size_t index) {
  auto observation = std::make_shared<CObservationImage>();
  observation->cameraPose = toPose(T_robot_camera);
  observation->cameraParams = toCamera(camera);
  observation->image = markedImage(index);
  return observation;
}

std::shared_ptr<CObservation3DRangeScan> scanOf(const FrameRecord& record) {
  if (record.depth_units.type() != CV_16UC1) throw Error("depth to be written is not 16-bit");
  auto scan = std::make_shared<CObservation3DRangeScan>();
  // MRPT's sensor frame has x forward; the colour camera hangs on it by an optical pose.
  const Eigen::Isometry3d T_optical_sensor{Eigen::Isometry3d(opticalAxes()).inverse()};
  scan->sensorPose = toPose(record.T_robot_camera * record.T_camera_depth * T_optical_sensor);
  scan->relativePoseIntensityWRTDepth =
      toPose((record.T_camera_depth * T_optical_sensor).inverse());
  scan->cameraParams = toCamera(record.depth_camera.value_or(record.camera));
  scan->cameraParamsIntensity = toCamera(record.camera);
  scan->hasRangeImage = true;
  scan->range_is_depth = true;
  scan->rangeUnits = static_cast<float>(record.metres_per_unit);
  scan->maxRange = static_cast<float>(65535.0 * record.metres_per_unit);
  scan->rangeImage_setSize(record.depth_units.rows, record.depth_units.cols);
  for (int row = 0; row < record.depth_units.rows; ++row)
    std::memcpy(&scan->rangeImage(row, 0), record.depth_units.ptr(row),
                static_cast<std::size_t>(record.depth_units.cols) * sizeof(std::uint16_t));
  scan->hasIntensityImage = hasImage(record);
  if (scan->hasIntensityImage) scan->intensityImage = markedImage(0);
  return scan;
}

std::shared_ptr<CObservationBearingRange> landmarksOf(const RangeBearingScan& scan) {
  auto observation = std::make_shared<CObservationBearingRange>();
  observation->sensorLocationOnRobot = toPose(scan.T_robot_sensor);
  observation->sensor_std_range = static_cast<float>(scan.range_sigma_m);
  observation->sensor_std_yaw = static_cast<float>(scan.yaw_sigma);
  observation->validCovariances = false;
  for (const auto& reading : scan.readings) {
    auto& entry = observation->sensedData.emplace_back();
    entry.range = static_cast<float>(reading.range_m);
    entry.yaw = static_cast<float>(reading.yaw);
    entry.pitch = static_cast<float>(reading.pitch);
    entry.landmarkID = reading.id;
  }
  return observation;
}

void append(std::vector<std::uint8_t>& bytes, const void* data, std::size_t count) {
  const auto* from = static_cast<const std::uint8_t*>(data);
  bytes.insert(bytes.end(), from, from + count);
}

void appendNumber(std::vector<std::uint8_t>& bytes, std::int32_t value) {
  append(bytes, &value,
         sizeof value);  // MRPT's streams are little-endian, as the machines we run on
}

/// What stands behind the header of a CImage, version 9: external flag, colour flag, size, pixels.
/// `jpeg`: the colour image in that form already, or empty.
std::vector<std::uint8_t> imageBody(const cv::Mat& image, std::vector<std::uint8_t> jpeg,
                                    const PinholeCamera& camera, int jpeg_quality) {
  cv::Size size = image.size();
  const bool colour = !jpeg.empty() || image.type() == CV_8UC3;
  if (!jpeg.empty()) {
    size = {camera.width_px, camera.height_px};
  } else if (!colour && image.type() != CV_8UC1) {
    throw Error("image to be written is neither 8-bit gray nor 8-bit colour");
  } else if (colour && jpeg_quality > 0) {
    cv::imencode(".jpg", image, jpeg, {cv::IMWRITE_JPEG_QUALITY, jpeg_quality});
  }
  std::vector<std::uint8_t> body{0, static_cast<std::uint8_t>(colour)};
  const bool raw_colour = colour && jpeg.empty();
  appendNumber(body, raw_colour ? -size.width : size.width);  // negative: pixels are raw
  appendNumber(body, raw_colour ? -size.height : size.height);
  if (!jpeg.empty()) {
    appendNumber(body, static_cast<std::int32_t>(jpeg.size()));
    append(body, jpeg.data(), jpeg.size());
    return body;
  }
  const std::size_t row_bytes =
      static_cast<std::size_t>(size.width) * static_cast<std::size_t>(image.channels());
  if (!colour) {
    appendNumber(body, 0);  // origin: top left
    appendNumber(body, static_cast<std::int32_t>(row_bytes) * size.height);
    appendNumber(body, CV_8U);
    body.push_back(0);  // not zipped
  }
  for (int row = 0; row < size.height; ++row) append(body, image.ptr(row), row_bytes);
  return body;
}

/// Puts an image in the place of its mark, if that is there.
std::vector<std::uint8_t> withBody(std::vector<std::uint8_t> objects, std::size_t index,
                                   const cv::Mat& image, const std::vector<std::uint8_t>& jpeg,
                                   const PinholeCamera& camera, int jpeg_quality) {
  // Between the version of CImage and its end flag: external = 1, length of the name, the name.
  const std::string name = imageMark(index);
  std::vector<std::uint8_t> mark{1};
  appendNumber(mark, static_cast<std::int32_t>(name.size()));
  append(mark, name.data(), name.size());
  const auto found = std::search(objects.begin(), objects.end(), mark.begin(), mark.end());
  if (found == objects.end()) return objects;
  const auto body = imageBody(image, jpeg, camera, jpeg_quality);
  std::vector<std::uint8_t> result;
  result.reserve(objects.size() + body.size());
  result.insert(result.end(), objects.begin(), found);
  result.insert(result.end(), body.begin(), body.end());
  result.insert(result.end(), found + static_cast<std::ptrdiff_t>(mark.size()), objects.end());
  return result;
}

}  // namespace

std::vector<mrpt::obs::CObservation::Ptr> observationsOf(const FrameRecord& record,
                                                         const RawlogWriterOptions& options) {
  std::vector<mrpt::obs::CObservation::Ptr> observations;
  if (!record.depth_units.empty()) {
    observations.push_back(scanOf(record));
  } else if (hasImage(record)) {
    observations.push_back(imageOf(record.camera, record.T_robot_camera, 0));
  }
  for (auto& observation : observations) observation->sensorLabel = options.camera_label;
  for (std::size_t i = 0; i < record.more_images.size(); ++i) {
    const auto& more = record.more_images[i];
    observations.push_back(imageOf(more.camera, more.T_robot_camera, i + 1));
    observations.back()->sensorLabel = more.label;
  }
  if (record.range_bearing) {
    observations.push_back(landmarksOf(*record.range_bearing));
    observations.back()->sensorLabel = "LANDMARKS";
  }
  for (auto& observation : observations) observation->timestamp = stampOf(record.stamp_s);
  return observations;
}

std::vector<std::uint8_t> withImages(std::vector<std::uint8_t> objects, const FrameRecord& record,
                                     int jpeg_quality) {
  objects = withBody(std::move(objects), 0, record.image, record.encoded_image, record.camera,
                     jpeg_quality);
  for (std::size_t i = 0; i < record.more_images.size(); ++i) {
    const auto& more = record.more_images[i];
    objects = withBody(std::move(objects), i + 1, more.image, {}, more.camera, jpeg_quality);
  }
  return objects;
}

}  // namespace colonnade
