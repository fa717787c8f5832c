// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "calibration_fits.hpp"

namespace colonnade {

/// All fits to one table of places.
struct PillarCalibration {
  std::vector<PillarPlace> places;
  std::string unit;    ///< of all lengths: "m" or "in"
  double width = 0.0;  ///< of the pillar; 0 = not given
  /// A curve to set beside our own, such as the one the thesis prints.
  std::optional<ExponentialFit> printed;

  std::optional<ExponentialFit> exponential;
  std::optional<PinholeFit> pinhole;
  std::optional<LinearFit> linear;
  std::optional<ObliqueFit> oblique;
};

/// Fits everything the places allow. Throws Error when they allow nothing.
PillarCalibration fitAll(std::vector<PillarPlace> places, const std::string& unit, double width);

/// Tables of the fits and of every row's residuals.
std::string toText(const PillarCalibration& calibration);
nlohmann::ordered_json toJson(const PillarCalibration& calibration);

/// The thesis' own tables, figures 35 and 37 of 2015, in inches.
PillarCalibration workedCase();

}  // namespace colonnade
