// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/measurement.hpp"
#include "colonnade/base/options.hpp"
#include "colonnade/filter/sensor_errors.hpp"

namespace colonnade {

/// How readings of landmarks (CObservationBearingRange) drive the filter.
struct RangeBearingOptions {
  static constexpr const char* kSection = "RangeBearing";
  double range_sigma_m = 0.0;
  double bearing_sigma = 0.0;
  bool use_ids = true;
  bool bearing_only = false;
  std::string association = "hypotheses";
  std::string metric = "mahalanobis";
  double gate_probability = 0.99;
  double joint_probability = 0.99;
  double known_gate_probability = 0.999999;
  double error_correlation_s = 0.0;
  bool estimate_sensor = false;
  SensorErrors sensor_sigmas = {.range_offset_m = 0.05,
                                .range_scale = 0.02,
                                .range_skew = 0.03,
                                .bearing_offset = radians(1.0),
                                .bearing_scale = 0.01};
  bool wait_for_landmark = false;
  bool world_with_map = true;
  bool smooth = true;
  int smooth_every = 10;
  bool look_back = true;
  int hypotheses = 40;
  double outlier_share = 0.03;
  double birth_share = 0.01;
  double view_range_m = 8.0;
  double view_angle = radians(60.0);
  double near_factor = 1.5;
  int probation_sightings = 3;
  double probation_s = 60.0;
  bool wait_for_parallax = false;
  double inverse_depth = 0.35;
  double inverse_depth_sigma = 0.25;
  double min_baseline_m = 0.1;
  double min_parallax = radians(8.0);

  /// How much the sensor sees, in the numbers of a measurement: metres times radians, or radians.
  double viewFor(const Measurement& measurement) const {
    return (measurement.hasRange() ? view_range_m : 1.0) * view_angle;
  }

  void visit(OptionVisitor& v) {
    v.number("range_sigma_m", range_sigma_m, {0, 100}, "of a range; 0: what the log states");
    v.angle("bearing_sigma_deg", bearing_sigma, {0, 90}, "of a bearing; 0: what the log states");
    v.flag("use_ids", use_ids, "believe the identities of the log; false: find them");
    v.flag("bearing_only", bearing_only, "do without the ranges");
    v.choice("association", association, {"nn", "jcbb", "hypotheses"},
             "of readings without identity: nearest neighbour, joint compatibility, or several "
             "joint histories side by side");
    v.choice("metric", metric, {"mahalanobis", "likelihood"}, "what nn and jcbb call near");
    v.number("gate_probability", gate_probability, {0.5, 1},
             "share of right readings a gate lets through; 1: no gate");
    v.number("joint_probability", joint_probability, {0.5, 1},
             "the same for all readings of a frame together (jcbb)");
    v.number("known_gate_probability", known_gate_probability, {0.5, 1},
             "the same for readings whose identity the log tells; 1: no gate");
    v.number("error_correlation_s", error_correlation_s, {0, 60},
             "time over which errors of one landmark's readings stay alike; takes the place of "
             "Filter.error_correlation_s");
    v.flag("estimate_sensor", estimate_sensor,
           "estimate what the sensor is always off by; how large that may be, one sigma each:");
    v.number("range_offset_sigma_m", sensor_sigmas.range_offset_m, {0, 0.5},
             "metres more in every range (estimate_sensor)");
    v.number("range_scale_sigma", sensor_sigmas.range_scale, {0, 0.1},
             "share by which ranges are too long (estimate_sensor)");
    v.number("range_skew_sigma", sensor_sigmas.range_skew, {0, 0.1},
             "the same for each radian of bearing (estimate_sensor)");
    v.angle("bearing_offset_sigma_deg", sensor_sigmas.bearing_offset, {0, 10},
            "by which bearings are too far to the left (estimate_sensor)");
    v.number("bearing_scale_sigma", sensor_sigmas.bearing_scale, {0, 0.1},
             "share by which bearings are too wide (estimate_sensor)");
    v.flag("wait_for_landmark", wait_for_landmark,
           "stand still until there is a landmark, as MRPT's kf-slam does");
    v.flag("world_with_map", world_with_map,
           "when a correction moves the whole map, move the world along; false: the world starts "
           "where the log does");
    v.flag("smooth", smooth,
           "at the end find the poses and landmarks that suit the whole log best "
           "(trajectory_final.tum, landmarks.csv)");
    v.integer("smooth_every", smooth_every, {0, 1000000},
              "frames, and more in long logs: find those that suit what was read so far best "
              "(trajectory.tum); 0: only at the end");
    v.flag("look_back", look_back,
           "explain a log of hidden identities once more from its end, which takes as long again; "
           "the better explanation is smoothed");
    v.integer(
        "hypotheses", hypotheses, {1, 1000},
        "joint histories kept side by side; up to two and a half times as many in a small map, "
        "three times in a map that is left as it is, fewer where they take too much memory");
    v.number("outlier_share", outlier_share, {1e-6, 0.5}, "of the readings (hypotheses)");
    v.number("birth_share", birth_share, {1e-9, 0.5},
             "of the readings that show a new landmark (hypotheses)");
    v.number("view_range_m", view_range_m, {0.1, 1000}, "how far the sensor sees (hypotheses)");
    v.angle("view_angle_deg", view_angle, {1, 360}, "how wide the sensor sees (hypotheses)");
    v.number(
        "near_factor", near_factor, {1, 100},
        "a reading within this many times the gate of a landmark founds no new one (nn, jcbb)");
    v.integer("probation_sightings", probation_sightings, {1, 1000},
              "that make a landmark without identity permanent");
    v.number("probation_s", probation_s, {0.1, 1e6},
             "unseen, after which one with fewer sightings is purged");
    v.flag("wait_for_parallax", wait_for_parallax,
           "a landmark starts with a second bearing from elsewhere; false: with the first "
           "(bearing_only)");
    v.number("inverse_depth", inverse_depth, {0.001, 100},
             "1/m, of a landmark on its first ray (bearing_only)");
    v.number("inverse_depth_sigma", inverse_depth_sigma, {0.001, 100}, "1/m (bearing_only)");
    v.number("min_baseline_m", min_baseline_m, {0, 100},
             "across the first ray (wait_for_parallax)");
    v.angle("min_parallax_deg", min_parallax, {0.1, 60},
            "between the first and the present ray (wait_for_parallax)");
  }
};

}  // namespace colonnade
