// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "scene.hpp"

#include <mrpt/opengl/CSetOfTexturedTriangles.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <opencv2/core.hpp>

#include "drawn_walker.hpp"
#include "painter.hpp"

namespace colonnade {
namespace {

constexpr int kPagePx = 4096;
constexpr int kMarginPx =
    2;  ///< repeated border, so that neighbours in a page do not shine through

struct Slot {
  std::size_t page = 0;
  cv::Rect area;  ///< of the face's picture, without the margin
};

cv::Size pictureSize(const Face& face, double texels_per_m) {
  const double longest = std::max(face.along.norm(), face.up.norm());
  const double scale = std::min(texels_per_m, (kPagePx - 2 * kMarginPx) / longest);
  const auto pixels = [&](double metres) {
    return std::clamp(static_cast<int>(std::lround(metres * scale)), 4, kPagePx - 2 * kMarginPx);
  };
  return {pixels(face.along.norm()), pixels(face.up.norm())};
}

/// Shelves: faces in the order of their height, side by side, row above row, page after page.
std::vector<Slot> packed(const std::vector<cv::Size>& sizes) {
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return sizes[a].height > sizes[b].height; });
  std::vector<Slot> slots(sizes.size());
  std::size_t page = 0;
  int x = 0, y = 0, shelf = 0;
  for (const auto index : order) {
    const int width = sizes[index].width + 2 * kMarginPx;
    const int height = sizes[index].height + 2 * kMarginPx;
    if (x + width > kPagePx) x = 0, y += shelf, shelf = 0;
    if (y + height > kPagePx) x = 0, y = 0, shelf = 0, ++page;
    slots[index] = {page, {cv::Point(x + kMarginPx, y + kMarginPx), sizes[index]}};
    x += width;
    shelf = std::max(shelf, height);
  }
  return slots;
}

/// Where in a picture (0 to 1, v downwards) the lower left and upper right corner of a face lie.
struct TextureArea {
  float left, bottom, right, top;
};

TextureArea areaOf(const Slot& slot) {
  const auto share = [](int pixels) { return static_cast<float>(pixels) / kPagePx; };
  return {share(slot.area.x), share(slot.area.br().y), share(slot.area.br().x), share(slot.area.y)};
}

void addFace(mrpt::opengl::CSetOfTexturedTriangles& triangles, const Face& face,
             const TextureArea& area) {
  const auto corner = [&](double s, double t) {
    mrpt::opengl::TTriangle::Vertex vertex;
    const Eigen::Vector3d p = face.origin + s * face.along + t * face.up;
    vertex.xyzrgba.pt = {static_cast<float>(p.x()), static_cast<float>(p.y()),
                         static_cast<float>(p.z())};
    const Eigen::Vector3d n = face.normal();
    vertex.normal = {static_cast<float>(n.x()), static_cast<float>(n.y()),
                     static_cast<float>(n.z())};
    vertex.uv = {s > 0.5 ? area.right : area.left, t > 0.5 ? area.top : area.bottom};
    return vertex;
  };
  const std::array corners = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
  for (const auto& [i, j, k] : {std::array{0U, 1U, 2U}, std::array{0U, 2U, 3U}}) {
    mrpt::opengl::TTriangle triangle;
    triangle.vertices = {corners[i], corners[j], corners[k]};
    triangles.insertTriangle(triangle);
  }
}

/// The parts of a scene that arrangeScene looks for.
std::string pageName(std::size_t page) { return "page " + std::to_string(page); }
const std::string kGlassName = "glass";
const std::string kFloorName = "floor";

bool isFloor(const Face& face) { return face.origin.z() == 0.0 && face.normal().z() > 0.5; }

/// The face as a glossy floor shows it.
Face mirrored(Face face) {
  for (auto* p : {&face.origin, &face.along, &face.up}) p->z() = -p->z();
  return face;
}

/// A floor that lets what is mirrored below it shine through.
mrpt::opengl::CSetOfTexturedTriangles::Ptr glossyFloor(const Face& face, const cv::Mat& picture,
                                                       double gloss) {
  auto floor = mrpt::opengl::CSetOfTexturedTriangles::Create();
  addFace(*floor, face, {0.0F, 1.0F, 1.0F, 0.0F});
  const cv::Mat alpha(picture.size(), CV_8UC1, cv::Scalar(255.0 * (1.0 - gloss)));
  floor->assignImage(mrpt::img::CImage(picture, mrpt::img::DEEP_COPY),
                     mrpt::img::CImage(alpha, mrpt::img::DEEP_COPY));
  floor->enableTextureLinearInterpolation(true);
  floor->enableLight(false);
  floor->setName(kFloorName);
  return floor;
}

