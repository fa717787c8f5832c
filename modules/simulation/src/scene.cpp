// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "scene.hpp"

#include <mrpt/opengl/CSetOfTexturedTriangles.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <opencv2/core.hpp>

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

void addFace(mrpt::opengl::CSetOfTexturedTriangles& triangles, const Face& face, const Slot& slot) {
  const auto corner = [&](double s, double t) {
    mrpt::opengl::TTriangle::Vertex vertex;
    const Eigen::Vector3d p = face.origin + s * face.along + t * face.up;
    vertex.xyzrgba.pt = {static_cast<float>(p.x()), static_cast<float>(p.y()),
                         static_cast<float>(p.z())};
    const Eigen::Vector3d n = face.normal();
    vertex.normal = {static_cast<float>(n.x()), static_cast<float>(n.y()),
                     static_cast<float>(n.z())};
    vertex.uv = {static_cast<float>((slot.area.x + s * slot.area.width) / kPagePx),
                 static_cast<float>((slot.area.y + (1.0 - t) * slot.area.height) / kPagePx)};
    return vertex;
  };
  const std::array corners = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
  for (const auto& [i, j, k] : {std::array{0U, 1U, 2U}, std::array{0U, 2U, 3U}}) {
    mrpt::opengl::TTriangle triangle;
    triangle.vertices = {corners[i], corners[j], corners[k]};
    triangles.insertTriangle(triangle);
  }
}

}  // namespace

mrpt::opengl::COpenGLScene::Ptr buildScene(const World& world, const Building& building) {
  std::vector<cv::Size> sizes;
  for (const auto& face : building.faces) sizes.push_back(pictureSize(face, world.texels_per_m));
  const auto slots = packed(sizes);
  const Painter painter(world, building);

  std::vector<cv::Mat> pages;
  std::vector<mrpt::opengl::CSetOfTexturedTriangles::Ptr> sets;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    while (pages.size() <= slots[i].page) {
      pages.emplace_back(kPagePx, kPagePx, CV_8UC3, cv::Scalar::all(0));
      sets.push_back(mrpt::opengl::CSetOfTexturedTriangles::Create());
    }
    const auto picture = painter.paint(building.faces[i], static_cast<std::uint32_t>(100 * i),
                                       sizes[i].width, sizes[i].height);
    const cv::Rect area(slots[i].area.tl() - cv::Point(kMarginPx, kMarginPx),
                        slots[i].area.size() + cv::Size(2 * kMarginPx, 2 * kMarginPx));
    cv::copyMakeBorder(picture, pages[slots[i].page](area), kMarginPx, kMarginPx, kMarginPx,
                       kMarginPx, cv::BORDER_REPLICATE);
    addFace(*sets[slots[i].page], building.faces[i], slots[i]);
  }

  auto scene = mrpt::opengl::COpenGLScene::Create();
  for (std::size_t page = 0; page < pages.size(); ++page) {
    sets[page]->assignImage(mrpt::img::CImage(pages[page], mrpt::img::DEEP_COPY));
    sets[page]->enableTextureLinearInterpolation(true);
    sets[page]->enableLight(false);
    scene->insert(sets[page]);
  }
  return scene;
}

}  // namespace colonnade
