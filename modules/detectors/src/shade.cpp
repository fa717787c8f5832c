// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/shade.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/error.hpp"

namespace colonnade {
namespace {

/// Hue in degrees, saturation and value 0 to 255 (the hexagonal model, Smith 1978).
std::array<double, 3> toHsv(double blue, double green, double red) {
  const double high = std::max({blue, green, red}), low = std::min({blue, green, red});
  const double spread = high - low;
  if (spread <= 0.0) return {0.0, 0.0, high};
  double hue = 0.0;
  if (high == red) {
    hue = 60.0 * (green - blue) / spread;
  } else if (high == green) {
    hue = 120.0 + 60.0 * (blue - red) / spread;
  } else {
    hue = 240.0 + 60.0 * (red - green) / spread;
  }
  return {hue < 0.0 ? hue + 360.0 : hue, 255.0 * spread / high, high};
}

/// The middle nine tenths. Reorders its argument.
std::pair<double, double> middleOf(std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return {at(0.05), at(0.95)};
}

bool within(double value, double low, double high) { return value >= low && value <= high; }

}  // namespace

bool hasShade(const Eigen::Vector3f& bgr, const ShadeOptions& shade) {
  if (!shade.known()) return true;
  const Eigen::Vector3d c = bgr.cast<double>();
  std::array<double, 3> channels{c.z(), c.y(), c.x()};
  if (shade.space == "hsv") channels = toHsv(c.x(), c.y(), c.z());
  const bool through_zero = shade.space == "hsv" && shade.first_low > shade.first_high;
  const bool first = through_zero
                         ? channels[0] >= shade.first_low || channels[0] <= shade.first_high
                         : within(channels[0], shade.first_low, shade.first_high);
  return first && within(channels[1], shade.second_low, shade.second_high) &&
         within(channels[2], shade.third_low, shade.third_high);
}

ShadeOptions learnShade(const cv::Mat& colour, const cv::Rect& area, const std::string& space,
                        double margin) {
  if (colour.empty() || colour.type() != CV_8UC3)
    throw Error("a shade is learned from a colour picture; this one has no colour");
  if (area.empty() || (area & cv::Rect({0, 0}, colour.size())) != area)
    throw Error("the rectangle of the shade leaves the picture of " + std::to_string(colour.cols) +
                "x" + std::to_string(colour.rows) + "; give X,Y,W,H within it");
  std::array<std::vector<double>, 3> values;
  double sum_x = 0.0, sum_y = 0.0;  // of hues, as directions
  for (int row = area.y; row < area.br().y; ++row) {
    for (int column = area.x; column < area.br().x; ++column) {
      const auto& p = colour.at<cv::Vec3b>(row, column);
      std::array<double, 3> c{static_cast<double>(p[2]), static_cast<double>(p[1]),
                              static_cast<double>(p[0])};
      if (space == "hsv") {
        c = toHsv(p[0], p[1], p[2]);
        sum_x += c[1] * std::cos(c[0] * kPi / 180.0);
        sum_y += c[1] * std::sin(c[0] * kPi / 180.0);
      }
      for (std::size_t i = 0; i < 3; ++i) values[i].push_back(c[i]);
    }
  }
  ShadeOptions shade;
  shade.space = space;
  const auto set = [&](std::size_t channel, double& low, double& high) {
    std::tie(low, high) = middleOf(values[channel]);
    low = std::max(0.0, low - margin);
    high = std::min(255.0, high + margin);
  };
  set(1, shade.second_low, shade.second_high);
  set(2, shade.third_low, shade.third_high);
  if (space != "hsv") {
    set(0, shade.first_low, shade.first_high);
    return shade;
  }
  constexpr double kColoured = 40.0;  // saturation below which hue says nothing
  if (shade.second_low + margin < kColoured) return shade;
  const double mean = std::atan2(sum_y, sum_x) * 180.0 / kPi;
  for (double& hue : values[0]) hue = std::remainder(hue - mean, 360.0);
  auto [low, high] = middleOf(values[0]);
  const auto turned = [&](double hue) { return hue - 360.0 * std::floor(hue / 360.0); };
  constexpr double kMargin_deg = 8.0;
  shade.first_low = turned(mean + low - kMargin_deg);
  shade.first_high = turned(mean + high + kMargin_deg);
  return shade;
}

}  // namespace colonnade
