// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// kf_slam_log LOG TRAJECTORY.tum LANDMARKS.csv RANGE_SIGMA_M BEARING_SIGMA_DEG [hidden]
// MRPT's CRangeBearingKFSLAM2D (kfEKFNaive, known identities, or JCBB with `hidden`) on a log of
// action and sensory-frame pairs, for comparison; scripts/range_bearing_table.sh uses it.
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/slam/CRangeBearingKFSLAM2D.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/trajectory.hpp"
#include "colonnade/maps/landmark_csv.hpp"

namespace {

using mrpt::obs::CObservationBearingRange;

colonnade::LandmarkMap mapOf(const mrpt::slam::CRangeBearingKFSLAM2D& filter) {
  mrpt::poses::CPosePDFGaussian pose;
  std::vector<mrpt::math::TPoint2D> points;
  std::map<unsigned int, mrpt::maps::CLandmark::TLandmarkID> identities;
  mrpt::math::CVectorDouble state;
  mrpt::math::CMatrixDouble P;
  filter.getCurrentState(pose, points, identities, state, P);
  colonnade::LandmarkMap map;
  for (unsigned int i = 0; i < points.size(); ++i) {
    colonnade::LandmarkRecord record;
    record.id = colonnade::LandmarkId{static_cast<std::int32_t>(identities.at(i))};
    record.p_world = record.extent_a = record.extent_b = {points[i].x, points[i].y};
    const int at = 3 + 2 * static_cast<int>(i);
    record.covariance << P(at, at), P(at, at + 1), P(at + 1, at), P(at + 1, at + 1);
    map.push_back(record);
  }
  std::sort(map.begin(), map.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return map;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 6) {
    std::fprintf(stderr, "usage: %s LOG TUM CSV RANGE_SIGMA_M BEARING_SIGMA_DEG [hidden]\n", *argv);
    return 2;
  }
  mrpt::slam::CRangeBearingKFSLAM2D filter;
  filter.setMinLoggingLevel(mrpt::system::LVL_ERROR);
  filter.KF_options.verbosity_level = mrpt::system::LVL_ERROR;
  filter.KF_options.method = mrpt::bayes::kfEKFNaive;
  filter.options.std_sensor_range = std::stof(argv[4]);
  filter.options.std_sensor_yaw = static_cast<float>(colonnade::radians(std::stod(argv[5])));
  filter.options.data_assoc_method = mrpt::slam::assocJCBB;
  const bool hidden = argc > 6 && std::string(argv[6]) == "hidden";

  mrpt::io::CFileGZInputStream file(argv[1]);
  auto archive = mrpt::serialization::archiveFrom(file);
  mrpt::obs::CActionCollection::Ptr action;
  mrpt::obs::CSensoryFrame::Ptr frame;
  mrpt::obs::CObservation::Ptr loose;
  std::size_t entry = 0;
  colonnade::Trajectory trajectory;
  while (mrpt::obs::CRawlog::getActionObservationPairOrObservation(archive, action, frame, loose,
                                                                   entry)) {
    const auto observation = frame->getObservationByClass<CObservationBearingRange>();
    if (hidden)
      for (auto& reading : observation->sensedData) reading.landmarkID = -1;
    filter.processActionObservation(action, frame);
    mrpt::poses::CPosePDFGaussian pose;
    filter.getCurrentRobotPose(pose);
    const colonnade::Pose2 T_world_robot{pose.mean.x(), pose.mean.y(), pose.mean.phi()};
    trajectory.push_back(
        {mrpt::Clock::toDouble(observation->timestamp), T_world_robot.toIsometry3()});
  }
  colonnade::writeTum(argv[2], trajectory);
  colonnade::writeLandmarksCsv(argv[3], mapOf(filter));
}
