// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "building_hall.hpp"

namespace colonnade::testing {

/// What many runs through the hall say about a filter: 1 everywhere for an honest one.
struct Consistency {
  int runs = 0;
  int steps = 0;
  std::array<double, 10> nees{};  ///< of the pose over 3, mean over runs, after each tenth
  double nees_mean = 0.0;         ///< of those ten
  double nees_all = 0.0;          ///< of every step of every run
  double position_rmse_m = 0.0;
  std::array<double, kLandmarkKinds> nis{};
  std::array<double, kLandmarkKinds> nis_degrees_of_freedom{};
  double nis_axis = 0.0;
  double nis_axis_degrees_of_freedom = 0.0;
  double refused_share = 0.0;  ///< of the measurements of landmarks; by the gate
};

struct ConsistencySetting {
  HallNoise noise;
  bool axes = true;
  FilterOptions filter;
  int runs = 200;
  int steps = 2 * BuildingHall::kStepsARound;
  unsigned seed = 1000;
};

inline Consistency studyConsistency(const ConsistencySetting& setting) {
  Consistency c;
  c.runs = setting.runs;
  c.steps = setting.steps;
  double refused = 0.0, accepted = 0.0;
  for (int run = 0; run < setting.runs; ++run) {
    BuildingHall hall(setting.seed + static_cast<unsigned>(run), setting.noise, setting.axes);
    EkfSlam filter(setting.filter);
    for (int i = 1; i <= setting.steps; ++i) {
      hall.step(filter);  // P has full rank from the first motion on
      const double nees = hall.nees(filter) / setting.runs;
      c.nees_all += nees / setting.steps;
      if (i % (setting.steps / 10) == 0)
        c.nees[static_cast<std::size_t>(i / (setting.steps / 10) - 1)] += nees;
      c.position_rmse_m +=
          (filter.pose().translation() - hall.truth().translation()).squaredNorm() / setting.runs /
          setting.steps;
    }
    for (int k = 0; k < kLandmarkKinds; ++k) {
      const auto kind = static_cast<LandmarkKind>(k);
      const auto dof = static_cast<double>(filter.health().degreesOfFreedom(kind));
      c.nis[static_cast<std::size_t>(k)] += dof * filter.health().meanNis(kind);
      c.nis_degrees_of_freedom[static_cast<std::size_t>(k)] += dof;
      accepted += static_cast<double>(filter.health().accepted(kind));
    }
    c.nis_axis += hall.axis_distance2;
    c.nis_axis_degrees_of_freedom += hall.axis_count;
    for (const auto& [reason, count] : filter.health().refused())
      refused += static_cast<double>(count);
  }
  for (std::size_t k = 0; k < c.nis.size(); ++k) c.nis[k] /= c.nis_degrees_of_freedom[k];
  if (setting.axes) c.nis_axis /= c.nis_axis_degrees_of_freedom;
  c.position_rmse_m = std::sqrt(c.position_rmse_m);
  c.refused_share = refused / (accepted + refused);
  for (const double nees : c.nees) c.nees_mean += nees / static_cast<double>(c.nees.size());
  return c;
}

}  // namespace colonnade::testing
