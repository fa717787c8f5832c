// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/renderer.hpp"

#include <mrpt/opengl/CFBORender.h>
#include <mrpt/poses/CPose3D.h>

#include <opencv2/imgproc.hpp>

#include "colonnade/base/error.hpp"
#include "scene.hpp"

namespace colonnade {
namespace {

constexpr float kNearM = 0.1F;
constexpr float kFarM = 60.0F;

std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

/// MRPT counts from the image's corner, we from the centre of its first pixel.
mrpt::img::TCamera enlarged(const PinholeCamera& camera, int factor) {
  mrpt::img::TCamera result;
  result.ncols = static_cast<std::uint32_t>(camera.width_px * factor);
  result.nrows = static_cast<std::uint32_t>(camera.height_px * factor);
  result.setIntrinsicParamsFromValues(camera.fx_px * factor, camera.fy_px * factor,
                                      (camera.cx_px + 0.5) * factor, (camera.cy_px + 0.5) * factor);
  return result;
}

std::unique_ptr<mrpt::opengl::CFBORender> openRenderer(unsigned width, unsigned height) {
  try {
    return std::make_unique<mrpt::opengl::CFBORender>(width, height);
  } catch (const std::exception& error) {
    throw Error("no off-screen rendering: " + firstLine(error.what()) +
                "; install libegl1 and libgl1-mesa-dri");
  }
}

}  // namespace

struct Renderer::Impl {
  PinholeCamera camera;
  int factor;
  std::unique_ptr<mrpt::opengl::CFBORender> target;
  mrpt::opengl::COpenGLScene::Ptr scene;
  std::vector<Walker> walkers;
  mrpt::img::CImage image;
  mrpt::math::CMatrixFloat depth;
};

Renderer::Renderer(const World& world, const Building& building) : impl_(std::make_unique<Impl>()) {
  impl_->camera = world.camera.pinhole();
  impl_->factor = world.camera.supersampling;
  const auto lens = enlarged(impl_->camera, impl_->factor);
  impl_->target = openRenderer(lens.ncols, lens.nrows);
  impl_->scene = buildScene(world, building);
  impl_->walkers = world.walkers;
  impl_->scene->getViewport()->setViewportClipDistances(kNearM, kFarM);
  auto& eye = impl_->target->getCamera(*impl_->scene);
  eye.setProjectiveFromPinhole(lens);
  eye.set6DOFMode(true);
}

Renderer::~Renderer() = default;

RenderedView Renderer::render(const Eigen::Isometry3d& T_world_camera, double time_s) {
  arrangeScene(*impl_->scene, impl_->walkers, T_world_camera, time_s);
  // CCamera in 6DOF mode is optical: x right, y down, z forward.
  impl_->target->getCamera(*impl_->scene)
      .setPose(mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(T_world_camera.matrix())));
  impl_->target->render_RGBD(*impl_->scene, impl_->image, impl_->depth);

  RenderedView view;
  const cv::Mat big = impl_->image.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
  const cv::Size size(impl_->camera.width_px, impl_->camera.height_px);
  cv::resize(big, view.colour, size, 0, 0, cv::INTER_AREA);
  view.depth_m.create(size, CV_32FC1);
  const int factor = impl_->factor;
  for (int row = 0; row < size.height; ++row) {
    for (int column = 0; column < size.width; ++column) {
      view.depth_m.at<float>(row, column) =
          impl_->depth(row * factor + factor / 2, column * factor + factor / 2);
    }
  }
  return view;
}

std::string whyNoRendering() {
  try {
    openRenderer(32, 32);
    return {};
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace colonnade
