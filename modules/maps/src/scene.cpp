// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "scene.hpp"

#include <mrpt/opengl/CBox.h>
#include <mrpt/opengl/CCylinder.h>
#include <mrpt/opengl/CGridPlaneXY.h>
#include <mrpt/opengl/CPointCloud.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CText.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "ellipse.hpp"

namespace colonnade {
namespace {

using mrpt::img::TColor;
using mrpt::img::TColorf;

constexpr float kColumnHeight_m = 2.0F;
constexpr double kLift_m = 0.05;  ///< so that nothing hides in the floor: depth buffers are coarse

TColor colour(LandmarkKind kind) {
  switch (kind) {
    case LandmarkKind::kPillarEdge:
      return {31, 119, 180};
    case LandmarkKind::kFloorEdge:
      return {44, 140, 60};
    case LandmarkKind::kDepthSlope:
      return {230, 130, 20};
  }
  return {0, 0, 0};
}

Eigen::AlignedBox2d extentOf(const LandmarkMap& landmarks, const Trajectory& trajectory) {
  Eigen::AlignedBox2d box(Eigen::Vector2d(-1.0, -1.0), Eigen::Vector2d(1.0, 1.0));
  for (const auto& landmark : landmarks)
    for (const auto& p : {landmark.p_world, landmark.extent_a, landmark.extent_b})
      if (p.allFinite()) box.extend(p);
  for (const auto& pose : trajectory)
    box.extend(Eigen::Vector2d(pose.T_world_body.translation().head<2>()));
  return box;
}

mrpt::opengl::CText::Ptr label(const std::string& text, const Eigen::Vector2d& p_world, double z,
                               TColor colour) {
  auto result = mrpt::opengl::CText::Create(text);
  result->setColor_u8(colour);
  result->setLocation(p_world.x(), p_world.y(), z);
  return result;
}

void addColumn(const LandmarkRecord& landmark, mrpt::opengl::CSetOfObjects& column_set) {
  const auto& p = landmark.p_world;
  const TColor kind_colour = colour(landmark.kind);
  const std::string id = std::to_string(number(landmark.id));
  const float radius = landmark.kind == LandmarkKind::kPillarEdge ? 0.03F : 0.02F;
  auto column = mrpt::opengl::CCylinder::Create(radius, radius, kColumnHeight_m, 12);
  column->setName(std::string(name(landmark.kind)) + " " + id);
  column->enableLight(false);
  column->setColor_u8(kind_colour);
  column->setLocation(p.x(), p.y(), 0.0);
  column_set.insert(column);
  column_set.insert(label(id, p, kColumnHeight_m + 0.1, kind_colour));
}

/// Outlines of one kind. MRPT's CEllipsoid2D would do, but its class is misaligned in memory.
mrpt::opengl::CSetOfLines::Ptr ellipses(const LandmarkMap& landmarks, LandmarkKind kind) {
  auto lines = mrpt::opengl::CSetOfLines::Create();
  lines->setName(std::string(name(kind)) + " 95 % ellipses");
  lines->setColor_u8(colour(kind));
  for (const auto& landmark : landmarks) {
    if (landmark.kind != kind || !landmark.p_world.allFinite()) continue;
    const auto outline = ellipse95(landmark.p_world, landmark.covariance);
    for (std::size_t i = 1; i < outline.size(); ++i) {
      const auto& a = outline[i - 1];
      const auto& b = outline[i];
      lines->appendLine(a.x(), a.y(), kLift_m, b.x(), b.y(), kLift_m);
    }
  }
  return lines;
}

/// Flat bars: wide lines are thin ones with most graphics drivers.
mrpt::opengl::CSetOfObjects::Ptr floorEdges(const LandmarkMap& landmarks) {
  constexpr double kHalfWidth_m = 0.02;
  auto edges = mrpt::opengl::CSetOfObjects::Create();
  edges->setName("floor edges");
  for (const auto& landmark : landmarks) {
    const Eigen::Vector2d along = landmark.extent_b - landmark.extent_a;
    if (landmark.kind != LandmarkKind::kFloorEdge || !along.allFinite()) continue;
    auto bar =
        mrpt::opengl::CBox::Create(mrpt::math::TPoint3D(0.0, -kHalfWidth_m, 0.9 * kLift_m),
                                   mrpt::math::TPoint3D(along.norm(), kHalfWidth_m, kLift_m));
    bar->setName(std::string(name(landmark.kind)) + " " + std::to_string(number(landmark.id)));
    bar->setColor_u8(colour(landmark.kind));  // keep its light: without, MRPT 2.5.8 draws no box
    bar->enableBoxBorder(false);
    bar->setPose(mrpt::poses::CPose3D(landmark.extent_a.x(), landmark.extent_a.y(), 0.0,
                                      std::atan2(along.y(), along.x()), 0.0, 0.0));
    edges->insert(bar);
  }
  return edges;
}

mrpt::opengl::CSetOfLines::Ptr path(const Trajectory& trajectory) {
  auto lines = mrpt::opengl::CSetOfLines::Create();
  lines->setName("trajectory");
  lines->setColor_u8(TColor(200, 30, 60));
  lines->setLineWidth(2.0F);
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const auto& a = trajectory[i - 1].T_world_body.translation();
    const auto& b = trajectory[i].T_world_body.translation();
    lines->appendLine(a.x(), a.y(), a.z() + kLift_m, b.x(), b.y(), b.z() + kLift_m);
  }
  return lines;
}

/// The occupied cells as points. A textured plane would show the free ones too, but MRPT 2.5.8
/// draws those over lines and text, whatever their heights.
mrpt::opengl::CPointCloud::Ptr occupancy(const GridPicture& grid) {
  auto points = mrpt::opengl::CPointCloud::Create();
  points->setName("occupancy");
  points->setColor_u8(TColor(86, 96, 110));
  points->setPointSize(3.0F);
  for (int row = 0; row < grid.cells.rows; ++row)
    for (int column = 0; column < grid.cells.cols; ++column) {
      if (grid.cells.at<unsigned char>(row, column) != 0) continue;
      const Eigen::Vector2d cell(column + 0.5, grid.cells.rows - row - 0.5);
      const Eigen::Vector2d p_world = grid.p_world_corner + grid.resolution_m * cell;
      points->insertPoint(static_cast<float>(p_world.x()), static_cast<float>(p_world.y()), 0.0F);
    }
  return points;
}

mrpt::opengl::CSetOfObjects::Ptr legend(const LandmarkMap& landmarks, const Eigen::Vector2d& at) {
  auto result = mrpt::opengl::CSetOfObjects::Create();
  result->setName("legend");
  double z = 3.2;
  const auto add = [&](const std::string& text, TColor text_colour) {
    result->insert(label(text, at, z, text_colour));
    z -= 0.3;
  };
  add("Colonnade landmark map, grid 1 m", TColor(60, 60, 60));
  for (int i = 0; i < kLandmarkKinds; ++i) {
    const auto kind = static_cast<LandmarkKind>(i);
    std::size_t count = 0;
    for (const auto& landmark : landmarks) count += landmark.kind == kind ? 1 : 0;
    add(std::string(name(kind)) + ": " + std::to_string(count), colour(kind));
  }
  add("trajectory", TColor(200, 30, 60));
  return result;
}

}  // namespace

