// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/base/angle.hpp"
#include "colonnade/base/options.hpp"

namespace colonnade {

struct FilterOptions {
  static constexpr const char* kSection = "Filter";
  bool invariant = true;
  double gate_probability = 0.99;
  double inverse_depth_linearity = 0.1;
  double error_correlation_s = 1.0;
  int active_landmarks = 40;
  double negligible_gain = 1e-3;

  void visit(OptionVisitor& v) {
    v.flag("invariant", invariant, "right-invariant transport of the covariance; false: plain EKF");
    v.number("gate_probability", gate_probability, {0.5, 0.999999},
             "share of right measurements the chi-square gate lets through");
    v.number("inverse_depth_linearity", inverse_depth_linearity, {0.001, 1},
             "linearity index below which inverse depth becomes x, y (Civera 2008, eq. 35)");
    v.number("error_correlation_s", error_correlation_s, {0, 60},
             "time over which errors of one landmark's measurements stay alike");
    v.integer("active_landmarks", active_landmarks, {0, 100000},
              "range-bearing logs: landmarks around the robot worked with where a map holds over "
              "twice as many; the others follow when they are needed; 0: always all");
    v.number("negligible_gain", negligible_gain, {0, 0.1},
             "share of a resting landmark's variance that it need not lose each time landmarks "
             "are exchanged, for speed; 0: exact");
  }
};

}  // namespace colonnade
