// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "painter.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "colonnade/simulation/random.hpp"

namespace colonnade {
namespace {

constexpr double kLightCellM = 0.06;
constexpr double kBlotchCellM = 0.02;
/// Distance into a period of length `tile`, from the nearer joint.
double fromJoint(double x, double tile) {
  const double phase = x - tile * std::floor(x / tile);
  return std::min(phase, tile - phase);
}

/// Notices pinned on cork: one sheet per cell, of its own size and shade.
bool onSheet(double along_m, double up_m, std::uint32_t seed, double* shade) {
  const double cell_x = 0.32, cell_y = 0.38;
  const auto i = static_cast<std::int64_t>(std::floor(along_m / cell_x));
  const auto j = static_cast<std::int64_t>(std::floor(up_m / cell_y));
  if (cellNoise(i, j, seed) > 0.6) return false;
  const double x =
      along_m - cell_x * (static_cast<double>(i) + 0.5 + 0.08 * cellNoise(i, j, seed + 1));
  const double y =
      up_m - cell_y * (static_cast<double>(j) + 0.5 + 0.08 * cellNoise(i, j, seed + 2));
  const double half_width = 0.105, half_height = 0.1485;  // A4
  if (std::abs(x) > half_width || std::abs(y) > half_height) return false;
  *shade = 1.0 + 0.08 * cellNoise(i, j, seed + 3);
  const bool text = std::abs(x) < 0.08 && std::abs(y) < 0.12 && fromJoint(y, 0.02) < 0.004 &&
                    cellNoise(static_cast<std::int64_t>(std::floor(x / 0.02)),
                              static_cast<std::int64_t>(std::floor(y / 0.02)), seed + 4) < 0.4;
  if (text) *shade *= 0.45;
  return true;
}

/// Clusters of round spots at the height of the eyes.
bool onDecal(double along_m, double up_m, std::uint32_t seed) {
  constexpr double kCell = 0.09, kLow = 0.9, kHigh = 1.7;
  if (up_m < kLow || up_m > kHigh || latticeNoise(along_m / 0.9, up_m / 0.5, seed + 5) < 0.15) {
    return false;
  }
  const double x = along_m - kCell * (std::floor(along_m / kCell) + 0.5);
  const double y = up_m - kCell * (std::floor(up_m / kCell) + 0.5);
  return std::hypot(x, y) < 0.3 * kCell;
}

/// A door leaf: two sunk panels and a handle.
bool onPanelLine(double along_m, double up_m, const Eigen::Vector2d& size) {
  const double x = std::abs(along_m - 0.5 * size.x());
  const double half = panelHalfWidth(size.x());
  if (half < 0.05) return false;
  for (const auto& [low, high] : panelHeights(size.y())) {
    const bool inside = x < half && up_m > low && up_m < high;
    const bool deep =
        x < half - kPanelLineM && up_m > low + kPanelLineM && up_m < high - kPanelLineM;
    if (inside && !deep) return true;
  }
  return std::abs(along_m - 0.09) < 0.06 && std::abs(up_m - 1.02) < 0.015;
}

}  // namespace

Painter::Painter(const World& world, const Building& building)
    : world_(world), light_(world, building) {}

Eigen::Vector3d Painter::colourAt(const Material& material, double along_m, double up_m,
                                  const Eigen::Vector2d& size_m, std::uint32_t seed) const {
  switch (material.pattern) {
    case Pattern::kTiles: {
      const double joint =
          std::min(fromJoint(along_m, material.tile_m), fromJoint(up_m, material.tile_m));
      if (joint < 0.5 * kJointM) return material.second;
      const double shade =
          cellNoise(static_cast<std::int64_t>(std::floor(along_m / material.tile_m)),
                    static_cast<std::int64_t>(std::floor(up_m / material.tile_m)), 77);
      return material.colour * (1.0 + 0.03 * shade);
    }
    case Pattern::kPanels:
      if (onPanelLine(along_m, up_m, size_m)) return material.second;
      return material.colour * (1.0 + 0.05 * latticeNoise(along_m / 0.012, up_m / 0.35, seed));
    case Pattern::kPapers: {
      double shade = 1.0;
      return onSheet(along_m, up_m, seed, &shade) ? shade * material.second : material.colour;
    }
    case Pattern::kLamp: {
      const double rim = std::min({along_m, size_m.x() - along_m, up_m, size_m.y() - up_m});
      return rim < 0.02 ? material.second : material.colour;
    }
    case Pattern::kSheets:
      return fromJoint(along_m, material.tile_m) < 0.5 * kJointM ? material.second
                                                                 : material.colour;
    case Pattern::kDecals:
      return onDecal(along_m, up_m, seed) ? material.second : material.colour;
    case Pattern::kPlaster:
    case Pattern::kPlain:
      return material.colour;
  }
  return material.colour;
}

cv::Mat Painter::lightMap(const Face& face, int width_px, int height_px) const {
  if (face.glows) return cv::Mat(height_px, width_px, CV_32FC1, cv::Scalar(1.0));
  const auto cells = [](double length) {
    return std::max(2, static_cast<int>(std::ceil(length / kLightCellM)));
  };
  cv::Mat coarse(cells(face.up.norm()), cells(face.along.norm()), CV_32FC1);
  const Eigen::Vector3d normal = face.normal();
  for (int row = 0; row < coarse.rows; ++row) {
    for (int column = 0; column < coarse.cols; ++column) {
      const Eigen::Vector3d p_world = face.origin + (column + 0.5) / coarse.cols * face.along +
                                      (1.0 - (row + 0.5) / coarse.rows) * face.up;
      coarse.at<float>(row, column) = static_cast<float>(light_.brightness(p_world, normal));
    }
  }
  cv::Mat smooth, fine;
  cv::GaussianBlur(coarse, smooth, cv::Size(5, 5), 1.0, 1.0, cv::BORDER_REPLICATE);
  cv::resize(smooth, fine, cv::Size(width_px, height_px), 0, 0, cv::INTER_LINEAR);
  return fine;
}

cv::Mat Painter::blotchMap(const Eigen::Vector2d& size_m, std::uint32_t seed, int width_px,
                           int height_px) const {
  const auto cells = [](double length) {
    return std::max(2, static_cast<int>(std::ceil(length / kBlotchCellM)));
  };
  cv::Mat coarse(cells(size_m.y()), cells(size_m.x()), CV_32FC1), fine;
  for (int row = 0; row < coarse.rows; ++row) {
    const double up_m = size_m.y() * (1.0 - (row + 0.5) / coarse.rows);
    for (int column = 0; column < coarse.cols; ++column) {
      const double along_m = size_m.x() * (column + 0.5) / coarse.cols;
      coarse.at<float>(row, column) =
          static_cast<float>(latticeNoise(along_m / 0.31, up_m / 0.27, seed + 12) +
                             0.6 * latticeNoise(along_m / 0.07, up_m / 0.06, seed + 13));
    }
  }
  cv::resize(coarse, fine, cv::Size(width_px, height_px), 0, 0, cv::INTER_LINEAR);
  return fine;
}

cv::Mat Painter::paint(const Face& face, std::uint32_t seed, int width_px, int height_px) const {
  const Eigen::Vector2d size_m(face.along.norm(), face.up.norm());
  const cv::Mat light = lightMap(face, width_px, height_px);
  const cv::Mat blotches = blotchMap(size_m, seed, width_px, height_px);
  cv::Mat picture(height_px, width_px, CV_8UC3);
  for (int row = 0; row < height_px; ++row) {
    const double up_m = size_m.y() * (1.0 - (row + 0.5) / height_px);
    const Material& material =
        world_.materials[up_m < face.skirting_m ? face.skirting_material : face.material];
    for (int column = 0; column < width_px; ++column) {
      const double along_m = size_m.x() * (column + 0.5) / width_px;
      Eigen::Vector3d colour = colourAt(material, along_m, up_m, size_m, seed);
      colour.array() += material.grain * cellNoise(column, row, seed + 11) +
                        material.blotches * blotches.at<float>(row, column);
      colour *= light.at<float>(row, column);
      auto& pixel = picture.at<cv::Vec3b>(row, column);
      for (int channel = 0; channel < 3; ++channel) {
        pixel[2 - channel] = cv::saturate_cast<unsigned char>(colour[channel]);
      }
    }
  }
  return picture;
}

}  // namespace colonnade
