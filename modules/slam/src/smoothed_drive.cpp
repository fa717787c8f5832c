// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/smoothed_drive.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "colonnade/base/angle.hpp"
#include "colonnade/filter/gate.hpp"
#include "colonnade/slam/identity_score.hpp"
#include "known_map.hpp"

namespace colonnade {
namespace {

constexpr double kSuspect = 0.999999;
constexpr double kWorthwhile = 0.01;  ///< share of the cost

/// The same drive past fewer points, in this order; all of its sightings are of them.
void keepPoints(Drive& drive, const std::vector<std::size_t>& kept) {
  std::vector<std::size_t> place(drive.points_world.size(), 0);
  std::vector<Eigen::Vector2d> points;
  std::vector<bool> nameless;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    place[kept[k]] = k;
    points.push_back(drive.points_world[kept[k]]);
    nameless.push_back(drive.nameless[kept[k]]);
  }
  for (Drive::Sighting& sighting : drive.sightings) sighting.point = place[sighting.point];
  for (Drive::Depth& depth : drive.depths) depth.point = place[depth.point];
  drive.points_world = std::move(points);
  drive.nameless = std::move(nameless);
}

/// Takes merged landmarks from the map, whose sightings the others inherit. `places` of points.
void unite(const std::vector<Smoothing::Merger>& mergers, const std::vector<std::size_t>& places,
           SmoothedDrive& result) {
  std::vector<bool> stays(result.map.size(), true);
  for (const auto& [point, into] : mergers) {
    LandmarkRecord &gone = result.map[places[point]], &heir = result.map[places[into]];
    stays[places[point]] = false;
    heir.observations += gone.observations;
    heir.first_stamp_s = std::min(heir.first_stamp_s, gone.first_stamp_s);
    heir.last_stamp_s = std::max(heir.last_stamp_s, gone.last_stamp_s);
    for (auto& [landmark, name] : result.merged)
      if (name == gone.id) name = heir.id;
    result.merged.emplace(gone.id, heir.id);
  }
  std::vector<Eigen::Index> rows;
  LandmarkMap map;
  for (std::size_t i = 0; i < stays.size(); ++i) {
    if (!stays[i]) continue;
    map.push_back(result.map[i]);
    for (const std::size_t row : {2 * i, 2 * i + 1}) rows.push_back(static_cast<Eigen::Index>(row));
  }
  result.map = std::move(map);
  if (result.covariance.size() > 0) result.covariance = result.covariance(rows, rows).eval();
}

/// The map's places and their covariance as smoothed, moved on by T; a landmark none of whose
/// readings was `used` stays as it is.
void place(const std::vector<Eigen::Vector2d>& points, const std::vector<double>& used,
           const Pose2& T, SmoothedDrive& result) {
  const Eigen::Matrix2d R = T.rotation();
  Eigen::MatrixXd& C = result.covariance = result.how.covariance;
  for (Eigen::Index i = 0; i < C.rows(); i += 2) {
    C.middleRows<2>(i) = (R * C.middleRows<2>(i)).eval();
    C.middleCols<2>(i) = (C.middleCols<2>(i) * R.transpose()).eval();
  }
  C = (0.5 * (C + C.transpose())).eval();
  for (std::size_t i = 0; i < result.map.size(); ++i) {
    LandmarkRecord& landmark = result.map[i];
    const auto row = static_cast<Eigen::Index>(2 * i);
    if (used[i] > 0.0) {
      landmark.p_world = transform(T, points[i]);
      landmark.extent_a = landmark.extent_b = landmark.p_world;
    }
    if (C.size() == 0) continue;
    if (used[i] > 0.0)
      landmark.covariance = C.block<2, 2>(row, row);
    else
      standAlone(C, i, landmark.covariance);
  }
}

/// What the sensor of a drive is off by that was smoothed as if it were right: were that part of
/// the estimate, the cost would fall by more than noise explains, and not by next to nothing.
std::optional<SensorEstimate> suspectedErrors(const Drive& drive, double cost,
                                              const SensorErrors& sigmas) {
  const auto fit = sensorFit(drive, sigmas);
  const double noise = chiSquareQuantile(kSuspect, SensorErrors::kSize);
  if (!fit || !(fit->gain > std::max(noise, kWorthwhile * cost))) return std::nullopt;
  return fit->estimate;
}

std::optional<double> costOfIdentities(Drive drive, const std::vector<int>& identities,
                                       double gate_probability) {
  std::vector<std::pair<int, LandmarkId>> readings;
  for (std::size_t i = 0; i < identities.size(); ++i)
    readings.emplace_back(identities[i],
                          LandmarkId{static_cast<std::int32_t>(drive.sightings[i].point)});
  const auto bearers = bearersOf(readings);
  if (bearers.empty()) return std::nullopt;
  for (std::size_t i = 0; i < identities.size(); ++i)
    if (const auto bearer = bearers.find(identities[i]); bearer != bearers.end())
      drive.sightings[i].point = static_cast<std::size_t>(number(bearer->second));
  for (Drive::Sighting& sighting : drive.sightings) sighting.used = true;
  drive.nameless.clear();
  return smoothedCost(std::move(drive), gate_probability);
}

/// A drive as it is known by now, past the landmarks of a map.
struct Prepared {
  Drive drive;
  std::vector<int> identities;      ///< of the sightings, as the log tells them
  std::vector<std::size_t> places;  ///< of the points, in the map
  std::size_t unexplained = 0;      ///< readings of no landmark
  std::optional<KnownMap> known;    ///< what a loaded map says of it beforehand
};

/// Nothing where the loaded map is of no use.
std::optional<Prepared> prepared(const DriveRecord& record, const Explanation& explanation,
                                 const RangeBearingOptions& options,
                                 const std::optional<Resumption>& from) {
  const LandmarkMap& map = explanation.map;
  Prepared result;
  Drive& drive = result.drive;
  drive.T_world_robot = explanation.T_world_robot;
  drive.motions = record.motions;
  if (options.estimate_sensor)
    drive.sensor = {explanation.sensor.value_or(SensorErrors{}), options.sensor_sigmas};
  std::map<LandmarkId, std::size_t> point_of_landmark;
  std::map<int, std::size_t> point_of_identity;
  for (const LandmarkRecord& landmark : map) {
    const std::size_t point = drive.points_world.size();
    point_of_landmark[landmark.id] = point;
    const auto identity = explanation.identities.find(landmark.id);
    const bool named = identity != explanation.identities.end();
    if (named) point_of_identity[identity->second] = point;
    drive.nameless.push_back(!named);
    drive.points_world.push_back(landmark.p_world);
  }
  std::vector<bool> seen(map.size(), false);
  for (std::size_t i = 0; i < record.readings.size(); ++i) {
    const DriveRecord::Reading& reading = record.readings[i];
    const auto& decided = explanation.decisions[i];
    if (!reading.measurement) continue;
    std::optional<std::size_t> point;
    const auto bearer = point_of_identity.find(reading.identity);
    if (options.use_ids && reading.identity >= 0 && bearer != point_of_identity.end()) {
      point = bearer->second;
    } else if (decided) {
      const auto landmark = point_of_landmark.find(*decided);
      if (landmark != point_of_landmark.end()) point = landmark->second;
    }
    if (!point) {
      ++result.unexplained;
      continue;
    }
    drive.sightings.push_back({reading.frame, *point, *reading.measurement, explanation.used[i]});
    result.identities.push_back(reading.identity);
    if (options.bearing_only && !options.wait_for_parallax && !seen[*point] &&
        !(from && from->map.state.find(map[*point].id)))
      drive.depths.push_back({reading.frame, *point, reading.measurement->p_robot_camera,
                              options.inverse_depth, options.inverse_depth_sigma});
    seen[*point] = true;
  }
  result.places.resize(map.size());
  std::iota(result.places.begin(), result.places.end(), std::size_t{0});
  if (!from) return result;
  result.known.emplace(*from, map, seen);
  if (!result.known->isUsable()) return std::nullopt;
  result.places = result.known->kept();
  keepPoints(drive, result.places);
  drive.prior = result.known->prior(record.motions.front());
  if (from->localize) std::fill_n(drive.nameless.begin(), drive.prior->points_world.size(), false);
  return result;
}

/// Minus twice the logarithm of the probability that a reading is of something that is one in
/// `share` of the readings and anywhere in view, less that of a right reading that fits exactly.
double surpriseOf(double share, const Measurement& measurement,
                  const RangeBearingOptions& options) {
  return -2.0 * std::log(share / options.viewFor(measurement)) -
         std::log((2.0 * kPi * measurement.R).determinant());
}

/// SmoothedDrive::surprise.
double surpriseOf(const Drive& drive, const std::vector<double>& used, double cost,
                  std::size_t unexplained, const RangeBearingOptions& options) {
  double birth = 0.0, outlier = 0.0;
  for (const Drive::Sighting& sighting : drive.sightings) {
    birth += surpriseOf(options.birth_share, sighting.measurement, options);
    outlier += surpriseOf(options.outlier_share, sighting.measurement, options);
  }
  const auto readings = static_cast<double>(drive.sightings.size());
  const auto landmarks = std::count_if(used.begin(), used.end(), [](double n) { return n > 0.0; });
  return cost +
         (static_cast<double>(landmarks) * birth + static_cast<double>(unexplained) * outlier) /
             readings;
}

/// SmoothedDrive::decisions.
std::vector<std::optional<LandmarkId>> finalDecisions(
    std::vector<std::optional<LandmarkId>> decisions, const SmoothedDrive& result) {
  std::set<LandmarkId> in_map;
  for (const LandmarkRecord& landmark : result.map) in_map.insert(landmark.id);
  for (auto& landmark : decisions) {
    const auto into = landmark ? result.merged.find(*landmark) : result.merged.end();
    if (into != result.merged.end()) landmark = into->second;
    if (landmark && !in_map.contains(*landmark)) landmark.reset();
  }
  return decisions;
}

}  // namespace

