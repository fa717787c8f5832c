// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// consistency [RUNS]: is the filter as sure of itself as it may be? Normalised NEES and NIS over
// simulated runs through a hall, right-invariant filter beside plain EKF, with moderate and with
// strong noise; white noise, so nothing is widened for errors that resemble each other. Last what
// it costs that landmarks rest, and that what they would gain is left out in part.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "colonnade/filter/gate.hpp"
#include "consistency_study.hpp"

namespace {

using namespace colonnade;
using testing::Consistency;

/// So wide that it cuts nothing off the distribution the bands are of.
constexpr double kGate = 0.999999;

/// The central 95 % of a chi-square variable of this many degrees of freedom, divided by them.
void printBand(const char* what, double degrees_of_freedom) {
  const int k = static_cast<int>(degrees_of_freedom);
  std::printf("  95 %% of honest filters have %s in %.3f .. %.3f (%d degrees of freedom)\n", what,
              chiSquareQuantile(0.025, k) / k, chiSquareQuantile(0.975, k) / k, k);
}

void printRow(const char* name, const Consistency& c) {
  std::printf("%-10s", name);
  for (const double nees : c.nees) std::printf(" %6.2f", nees);
  std::printf(" | %6.2f %6.2f | %8.3f\n", c.nees_mean, c.nees_all, c.position_rmse_m);
}

testing::ConsistencySetting settingOf(const testing::HallNoise& noise, bool axes, int rounds,
                                      int runs) {
  testing::ConsistencySetting setting;
  setting.noise = noise;
  setting.axes = axes;
  setting.filter.gate_probability = kGate;
  setting.runs = runs;
  setting.steps = rounds * testing::BuildingHall::kStepsARound;
  return setting;
}

/// Six active landmarks in the place of all: what the resting map does to the NEES.
void studyResting(const char* title, const testing::HallNoise& noise, bool axes, int rounds,
                  int runs) {
  testing::ConsistencySetting setting = settingOf(noise, axes, rounds, runs);
  std::printf("\n%s: NEES as above, with six active landmarks and the rest resting\n", title);
  setting.filter.active_landmarks = 0;
  printRow("all active", studyConsistency(setting));
  setting.filter.active_landmarks = 6;
  for (const double gain : {0.0, FilterOptions{}.negligible_gain, 1e-2}) {
    setting.filter.negligible_gain = gain;
    char name[32];
    std::snprintf(name, sizeof name, "gain %g", gain);
    printRow(name, studyConsistency(setting));
  }
  printBand("each NEES", 3.0 * runs);
}

void printNis(const char* name, const Consistency& c) {
  std::printf("%-10s", name);
  for (const double nis : c.nis) std::printf(" %11.3f", nis);
  std::printf(" %11.3f | %6.2f %%\n", c.nis_axis, 100.0 * c.refused_share);
}

void study(const char* title, const testing::HallNoise& noise, bool axes, int rounds, int runs) {
  testing::ConsistencySetting setting = settingOf(noise, axes, rounds, runs);
  const Consistency invariant = studyConsistency(setting);
  setting.filter.invariant = false;
  const Consistency plain = studyConsistency(setting);
  std::printf(
      "\n%s: step %.3f m along, %.3f m across, %.2f deg; bearing %.2f deg, range %.2f m; floor "
      "edge %.2f deg, %.2f m; wall %.2f deg\n"
      "NEES of the pose over 3, mean of %d runs, after each tenth of %d steps | mean of the ten, "
      "of "
      "all steps | position RMSE [m]\n",
      title, noise.along_m, noise.across_m, degrees(noise.heading), degrees(noise.bearing),
      noise.range_m, degrees(noise.floor_direction), noise.floor_distance_m,
      degrees(noise.wall_direction), runs, setting.steps);
  printRow("invariant", invariant);
  printRow("plain EKF", plain);
  printBand("each NEES", 3.0 * runs);
  std::printf("NIS over its degrees of freedom, measurements within the gate | refused\n%-10s", "");
  for (int k = 0; k < kLandmarkKinds; ++k) std::printf(" %11s", name(static_cast<LandmarkKind>(k)));
  std::printf(" %11s\n", "axis");
  printNis("invariant", invariant);
  printNis("plain EKF", plain);
  for (int k = 0; k < kLandmarkKinds; ++k)
    printBand(name(static_cast<LandmarkKind>(k)),
              invariant.nis_degrees_of_freedom[static_cast<std::size_t>(k)]);
}

}  // namespace

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::atoi(argv[1]) : 200;
  if (runs < 1) {
    std::fprintf(stderr, "usage: consistency [RUNS]\n");
    return 2;
  }
  study("Moderate noise", {}, true, 2, runs);
  study("Strong noise", testing::HallNoise{}.times(3.0), true, 2, runs);
  study("Strong noise, no building axis", testing::HallNoise{}.times(3.0), false, 4, runs);
  studyResting("Moderate noise", {}, true, 4, runs);
  studyResting("Strong noise, no building axis", testing::HallNoise{}.times(3.0), false, 4, runs);
}
