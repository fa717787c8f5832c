// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "landmarks_map.hpp"

#include <mrpt/maps/CMultiMetricMap.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "colonnade/base/error.hpp"
#include "colonnade/maps/landmarks_map_file.hpp"
#include "mrpt_file.hpp"

namespace colonnade {
namespace {

using mrpt::maps::CLandmark;

constexpr CLandmark::TLandmarkID kSecondEnd = 1'000'000'000;
/// Landmarks stand on the floor by definition; MRPT wants an invertible covariance all the same.
constexpr float kHeightVariance_m2 = 1e-6F;

float finite(double value) { return std::isfinite(value) ? static_cast<float>(value) : 0.0F; }

CLandmark toLandmark(const LandmarkRecord& record, const Eigen::Vector2d& p_world,
                     bool second_end) {
  CLandmark landmark;
  landmark.ID = number(record.id) + (second_end ? kSecondEnd : 0);
  landmark.pose_mean = {p_world.x(), p_world.y(), 0.0};
  landmark.pose_cov_11 = finite(record.covariance(0, 0));
  landmark.pose_cov_12 = finite(record.covariance(0, 1));
  landmark.pose_cov_22 = finite(record.covariance(1, 1));
  landmark.pose_cov_33 = kHeightVariance_m2;
  landmark.seenTimesCount = static_cast<std::uint32_t>(std::max(record.observations, 0));
  landmark.timestampLastSeen = mrpt::Clock::fromDouble(record.last_stamp_s);
  landmark.createOneFeature();
  auto& feature = landmark.features.front();
  feature.user_flags = static_cast<std::uint8_t>(1 + static_cast<int>(record.kind));
  feature.keypoint.ID =
      record.pair_id ? 1 + static_cast<std::uint64_t>(number(*record.pair_id)) : 0;
  feature.orientation = finite(record.direction.value_or(0.0));
  feature.keypoint.response = finite(record.direction_sigma);
  // MRPT leaves these four unset and writes them: same input, same bytes.
  feature.x2[0] = feature.x2[1] = feature.y2[0] = feature.y2[1] = 0.0F;
  return landmark;
}

LandmarkRecord toRecord(const CLandmark& landmark) {
  LandmarkRecord record;
  record.id = LandmarkId{static_cast<std::int32_t>(landmark.ID % kSecondEnd)};
  record.p_world = {landmark.pose_mean.x, landmark.pose_mean.y};
  record.extent_a = record.extent_b = record.p_world;
  record.covariance << landmark.pose_cov_11, landmark.pose_cov_12, landmark.pose_cov_12,
      landmark.pose_cov_22;
  record.observations = static_cast<int>(landmark.seenTimesCount);
  if (landmark.timestampLastSeen != INVALID_TIMESTAMP)
    record.first_stamp_s = record.last_stamp_s = mrpt::Clock::toDouble(landmark.timestampLastSeen);
  if (landmark.features.empty()) return record;
  const auto& feature = landmark.features.front();
  if (feature.user_flags < 1 || feature.user_flags > kLandmarkKinds) return record;
  record.kind = static_cast<LandmarkKind>(feature.user_flags - 1);
  if (feature.keypoint.ID > 0 && feature.keypoint.ID < kSecondEnd)
    record.pair_id = LandmarkId{static_cast<std::int32_t>(feature.keypoint.ID - 1)};
  if (record.kind == LandmarkKind::kFloorEdge) {
    record.direction = feature.orientation;
    record.direction_sigma = feature.keypoint.response;
  }
  return record;
}

}  // namespace

mrpt::maps::CLandmarksMap::Ptr toLandmarksMap(const LandmarkMap& landmarks) {
  auto map = mrpt::maps::CLandmarksMap::Create();
  for (const auto& record : landmarks) {
    if (record.kind != LandmarkKind::kFloorEdge) {
      map->landmarks.push_back(toLandmark(record, record.p_world, false));
      continue;
    }
    map->landmarks.push_back(toLandmark(record, record.extent_a, false));
    map->landmarks.push_back(toLandmark(record, record.extent_b, true));
  }
  return map;
}

LandmarkMap fromLandmarksMap(const mrpt::maps::CLandmarksMap& map) {
  std::map<LandmarkId, LandmarkRecord> records;
  std::vector<LandmarkRecord> without_id;
  for (const auto& landmark : map.landmarks) {
    if (landmark.ID >= kSecondEnd) continue;
    const auto record = toRecord(landmark);
    if (landmark.ID < 0 || !records.emplace(record.id, record).second) without_id.push_back(record);
  }
  for (auto& record : without_id) {
    record.id = LandmarkId{records.empty() ? 0 : number(records.rbegin()->first) + 1};
    records.emplace(record.id, record);
  }
  for (const auto& landmark : map.landmarks) {
    if (landmark.ID < kSecondEnd) continue;
    const auto found =
        records.find(LandmarkId{static_cast<std::int32_t>(landmark.ID - kSecondEnd)});
    if (found == records.end()) continue;
    auto& edge = found->second;
    edge.extent_b = {landmark.pose_mean.x, landmark.pose_mean.y};
    edge.p_world = 0.5 * (edge.extent_a + edge.extent_b);
  }
  LandmarkMap result;
  for (const auto& [id, record] : records) result.push_back(record);
  return result;
}

void writeLandmarksMap(const std::filesystem::path& path, const LandmarkMap& landmarks) {
  writeObject(path, *toLandmarksMap(landmarks));
}

LandmarkMap readLandmarksMap(const std::filesystem::path& path) {
  const auto object = readObject(path);
  if (const auto map = std::dynamic_pointer_cast<mrpt::maps::CLandmarksMap>(object))
    return fromLandmarksMap(*map);
  if (const auto maps = std::dynamic_pointer_cast<mrpt::maps::CMultiMetricMap>(object))
    if (const auto map = maps->mapByClass<mrpt::maps::CLandmarksMap>())
      return fromLandmarksMap(*map);
  throw Error(path.string() + ": holds a " + object->GetRuntimeClass()->className +
              ", wanted a CLandmarksMap or a CMultiMetricMap with one");
}

}  // namespace colonnade