std::optional<SmoothedDrive> smoothedDrive(const DriveRecord& record,
                                           const Explanation& explanation, const DriveSoFar& so_far,
                                           const RangeBearingOptions& options,
                                           const std::optional<Resumption>& from) {
  if (record.stamps_s.empty()) return std::nullopt;
  auto prepared = colonnade::prepared(record, explanation, options, from);
  if (!prepared) return std::nullopt;
  auto& [drive, identities, places, unexplained, known] = *prepared;
  SmoothedDrive result;
  result.map = explanation.map;
  result.identities = explanation.identities;
  result.how = smooth(drive, options.known_gate_probability);
  if (!std::isfinite(result.how.cost) || 2 * result.how.unused >= drive.sightings.size())
    return std::nullopt;

  if (!drive.sensor)
    result.suspected = suspectedErrors(drive, result.how.cost, options.sensor_sigmas);
  else if (const auto fit = sensorFit(drive, options.sensor_sigmas))
    result.sensor = fit->estimate;
  if (!options.use_ids)
    result.cost_of_identities = costOfIdentities(drive, identities, options.known_gate_probability);
  std::vector<double> used(drive.points_world.size(), 0.0);
  for (const Drive::Sighting& sighting : drive.sightings)
    if (sighting.used) used[sighting.point] += 1.0;
  result.surprise = surpriseOf(drive, used, result.how.cost, unexplained, options);
  const Pose2 T_map_start =
      options.world_with_map && !from
          ? so_far.asSaid([&](std::size_t k) { return drive.T_world_robot[k]; })
          : Pose2{};
  result.T_world_filter = T_map_start * so_far.now().T_world_filter;
  for (std::size_t k = 0; k < record.stamps_s.size(); ++k)
    result.trajectory.push_back(
        {record.stamps_s[k], (T_map_start * drive.T_world_robot[k]).toIsometry3()});
  if (!known)
    place(drive.points_world, used, T_map_start, result);
  else if (!from->localize)
    known->spread(drive.points_world, result.how.covariance, used, result.map, result.covariance);
  unite(result.how.merged, places, result);
  result.decisions = finalDecisions(explanation.decisions, result);
  return result;
}

}  // namespace colonnade
