// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "lens_falloff.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "residuals.hpp"
#include "rgbd_alignment.hpp"
#include "synthetic_scene.hpp"

namespace colonnade {
namespace {

using testing::cameraInWorld;
using testing::Scene;

constexpr double kFalloff = 0.45;

Scene seenThroughALens() {
  Scene scene = Scene::corridor(true, true);
  scene.lens_falloff = kFalloff;
  return scene;
}

RgbdPyramid seen(const Scene& scene, std::size_t index, const Eigen::Isometry3d& T_world_camera) {
  return makePyramid(scene.render(index, 0.0, T_world_camera), 4);
}

TEST(LensFalloff, ItsDerivativeIsTheNumericOne) {
  const Scene scene = seenThroughALens();
  const auto before = cameraInWorld(0.0, 0.0, 1.1, 0.0, 0.2);
  const auto after = cameraInWorld(0.02, 0.0, 1.1, radians(5.0), 0.2);
  const auto key = seen(scene, 0, before), now = seen(scene, 1, after);
  const auto points = selectPhotometricPoints(key.levels[0], 4, 3.0F);
  const AlignmentState state{after.inverse() * before, 0.0, 0.0};
  const auto rowsAt = [&](double falloff) {
    ResidualBuffer buffer;
    photometricEquations(points, now.levels[0], state, falloff, 0.0, buffer);
    return buffer;
  };
  constexpr double kStep = 0.01;
  const ResidualBuffer at = rowsAt(kFalloff), more = rowsAt(kFalloff + kStep),
                       less = rowsAt(kFalloff - kStep);
  ASSERT_GT(at.rows.size(), 500U);
  double error = 0.0, size = 0.0;
  for (std::size_t i = 0; i < at.rows.size(); ++i) {
    const double numeric = static_cast<double>(more.rows[i].r - less.rows[i].r) / (2.0 * kStep);
    error += std::pow(numeric - static_cast<double>(at.by_falloff[i]), 2);
    size += std::pow(numeric, 2);
  }
  EXPECT_LT(std::sqrt(error / size), 0.1);  // by the mean of both brightnesses, which nearly agree
}

/// Turns about itself, as to look around.
LensFalloff learnt(const Scene& scene, double turn_per_frame, int frames) {
  LensFalloff falloff;
  auto key = makeReference(seen(scene, 0, cameraInWorld(0.0, 0.0, 1.1, 0.0, 0.2)));
  for (int i = 1; i <= frames; ++i) {
    const auto now = seen(scene, static_cast<std::size_t>(i),
                          cameraInWorld(0.0, 0.0, 1.1, turn_per_frame * i, 0.2));
    AlignmentOptions options;
    options.lens_falloff = falloff.value();
    MotionPrior prior;
    prior.information.diagonal().setConstant(100.0);
    const Alignment alignment = align(key, now, prior, {}, options);
    falloff.update(alignment.falloff_step, alignment.falloff_information);
    key = makeReference(now);
  }
  return falloff;
}

TEST(LensFalloff, IsLearntFromWhatCrossesThePicture) {
  EXPECT_NEAR(learnt(seenThroughALens(), radians(4.0), 12).value(), kFalloff, 0.05);
}

TEST(LensFalloff, ThereIsNoneWithAnEvenLens) {
  EXPECT_NEAR(learnt(Scene::corridor(true, true), radians(4.0), 12).value(), 0.0, 0.05);
}

TEST(LensFalloff, NoiseSeenByACameraAtRestTeachesNothing) {
  Scene scene = Scene::corridor(true, true);
  scene.brightness_noise = 2.0;
  EXPECT_NEAR(learnt(scene, 0.0, 12).value(), 0.0, 0.02);
}

}  // namespace
}  // namespace colonnade
