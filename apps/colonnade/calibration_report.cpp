// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibration_report.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

std::string padded(std::string text, std::size_t width) {
  text.insert(0, text.size() < width ? width - text.size() : 0, ' ');
  return text;
}

std::string cell(double value, int decimals) { return padded(formatFixed(value, decimals), 13); }

/// sqrt(sum of squares / rows) of a curve that is not fitted to them.
double rmsOf(const ExponentialFit& curve, const std::vector<PillarPlace>& places) {
  double squares = 0.0;
  int rows = 0;
  for (const PillarPlace& place : places) {
    if (!place.distance || !place.delta_rho_px) continue;
    squares += std::pow(*place.delta_rho_px - curve.deltaRho(*place.distance), 2);
    ++rows;
  }
  return rows > 0 ? std::sqrt(squares / rows) : 0.0;
}

std::string curveText(const ExponentialFit& fit, const std::string& unit) {
  return "d = -log10(drho / " + formatFixed(fit.at_zero_px, 1) + ") / " +
         formatDouble(fit.decades, 3) + "  (px, decades per " + unit + ")";
}

void addDistance(const PillarCalibration& c, std::string& text) {
  if (!c.exponential && !c.pinhole) return;
  text += "distance d from delta rho\n";
  if (c.printed)
    text += "  as printed   " + curveText(*c.printed, c.unit) + "; " +
            formatFixed(rmsOf(*c.printed, c.places), 2) + " px rms\n";
  if (c.exponential)
    text += "  exponential  " + curveText(*c.exponential, c.unit) + "; " +
            formatFixed(c.exponential->rms_px, 2) + " px rms\n";
  if (c.pinhole) {
    text += "  pinhole      d = " + formatDouble(c.pinhole->product, 5) + " / drho  (px " + c.unit +
            "); " + formatFixed(c.pinhole->rms_px, 2) + " px rms";
    if (c.width > 0.0)
      text += "; focal length " + formatFixed(c.pinhole->product / c.width, 1) + " px";
    text += "\n";
  }
  text += "  errors of d, " + c.unit + ":\n" + padded("d", 13) + padded("drho px", 13);
  if (c.printed) text += padded("as printed", 13);
  if (c.exponential) text += padded("exponential", 13);
  if (c.pinhole) text += padded("pinhole", 13);
  text += "\n";
  for (const PillarPlace& place : c.places) {
    if (!place.distance || !place.delta_rho_px) continue;
    text += cell(*place.distance, 3) + cell(*place.delta_rho_px, 2);
    for (const auto& fit : {c.printed, c.exponential})
      if (fit) text += cell(fit->distance(*place.delta_rho_px) - *place.distance, 3);
    if (c.pinhole) text += cell(c.pinhole->distance(*place.delta_rho_px) - *place.distance, 3);
    text += "\n";
  }
}

void addLateral(const PillarCalibration& c, std::string& text) {
  if (!c.linear && !c.oblique) return;
  text += "lateral shift s from leftmost rho\n";
  if (c.linear)
    text += "  linear       s = " + formatDouble(c.linear->slope, 3) + " rho + " +
            formatDouble(c.linear->offset, 4) + "  (" + c.unit + "); " +
            formatFixed(c.linear->rms, 3) + " " + c.unit + " rms\n";
  if (c.oblique)
    text += "  pinhole      s = d (" + formatFixed(c.oblique->centre_px, 1) + " - rho) / " +
            formatFixed(c.oblique->focal_px, 1) + "; " + formatFixed(c.oblique->rms, 3) + " " +
            c.unit + " rms\n";
  text += "  errors of s, " + c.unit + ":\n" + padded("s", 13) + padded("rho px", 13);
  if (c.linear) text += padded("linear", 13);
  if (c.oblique) text += padded("pinhole", 13);
  text += "\n";
  for (const PillarPlace& place : c.places) {
    if (!place.lateral || !place.left_rho_px) continue;
    text += cell(*place.lateral, 3) + cell(*place.left_rho_px, 2);
    if (c.linear) text += cell(c.linear->lateral(*place.left_rho_px) - *place.lateral, 3);
    if (c.oblique && place.distance)
      text += cell(c.oblique->lateral(*place.left_rho_px, *place.distance) - *place.lateral, 3);
    text += "\n";
  }
}

}  // namespace

PillarCalibration fitAll(std::vector<PillarPlace> places, const std::string& unit, double width) {
  PillarCalibration c;
  c.places = std::move(places);
  c.unit = unit;
  c.width = width;
  c.exponential = fitExponential(c.places);
  c.pinhole = fitPinhole(c.places);
  c.linear = fitLinear(c.places);
  c.oblique = fitOblique(c.places);
  if (!c.exponential && !c.pinhole && !c.linear && !c.oblique)
    throw Error(
        "calibrate: too few places to fit anything; it takes 2 distances with delta rho, or "
        "3 lateral shifts with leftmost rho");
  return c;
}

std::string toText(const PillarCalibration& c) {
  std::string text;
  addDistance(c, text);
  addLateral(c, text);
  return text;
}

nlohmann::ordered_json toJson(const PillarCalibration& c) {
  nlohmann::ordered_json json{{"unit", c.unit}, {"places", c.places.size()}};
  const auto exponential = [&](const ExponentialFit& fit, double rms_px) {
    return nlohmann::ordered_json{
        {"at_zero_px", fit.at_zero_px}, {"decades_per_unit", fit.decades}, {"rms_px", rms_px}};
  };
  if (c.printed) json["as_printed"] = exponential(*c.printed, rmsOf(*c.printed, c.places));
  if (c.exponential) json["exponential"] = exponential(*c.exponential, c.exponential->rms_px);
  if (c.pinhole) {
    json["pinhole"] = {{"px_times_unit", c.pinhole->product}, {"rms_px", c.pinhole->rms_px}};
    if (c.width > 0.0) json["pinhole"]["focal_px"] = c.pinhole->product / c.width;
  }
  if (c.linear)
    json["linear"] = {
        {"slope_per_px", c.linear->slope}, {"offset", c.linear->offset}, {"rms", c.linear->rms}};
  if (c.oblique)
    json["pinhole_lateral"] = {{"focal_px", c.oblique->focal_px},
                               {"centre_px", c.oblique->centre_px},
                               {"rms", c.oblique->rms}};
  return json;
}

PillarCalibration workedCase() {
  std::vector<PillarPlace> places;
  constexpr double kFigure35[][2] = {{30, 69}, {35, 60}, {40, 50}, {50, 40}, {60, 33},
                                     {70, 28}, {80, 24}, {90, 22}, {100, 19}};
  for (const auto& [distance, delta_rho] : kFigure35)
    places.push_back({distance, std::nullopt, delta_rho, std::nullopt});
  constexpr double kFigure37[][2] = {{-17.5, 566}, {-14, 521}, {-10.5, 446}, {-7, 391},
                                     {-3.5, 351},  {0, 321},   {3.5, 271},   {7, 229},
                                     {10.5, 189},  {14, 143},  {17.5, 117}};
  for (const auto& [lateral, left_rho] : kFigure37)
    places.push_back({std::nullopt, lateral, std::nullopt, left_rho});
  PillarCalibration c = fitAll(std::move(places), "in", 0.0);
  c.printed = ExponentialFit{151.8, 0.0108};  // the equation under figure 35
  return c;
}

}  // namespace colonnade