mrpt::opengl::COpenGLScene makeScene(const LandmarkMap& landmarks, const Trajectory& trajectory,
                                     const GridPicture& grid) {
  mrpt::opengl::COpenGLScene scene;
  const auto box = extentOf(landmarks, trajectory);
  const Eigen::Vector2d low = (box.min().array() - 1.0).floor();
  const Eigen::Vector2d high = (box.max().array() + 1.0).ceil();
  auto metres = mrpt::opengl::CGridPlaneXY::Create(
      static_cast<float>(low.x()), static_cast<float>(high.x()), static_cast<float>(low.y()),
      static_cast<float>(high.y()), 0.0F, 1.0F);
  metres->setName("metre grid");
  metres->setColor_u8(TColor(190, 195, 200));
  scene.insert(metres);
  if (!grid.cells.empty()) scene.insert(occupancy(grid));
  auto columns = mrpt::opengl::CSetOfObjects::Create();
  columns->setName("vertical landmarks");
  for (const auto& landmark : landmarks)
    if (landmark.kind != LandmarkKind::kFloorEdge && landmark.p_world.allFinite())
      addColumn(landmark, *columns);
  scene.insert(columns);
  for (const auto kind : {LandmarkKind::kPillarEdge, LandmarkKind::kDepthSlope})
    scene.insert(ellipses(landmarks, kind));
  scene.insert(floorEdges(landmarks));
  scene.insert(path(trajectory));
  scene.insert(legend(landmarks, {low.x(), high.y()}));
  auto view = scene.getViewport();
  view->setCustomBackgroundColor(TColorf(1.0F, 1.0F, 1.0F));
  auto& camera = view->getCamera();
  camera.setPointingAt(mrpt::math::TPoint3D(box.center().x(), box.center().y(), 0.0));
  const auto distance = static_cast<float>(1.2 * box.diagonal().norm() + 3.0);
  camera.setZoomDistance(distance);
  view->setViewportClipDistances(0.1F, 20.0F * distance);
  camera.setAzimuthDegrees(-90.0F);
  camera.setElevationDegrees(50.0F);
  return scene;
}

}  // namespace colonnade
