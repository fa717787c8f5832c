// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/maps/map_picture.hpp"

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "canvas.hpp"
#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"
#include "ellipse.hpp"

namespace colonnade {
namespace {

// Blue, green, red.
const cv::Scalar kPaper(247, 244, 242);
const cv::Scalar kFree(255, 255, 255);
const cv::Scalar kOccupied(110, 96, 86);
const cv::Scalar kMetreLine(235, 230, 227);
const cv::Scalar kInk(60, 50, 45);
const cv::Scalar kFaintInk(140, 128, 120);
const cv::Scalar kPath(40, 40, 214);
const cv::Scalar kTruth(40, 40, 40);
constexpr int kTop_px = 52;
constexpr int kBottom_px = 56;

cv::Scalar colour(LandmarkKind kind) {
  switch (kind) {
    case LandmarkKind::kPillarEdge:
      return {200, 110, 20};
    case LandmarkKind::kFloorEdge:
      return {70, 150, 30};
    case LandmarkKind::kDepthSlope:
      return {0, 140, 245};
  }
  return kInk;
}

std::string legendName(LandmarkKind kind) {
  switch (kind) {
    case LandmarkKind::kPillarEdge:
      return "pillar edges";
    case LandmarkKind::kFloorEdge:
      return "floor edges";
    case LandmarkKind::kDepthSlope:
      return "depth-slope corners";
  }
  return {};
}

Eigen::AlignedBox2d extentOf(const MapPicture& picture) {
  Eigen::AlignedBox2d box;
  const auto extend = [&](const Eigen::Vector2d& p) {
    if (p.allFinite()) box.extend(p);
  };
  for (const auto& landmark : picture.landmarks) {
    extend(landmark.p_world);
    extend(landmark.extent_a);
    extend(landmark.extent_b);
  }
  for (const auto* trajectory : {&picture.trajectory, &picture.ground_truth})
    for (const auto& pose : *trajectory) extend(pose.T_world_body.translation().head<2>());
  const auto& grid = picture.grid;
  for (int row = 0; row < grid.cells.rows; ++row)
    for (int column = 0; column < grid.cells.cols; ++column)
      if (grid.cells.at<unsigned char>(row, column) == 0)
        extend(grid.p_world_corner +
               grid.resolution_m * Eigen::Vector2d(column + 0.5, grid.cells.rows - row - 0.5));
  if (box.isEmpty()) box = {Eigen::Vector2d(-1.0, -1.0), Eigen::Vector2d(1.0, 1.0)};
  const double margin = 0.3 + 0.02 * box.sizes().maxCoeff();
  box.min().array() -= margin;
  box.max().array() += margin;
  return box;
}

/// The largest of 1, 2, 5 times a power of ten that is at most `length`.
double niceLength(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= length) return factor * power;
  return power;
}

void drawGrid(const GridPicture& grid, Canvas& canvas) {
  canvas.rectangle({0.0, 0.0}, {canvas.size().width, canvas.size().height}, kPaper);
  const auto paint = [&](unsigned char value, const cv::Scalar& paint_colour) {
    if (!grid.cells.empty())
      canvas.cells(grid.cells == value, grid.p_world_corner, grid.resolution_m, paint_colour);
  };
  paint(254, kFree);
  const double step = std::max(1.0, niceLength(160.0 / canvas.pixelsPerMetre()));
  const auto& box = canvas.visible();
  for (double x = std::ceil(box.min().x() / step) * step; x <= box.max().x(); x += step)
    canvas.line(canvas.pixelOf({x, box.min().y()}), canvas.pixelOf({x, box.max().y()}), 0.5,
                kMetreLine);
  for (double y = std::ceil(box.min().y() / step) * step; y <= box.max().y(); y += step)
    canvas.line(canvas.pixelOf({box.min().x(), y}), canvas.pixelOf({box.max().x(), y}), 0.5,
                kMetreLine);
  paint(0, kOccupied);
}

std::vector<Eigen::Vector2d> pixels(const Trajectory& trajectory, const Canvas& canvas) {
  std::vector<Eigen::Vector2d> points_px;
  for (const auto& pose : trajectory)
    points_px.push_back(canvas.pixelOf(pose.T_world_body.translation().head<2>()));
  return points_px;
}

/// A circle where the path starts, an arrow head where it ends.
void drawPath(const Trajectory& trajectory, Canvas& canvas) {
  if (trajectory.empty()) return;
  const auto points_px = pixels(trajectory, canvas);
  canvas.path(points_px, 2.2, kPath);
  canvas.disc(points_px.front(), 6.0, kPath);
  canvas.disc(points_px.front(), 3.2, kFree);
  const double phi = planarPart(trajectory.back().T_world_body).phi;
  const Eigen::Vector2d ahead(std::cos(phi), -std::sin(phi));
  const Eigen::Vector2d left(ahead.y(), -ahead.x());
  const Eigen::Vector2d& tip = points_px.back();
  canvas.polygon({tip + 12.0 * ahead, tip - 7.0 * ahead + 7.5 * left, tip - 3.0 * ahead,
                  tip - 7.0 * ahead - 7.5 * left},
                 kPath);
}

void drawEllipse(const LandmarkRecord& landmark, Canvas& canvas) {
  std::vector<Eigen::Vector2d> outline = ellipse95(landmark.p_world, landmark.covariance);
  for (auto& p : outline) p = canvas.pixelOf(p);
  Eigen::AlignedBox2d box;
  for (const auto& p_px : outline) box.extend(p_px);
  if (outline.empty() || box.diagonal().norm() < 10.0) return;  // the symbol hides it
  canvas.path(outline, 0.8, colour(landmark.kind));
}

void drawSymbol(LandmarkKind kind, const Eigen::Vector2d& p_px, Canvas& canvas) {
  const auto diamond = [&](double r, const cv::Scalar& fill) {
    canvas.polygon({p_px + Eigen::Vector2d(r, 0.0), p_px + Eigen::Vector2d(0.0, r),
                    p_px - Eigen::Vector2d(r, 0.0), p_px - Eigen::Vector2d(0.0, r)},
                   fill);
  };
  if (kind == LandmarkKind::kPillarEdge) {
    canvas.disc(p_px, 5.5, kFree);
    canvas.disc(p_px, 4.2, colour(kind));
  } else {
    diamond(7.0, kFree);
    diamond(5.4, colour(kind));
  }
}

void drawLandmarks(const MapPicture& picture, Canvas& canvas) {
  for (const auto& landmark : picture.landmarks)
    if (landmark.kind == LandmarkKind::kFloorEdge)
      canvas.line(canvas.pixelOf(landmark.extent_a), canvas.pixelOf(landmark.extent_b), 3.0,
                  colour(landmark.kind));
  for (const auto& landmark : picture.landmarks)
    for (const auto& other : picture.landmarks)
      if (landmark.pair_id == other.id && landmark.id < other.id)
        canvas.line(canvas.pixelOf(landmark.p_world), canvas.pixelOf(other.p_world), 2.5,
                    colour(landmark.kind));
  for (const auto& landmark : picture.landmarks) {
    if (landmark.kind == LandmarkKind::kFloorEdge || !landmark.p_world.allFinite()) continue;
    drawEllipse(landmark, canvas);
    drawSymbol(landmark.kind, canvas.pixelOf(landmark.p_world), canvas);
  }
  if (!picture.number_landmarks) return;
  for (const auto& landmark : picture.landmarks)
    canvas.text(std::to_string(number(landmark.id)),
                canvas.pixelOf(landmark.p_world) + Eigen::Vector2d(8.0, -6.0), 8.0, kInk);
}

void drawScaleBar(Canvas& canvas) {
  const double length = niceLength(0.2 * canvas.size().width / canvas.pixelsPerMetre());
  const double length_px = length * canvas.pixelsPerMetre();
  const Eigen::Vector2d right(canvas.size().width - 28.0, kTop_px - 14.0);
  const Eigen::Vector2d left = right - Eigen::Vector2d(length_px, 0.0);
  canvas.line(left, right, 2.0, kInk);
  for (const auto& end : {left, right})
    canvas.line(end - Eigen::Vector2d(0.0, 5.0), end + Eigen::Vector2d(0.0, 5.0), 2.0, kInk);
  const std::string label = formatDouble(length, 3) + " m";
  canvas.text(label,
              {right.x() - 0.5 * (length_px + Canvas::textWidth(label, 11.0)), right.y() - 9.0},
              11.0, kInk);
}

void drawLegend(const MapPicture& picture, Canvas& canvas) {
  constexpr double kText_px = 11.0;
  const double y_px = canvas.size().height - 0.5 * kBottom_px;
  double x_px = 28.0;
  const auto label = [&](const std::string& text) {
    canvas.text(text, {x_px, y_px + 0.5 * kText_px}, kText_px, kInk);
    x_px += Canvas::textWidth(text, kText_px) + 30.0;
  };
  const auto sample = [&](const auto& draw) {
    draw(Eigen::Vector2d(x_px, y_px), Eigen::Vector2d(x_px + 26.0, y_px));
    x_px += 34.0;
  };
  if (!picture.trajectory.empty()) {
    sample([&](const auto& a, const auto& b) { canvas.line(a, b, 2.2, kPath); });
    label("estimated path");
  }
  if (!picture.ground_truth.empty()) {
    sample([&](const auto& a, const auto& b) { canvas.dashes({a, b}, 1.6, kTruth); });
    label("ground truth");
  }
  for (int i = 0; i < kLandmarkKinds; ++i) {
    const auto kind = static_cast<LandmarkKind>(i);
    std::size_t count = 0;
    for (const auto& landmark : picture.landmarks) count += landmark.kind == kind ? 1 : 0;
    if (count == 0) continue;
    if (kind == LandmarkKind::kFloorEdge) {
      sample([&](const auto& a, const auto& b) { canvas.line(a, b, 3.0, colour(kind)); });
    } else {
      drawSymbol(kind, {x_px + 6.0, y_px}, canvas);
      x_px += 20.0;
    }
    label(std::to_string(count) + " " + legendName(kind));
  }
  if (!picture.grid.cells.empty()) {
    canvas.rectangle({x_px, y_px - 6.0}, {x_px + 14.0, y_px + 6.0}, kOccupied);
    x_px += 22.0;
    label("occupied");
  }
  if (x_px == 28.0) canvas.text("the map is empty", {x_px, y_px + 5.0}, kText_px, kFaintInk);
}

}  // namespace

cv::Mat drawMap(const MapPicture& picture) {
  Canvas canvas(extentOf(picture), picture.width_px, kTop_px, kBottom_px);
  drawGrid(picture.grid, canvas);
  canvas.dashes(pixels(picture.ground_truth, canvas), 1.6, kTruth);
  drawPath(picture.trajectory, canvas);
  drawLandmarks(picture, canvas);
  const double width_px = canvas.size().width;
  const double height_px = canvas.size().height;
  canvas.rectangle({0.0, 0.0}, {width_px, kTop_px}, kFree);
  canvas.rectangle({0.0, height_px - kBottom_px}, {width_px, height_px}, kFree);
  canvas.text(picture.title, {28.0, kTop_px - 18.0}, 15.0, kInk, true);
  drawScaleBar(canvas);
  drawLegend(picture, canvas);
  return canvas.finished();
}

void writeMapPicture(const std::filesystem::path& path, const MapPicture& picture) {
  std::vector<unsigned char> png;
  if (!cv::imencode(".png", drawMap(picture), png))
    throw Error(path.string() + ": the picture cannot be encoded");
  writeFileAtomically(path, {reinterpret_cast<const char*>(png.data()), png.size()});
}

}  // namespace colonnade
