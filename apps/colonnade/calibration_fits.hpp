// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

namespace colonnade {

/// One place of a pillar of known width before the camera (thesis 2015, section 2.8). Lengths in
/// any one unit; delta_rho_px = distance of its two edges in the image, left_rho_px = column of the
/// left one.
struct PillarPlace {
  std::optional<double> distance;  ///< of the pillar from the camera, along the optical axis
  std::optional<double> lateral;   ///< of the camera to the right of the pillar
  std::optional<double> delta_rho_px;
  std::optional<double> left_rho_px;
};

/// delta_rho = at_zero * 10^(-decades * distance): the thesis' curve, its equation solved for it.
struct ExponentialFit {
  double at_zero_px = 0.0;
  double decades = 0.0;  ///< per unit of length
  double rms_px = 0.0;   ///< sqrt(sum of squares / (rows - 2))
  double deltaRho(double distance) const;
  double distance(double delta_rho_px) const;
};

/// delta_rho = focal length * width / distance, with one number for the product.
struct PinholeFit {
  double product = 0.0;  ///< pixels times length
  double rms_px = 0.0;   ///< sqrt(sum of squares / (rows - 1))
  double deltaRho(double distance) const { return product / distance; }
  double distance(double delta_rho_px) const { return product / delta_rho_px; }
};

/// lateral = slope * left_rho + offset, at one distance.
struct LinearFit {
  double slope = 0.0;  ///< length per pixel
  double offset = 0.0;
  double rms = 0.0;  ///< sqrt(sum of squares / (rows - 2)), length
  double lateral(double left_rho_px) const { return slope * left_rho_px + offset; }
};

/// lateral / distance = (centre - left_rho) / focal, for any distance.
struct ObliqueFit {
  double focal_px = 0.0;
  double centre_px = 0.0;  ///< column at which lateral is 0
  double rms = 0.0;        ///< sqrt(sum of squares / (rows - 2)), length
  double lateral(double left_rho_px, double distance) const {
    return distance * (centre_px - left_rho_px) / focal_px;
  }
};

/// Least squares of what is measured: delta_rho for the first two, lateral for the others. Nothing
/// where the rows are not more than the unknowns, or all alike.
std::optional<ExponentialFit> fitExponential(const std::vector<PillarPlace>& places);
std::optional<PinholeFit> fitPinhole(const std::vector<PillarPlace>& places);
std::optional<LinearFit> fitLinear(const std::vector<PillarPlace>& places);
std::optional<ObliqueFit> fitOblique(const std::vector<PillarPlace>& places);

}  // namespace colonnade
