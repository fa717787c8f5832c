// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/frames/log_inspection.hpp"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <algorithm>
#include <map>
#include <utility>

#include "camera_views.hpp"
#include "entry_reader.hpp"
#include "stamps.hpp"

namespace colonnade {
namespace {

using mrpt::obs::CObservation;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationImage;

constexpr double kGapFactor = 3.0;
constexpr std::size_t kMostGaps = 10;

CameraSummary summary(const cv::Mat& pixels, const Calibration& calibration,
                      const Eigen::Isometry3d& T_robot_camera) {
  return {pixels.cols, pixels.rows, calibration.pinhole, calibration.lens != LensModel::kNone,
          T_robot_camera};
}

/// One sensor while the log is read.
struct Sensor {
  SensorSummary summary;
  std::vector<double> stamps_s;

  void add(const CObservation& observation, const std::filesystem::path& images_folder,
           std::map<std::string, std::size_t>& skipped) {
    ++summary.count;
    const double stamp_s = secondsOf(observation.timestamp);
    if (!isPlausibleStamp(stamp_s))
      ++summary.invalid_stamps;
    else if (!stamps_s.empty() && stamp_s <= stamps_s.back())
      ++summary.not_growing_stamps;
    else
      stamps_s.push_back(stamp_s);
    describeCameras(observation, images_folder, skipped);
  }

  void describeCameras(const CObservation& observation, const std::filesystem::path& images_folder,
                       std::map<std::string, std::size_t>& skipped) {
    std::string problem;
    std::optional<ImageView> image;
    std::optional<RangeImageView> depth;
    if (const auto* scan = dynamic_cast<const CObservation3DRangeScan*>(&observation)) {
      if (!summary.colour || scan->intensityImage.isExternallyStored())
        image = imageOf(*scan, images_folder, &problem);
      if (!summary.depth)
        depth = depthOf(const_cast<CObservation3DRangeScan&>(*scan), images_folder, &problem);
    } else if (const auto* picture = dynamic_cast<const CObservationImage*>(&observation)) {
      if (!summary.colour || picture->image.isExternallyStored())
        image = imageOf(*picture, images_folder, &problem);
    }
    if (!problem.empty()) ++skipped[problem];
    if (image && !summary.colour)
      summary.colour = colonnade::summary(image->pixels, image->calibration, image->T_robot_camera);
    if (!depth) return;
    summary.depth = colonnade::summary(depth->units, depth->calibration, depth->T_robot_camera);
    summary.depth_unit_m = depth->metres_per_unit;
    summary.depth_along_axis = depth->along_axis;
  }

  SensorSummary finished() {
    if (stamps_s.empty()) return summary;
    summary.first_s = stamps_s.front();
    summary.last_s = stamps_s.back();
    std::vector<double> periods;
    for (std::size_t i = 1; i < stamps_s.size(); ++i)
      periods.push_back(stamps_s[i] - stamps_s[i - 1]);
    if (periods.empty()) return summary;
    const auto middle = periods.begin() + std::ssize(periods) / 2;
    std::nth_element(periods.begin(), middle, periods.end());
    summary.median_period_s = *middle;
    for (std::size_t i = 1; i < stamps_s.size(); ++i) {
      const double length = stamps_s[i] - stamps_s[i - 1];
      if (length <= kGapFactor * summary.median_period_s) continue;
      ++summary.gap_count;
      summary.longest_gaps.push_back({stamps_s[i - 1], length});
    }
    std::stable_sort(summary.longest_gaps.begin(), summary.longest_gaps.end(),
                     [](const auto& a, const auto& b) { return a.length_s > b.length_s; });
    if (summary.longest_gaps.size() > kMostGaps) summary.longest_gaps.resize(kMostGaps);
    return summary;
  }
};

class Inspector {
 public:
  explicit Inspector(const std::filesystem::path& path)
      : reader_(path), images_folder_(imagesFolderOf(path)) {}

  LogInspection run(const std::function<void(double share, std::size_t entries)>& progress) {
    while (const auto entry = reader_.next()) {
      add(*entry);
      if (progress) progress(reader_.stream().progress(), reader_.damage().entries_read);
    }
    result_.file_bytes = reader_.stream().fileSize();
    result_.log_bytes = reader_.stream().offset();
    result_.compressed = reader_.stream().isCompressed();
    for (auto& [key, sensor] : sensors_) finish(sensor);
    result_.damage = reader_.damage();
    return result_;
  }

 private:
  void add(const Entry& entry) {
    using namespace mrpt::obs;
    if (const auto actions = std::dynamic_pointer_cast<CActionCollection>(entry.object)) {
      ++result_.action_collections;
      for (std::size_t i = 0; i < actions->size(); ++i) {
        const CAction* action = &std::as_const(*actions).get(i);
        if (dynamic_cast<const CActionRobotMovement2D*>(action) != nullptr ||
            dynamic_cast<const CActionRobotMovement3D*>(action) != nullptr)
          ++result_.motions;
      }
    } else if (const auto frame = std::dynamic_pointer_cast<CSensoryFrame>(entry.object)) {
      ++result_.sensory_frames;
      for (const auto& observation : *frame) add(*observation);
    } else if (const auto observation = std::dynamic_pointer_cast<CObservation>(entry.object)) {
      ++result_.loose_observations;
      add(*observation);
    }
  }

  void add(const CObservation& observation) {
    std::string name = observation.GetRuntimeClass()->className;
    if (const auto colon = name.rfind(':'); colon != std::string::npos)
      name = name.substr(colon + 1);
    auto& sensor = sensors_[{observation.sensorLabel, name}];
    sensor.summary.label = observation.sensorLabel;
    sensor.summary.class_name = name;
    sensor.add(observation, images_folder_, reader_.damage().skipped);
  }

  void finish(Sensor& sensor) {
    result_.sensors.push_back(sensor.finished());
    if (sensor.stamps_s.empty()) return;
    const auto& last = result_.sensors.back();
    result_.first_s = std::min(result_.first_s.value_or(last.first_s), last.first_s);
    result_.last_s = std::max(result_.last_s.value_or(last.last_s), last.last_s);
  }

  EntryReader reader_;
  std::filesystem::path images_folder_;
  std::map<std::pair<std::string, std::string>, Sensor> sensors_;
  LogInspection result_;
};

}  // namespace

bool LogInspection::hasOdometry() const {
  return motions > 0 || std::any_of(sensors.begin(), sensors.end(), [](const auto& sensor) {
           return sensor.class_name == "CObservationOdometry";
         });
}

const char* LogInspection::format() const {
  const bool pairs = sensory_frames + action_collections > 0;
  if (pairs && loose_observations > 0) return "mixed";
  if (pairs) return "pairs";
  return loose_observations > 0 ? "list" : "empty";
}

LogInspection inspectLog(const std::filesystem::path& path,
                         const std::function<void(double share, std::size_t entries)>& progress) {
  return Inspector(path).run(progress);
}

}  // namespace colonnade
