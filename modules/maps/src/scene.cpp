// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "scene.hpp"

#include <mrpt/opengl/CCylinder.h>
#include <mrpt/opengl/CEllipsoid2D.h>
#include <mrpt/opengl/CGridPlaneXY.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CText.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

namespace colonnade {
namespace {

using mrpt::img::TColor;
using mrpt::img::TColorf;

constexpr float kColumnHeight_m = 2.0F;
constexpr float kQuantile95 = 2.4477F;  ///< sqrt of the 95 % point of chi-squared with 2
constexpr double kLift_m = 0.01;        ///< so that nothing hides in the floor

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
  column->setColor_u8(kind_colour);
  column->setLocation(p.x(), p.y(), 0.0);
  column_set.insert(column);
  column_set.insert(label(id, p, kColumnHeight_m + 0.1, kind_colour));
  if (!landmark.covariance.allFinite() || landmark.covariance.determinant() <= 0.0) return;
  auto ellipse = mrpt::opengl::CEllipsoid2D::Create();
  mrpt::math::CMatrixDouble covariance(2, 2);
  for (int row = 0; row < 2; ++row)
    for (int cell = 0; cell < 2; ++cell) covariance(row, cell) = landmark.covariance(row, cell);
  ellipse->setCovMatrix(covariance);
  ellipse->setQuantiles(kQuantile95);
  ellipse->setColor_u8(kind_colour);
  ellipse->setLocation(p.x(), p.y(), kLift_m);
  column_set.insert(ellipse);
}

mrpt::opengl::CSetOfLines::Ptr floorEdges(const LandmarkMap& landmarks) {
  auto lines = mrpt::opengl::CSetOfLines::Create();
  lines->setName("floor edges");
  lines->setColor_u8(colour(LandmarkKind::kFloorEdge));
  lines->setLineWidth(4.0F);
  for (const auto& landmark : landmarks) {
    if (landmark.kind != LandmarkKind::kFloorEdge) continue;
    const auto& a = landmark.extent_a;
    const auto& b = landmark.extent_b;
    lines->appendLine(a.x(), a.y(), kLift_m, b.x(), b.y(), kLift_m);
  }
  return lines;
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
                                     const mrpt::maps::COccupancyGridMap2D* grid) {
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
  if (grid) {
    auto occupancy = mrpt::opengl::CSetOfObjects::Create();
    occupancy->setName("occupancy");
    occupancy->setLocation(0.0, 0.0, -kLift_m);
    grid->getVisualizationInto(*occupancy);
    scene.insert(occupancy);
  }
  auto columns = mrpt::opengl::CSetOfObjects::Create();
  columns->setName("vertical landmarks");
  for (const auto& landmark : landmarks)
    if (landmark.kind != LandmarkKind::kFloorEdge && landmark.p_world.allFinite())
      addColumn(landmark, *columns);
  scene.insert(columns);
  scene.insert(floorEdges(landmarks));
  scene.insert(path(trajectory));
  scene.insert(legend(landmarks, {low.x(), high.y()}));
  auto view = scene.getViewport();
  view->setCustomBackgroundColor(TColorf(1.0F, 1.0F, 1.0F));
  auto& camera = view->getCamera();
  camera.setPointingAt(mrpt::math::TPoint3D(box.center().x(), box.center().y(), 0.0));
  camera.setZoomDistance(static_cast<float>(1.3 * box.diagonal().norm() + 3.0));
  camera.setAzimuthDegrees(-90.0F);
  camera.setElevationDegrees(50.0F);
  return scene;
}

}  // namespace colonnade
