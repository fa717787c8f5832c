// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/renderer.hpp"

#include <mrpt/opengl/CFBORender.h>
#include <mrpt/poses/CPose3D.h>

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>

#include "colonnade/base/error.hpp"
#include "scene.hpp"

namespace colonnade {
namespace {

constexpr float kNearM = 0.1F;
constexpr float kFarM = 60.0F;

/// MRPT makes depth linear with a table of 2^18 entries over [-1, 1], of which OpenGL uses the
/// upper half, and cuts the place in it off: inverse depth comes in steps and is half of one too
/// large.
constexpr float kHalfStep = 0.5F * (1.0F / kNearM - 1.0F / kFarM) / 131072.0F;

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

using Target = mrpt::opengl::CFBORender;

/// `own_context`: the first one of a thread; further ones draw the same scene in its context.
std::unique_ptr<Target> openRenderer(unsigned width, unsigned height, bool own_context = true) {
  try {
    Target::Parameters parameters(width, height);
    parameters.create_EGL_context = own_context;
    return std::make_unique<Target>(parameters);
  } catch (const std::exception& error) {
    throw Error("no off-screen rendering: " + firstLine(error.what()) +
                "; install libegl1 and libgl1-mesa-dri");
  }
}

/// One camera that looks at the scene.
struct Eye {
  cv::Size size;
  int factor = 1;  ///< rendered pixels per pixel and axis
  std::unique_ptr<Target> target;
  mrpt::img::CImage image;
  mrpt::math::CMatrixFloat depth;

  Eye(const PinholeCamera& camera, int rendered_per_pixel, const mrpt::opengl::COpenGLScene& scene,
      bool own_context)
      : size(camera.width_px, camera.height_px), factor(rendered_per_pixel) {
    const auto lens = enlarged(camera, factor);
    target = openRenderer(lens.ncols, lens.nrows, own_context);
    auto& eye = target->getCamera(scene);
    eye.setProjectiveFromPinhole(lens);
    eye.set6DOFMode(true);
  }

  void moveTo(const Eigen::Isometry3d& T_world_camera, const mrpt::opengl::COpenGLScene& scene) {
    // CCamera in 6DOF mode is optical: x right, y down, z forward.
    target->getCamera(scene).setPose(
        mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(T_world_camera.matrix())));
  }

  cv::Mat colour() const {
    const cv::Mat big = image.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
    if (factor == 1) return big.clone();
    cv::Mat result;
    cv::resize(big, result, size, 0, 0, cv::INTER_AREA);
    return result;
  }

  cv::Mat centreDepth() const {
    cv::Mat result(size, CV_32FC1);
    for (int row = 0; row < size.height; ++row) {
      auto* found = result.ptr<float>(row);
      const float* upper = &depth(row * factor + (factor - 1) / 2, 0);
      const float* lower = &depth(row * factor + factor / 2, 0);
      for (int column = 0; column < size.width; ++column) {
        const int left = column * factor + (factor - 1) / 2, right = column * factor + factor / 2;
        const float z = left == right
                            ? upper[left]
                            : between({upper[left], upper[right], lower[left], lower[right]},
                                      (row + column) % 2 == 0);
        found[column] = z > 0.0F ? 1.0F / (1.0F / z - kHalfStep) : z;
      }
    }
    return result;
  }

  /// The depth amid four samples around a pixel's centre. Inverse depth is affine in the image of a
  /// plane, so that their mean is exact there; at an outline the majority counts, and where two
  /// stand against two, the nearer or the farther.
  static float between(std::array<float, 4> z, bool nearer) {
    constexpr float kSpread = 1.03F;
    const auto [low, high] = std::minmax_element(z.begin(), z.end());
    if (*low > 0.0F && *high < kSpread * *low) {
      return 4.0F / (1.0F / z[0] + 1.0F / z[1] + 1.0F / z[2] + 1.0F / z[3]);
    }
    std::sort(z.begin(), z.end());
    return nearer ? z[1] : z[2];
  }
};

}  // namespace

struct Renderer::Impl {
  mrpt::opengl::COpenGLScene::Ptr scene;
  std::vector<Walker> walkers;
  std::unique_ptr<Eye> eye;
  std::unique_ptr<Eye> mono;
};

Renderer::Renderer(const World& world, const Building& building) : impl_(std::make_unique<Impl>()) {
  impl_->walkers = world.walkers;
  impl_->scene = buildScene(world, building);
  impl_->scene->getViewport()->setViewportClipDistances(kNearM, kFarM);
  const int factor = world.camera.renderedPerPixel();
  impl_->eye = std::make_unique<Eye>(world.camera.pinhole(), factor, *impl_->scene, true);
  if (world.mono.enabled) {
    impl_->mono = std::make_unique<Eye>(world.mono.pinhole(), factor, *impl_->scene, false);
  }
}

Renderer::~Renderer() = default;

RenderedView Renderer::render(const Eigen::Isometry3d& T_world_camera, double time_s) {
  arrangeScene(*impl_->scene, impl_->walkers, T_world_camera, time_s);
  Eye& eye = *impl_->eye;
  eye.moveTo(T_world_camera, *impl_->scene);
  eye.target->render_RGBD(*impl_->scene, eye.image, eye.depth);
  return {eye.colour(), eye.centreDepth()};
}

cv::Mat Renderer::renderMono(const Eigen::Isometry3d& T_world_camera, double time_s) {
  arrangeScene(*impl_->scene, impl_->walkers, T_world_camera, time_s);
  Eye& eye = *impl_->mono;
  eye.moveTo(T_world_camera, *impl_->scene);
  eye.target->render_RGB(*impl_->scene, eye.image);
  return eye.colour();
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