/// All panes of glass, tinted by their material and the light on them.
mrpt::opengl::CSetOfTexturedTriangles::Ptr glassPanes(const World& world,
                                                      const Building& building) {
  // One row of a small picture per material.
  constexpr int kRow = 4;
  const int rows = kRow * static_cast<int>(world.materials.size());
  cv::Mat tint(rows, kRow, CV_8UC3), alpha(rows, kRow, CV_8UC1);
  for (std::size_t i = 0; i < world.materials.size(); ++i) {
    const auto& material = world.materials[i];
    const cv::Rect area(0, kRow * static_cast<int>(i), kRow, kRow);
    tint(area) = cv::Scalar(material.colour.z(), material.colour.y(), material.colour.x());
    alpha(area) = cv::Scalar(255.0 * material.opacity);
  }
  auto panes = mrpt::opengl::CSetOfTexturedTriangles::Create();
  for (const auto& face : building.faces) {
    if (face.surface != Surface::kGlass) continue;
    const float v =
        (static_cast<float>(face.material) + 0.5F) / static_cast<float>(world.materials.size());
    addFace(*panes, face, {0.5F, v, 0.5F, v});
  }
  panes->assignImage(mrpt::img::CImage(tint, mrpt::img::DEEP_COPY),
                     mrpt::img::CImage(alpha, mrpt::img::DEEP_COPY));
  panes->enableLight(false);
  panes->setName(kGlassName);
  return panes;
}

}  // namespace

mrpt::opengl::COpenGLScene::Ptr buildScene(const World& world, const Building& building) {
  const double gloss = world.materials[world.floor_material].gloss;
  const Painter painter(world, building);
  auto scene = mrpt::opengl::COpenGLScene::Create();
  std::vector<const Face*> faces;
  std::vector<cv::Size> sizes;
  for (const auto& face : building.faces) {
    if (face.surface == Surface::kGlass) continue;
    if (gloss > 0.0 && isFloor(face)) {
      const auto size = pictureSize(face, world.texels_per_m);
      scene->insert(glossyFloor(face, painter.paint(face, 1, size.width, size.height), gloss));
      continue;
    }
    faces.push_back(&face);
    sizes.push_back(pictureSize(face, world.texels_per_m));
  }
  const auto slots = packed(sizes);

  std::vector<cv::Mat> pages;
  std::vector<mrpt::opengl::CSetOfTexturedTriangles::Ptr> sets;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    while (pages.size() <= slots[i].page) {
      pages.emplace_back(kPagePx, kPagePx, CV_8UC3, cv::Scalar::all(0));
      sets.push_back(mrpt::opengl::CSetOfTexturedTriangles::Create());
    }
    const auto picture = painter.paint(*faces[i], static_cast<std::uint32_t>(100 * i),
                                       sizes[i].width, sizes[i].height);
    const cv::Rect area(slots[i].area.tl() - cv::Point(kMarginPx, kMarginPx),
                        slots[i].area.size() + cv::Size(2 * kMarginPx, 2 * kMarginPx));
    cv::copyMakeBorder(picture, pages[slots[i].page](area), kMarginPx, kMarginPx, kMarginPx,
                       kMarginPx, cv::BORDER_REPLICATE);
    addFace(*sets[slots[i].page], *faces[i], areaOf(slots[i]));
    if (gloss > 0.0) addFace(*sets[slots[i].page], mirrored(*faces[i]), areaOf(slots[i]));
  }

  for (std::size_t page = 0; page < pages.size(); ++page) {
    sets[page]->assignImage(mrpt::img::CImage(pages[page], mrpt::img::DEEP_COPY));
    sets[page]->enableTextureLinearInterpolation(true);
    sets[page]->enableLight(false);
    sets[page]->setName(pageName(page));
    scene->insert(sets[page]);
  }
  if (std::any_of(building.faces.begin(), building.faces.end(),
                  [](const Face& face) { return face.surface == Surface::kGlass; })) {
    scene->insert(glassPanes(world, building));
  }
  for (std::size_t i = 0; i < world.walkers.size(); ++i) {
    for (const auto& part : drawnWalker(world.walkers[i], i)) scene->insert(part);
  }
  return scene;
}

void arrangeScene(mrpt::opengl::COpenGLScene& scene, const std::vector<Walker>& walkers,
                  const Eigen::Isometry3d& T_world_camera, double time_s) {
  // MRPT draws what has the more distant representative point first: what glossy floors and glass
  // let through before these.
  const auto represent = [&](mrpt::opengl::CRenderizable& object, double distance_m) {
    const Eigen::Vector3f p =
        (T_world_camera * Eigen::Vector3d(0.0, 0.0, distance_m)).cast<float>();
    object.setLocalRepresentativePoint({p.x(), p.y(), p.z()});
  };
  for (std::size_t page = 0; const auto set = scene.getByName(pageName(page)); ++page) {
    represent(*set, 10.0);
  }
  if (const auto floor = scene.getByName(kFloorName)) represent(*floor, 5.0);
  if (const auto glass = scene.getByName(kGlassName)) represent(*glass, 1.0);
  for (std::size_t i = 0; i < walkers.size(); ++i) moveWalker(scene, walkers[i], i, time_s);
}

}  // namespace colonnade
