// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "drawn_walker.hpp"

#include <mrpt/poses/CPose3D.h>

#include <array>
#include <cmath>

#include "colonnade/simulation/random.hpp"

namespace colonnade {
namespace {

constexpr double kStepM = 0.70;           ///< length of a step
constexpr double kSwing = radians(24.0);  ///< of a leg to either side
constexpr double kRadiansPerStep = kPi;   ///< of the swing
constexpr int kSides = 14;                ///< of a limb's outline
constexpr double kRingM = 0.05;           ///< height of a ring of facets
constexpr double kSideLight = 0.28;       ///< share of light lost between front and back
const Eigen::Vector3d kSkin(186, 144, 120);

/// A part of the body: elliptic, from `bottom` to `top` of the joint it hangs on.
struct Limb {
  double bottom, top;         ///< metres from the joint, of a person of 1.75 m
  double radius_x, radius_y;  ///< at the top
  double taper;               ///< radius at the bottom, relative
  Eigen::Vector3d colour;
};

/// A joint of the body with the limbs that move with it.
struct Part {
  std::string name;
  double y, z;   ///< of the joint
  double swing;  ///< sign and share of kSwing
  std::vector<Limb> limbs;
};

std::vector<Part> partsOf(const Walker& walker) {
  const Eigen::Vector3d &top = walker.clothes, &legs = walker.trousers;
  const Eigen::Vector3d shoes(38, 34, 32), hair(54, 42, 34);
  const auto leg = [&](const char* name, double y, double swing) {
    return Part{name,
                y,
                0.90,
                swing,
                {{-0.84, 0.0, 0.085, 0.085, 0.65, legs}, {-0.90, -0.84, 0.11, 0.05, 1.1, shoes}}};
  };
  const auto arm = [&](const char* name, double y, double swing) {
    return Part{name,
                y,
                1.42,
                swing,
                {{-0.52, 0.0, 0.05, 0.05, 0.8, top}, {-0.62, -0.52, 0.04, 0.03, 0.8, kSkin}}};
  };
  return {{"trunk",
           0.0,
           0.0,
           0.0,
           {{0.86, 1.46, 0.13, 0.20, 0.85, top},
            {1.44, 1.52, 0.055, 0.055, 1.0, kSkin},
            {1.51, 1.66, 0.09, 0.075, 0.8, kSkin},
            {1.66, 1.75, 0.06, 0.05, 1.5, hair}}},
          leg("left leg", 0.10, 1.0),
          leg("right leg", -0.10, -1.0),
          arm("left arm", 0.24, -0.7),
          arm("right arm", -0.24, 0.7)};
}

std::string nameOf(std::size_t walker, const std::string& part) {
  return "walker " + std::to_string(walker) + " " + part;
}

using Vertex = mrpt::opengl::TTriangle::Vertex;

/// Rings of facets, shaded: darker away from the front and with the folds of cloth.
void addLimb(mrpt::opengl::CSetOfTriangles& triangles, const Limb& limb, double scale,
             std::uint32_t seed) {
  const double length = limb.top - limb.bottom;
  const int rings = std::max(1, static_cast<int>(std::lround(length / kRingM)));
  const auto vertex = [&](int ring, int side, double inward) {
    const double share = static_cast<double>(ring) / rings;  // 0 at the bottom
    const double width = (limb.taper + (1.0 - limb.taper) * share) * (1.0 - inward);
    const double angle = 2.0 * kPi * side / kSides;
    const double light =
        1.0 - 0.5 * kSideLight * (1.0 - std::cos(angle)) +
        0.12 * latticeNoise(3.0 * std::cos(angle), 3.0 * std::sin(angle) + ring, seed);
    Vertex v;
    v.xyzrgba.pt = {static_cast<float>(scale * width * limb.radius_x * std::cos(angle)),
                    static_cast<float>(scale * width * limb.radius_y * std::sin(angle)),
                    static_cast<float>(scale * (limb.bottom + share * length))};
    const auto channel = [&](int i) {
      return static_cast<std::uint8_t>(std::clamp(light * limb.colour[i], 0.0, 255.0));
    };
    v.xyzrgba.r = channel(0);
    v.xyzrgba.g = channel(1);
    v.xyzrgba.b = channel(2);
    v.xyzrgba.a = 255;
    v.normal = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0.0F};
    return v;
  };
  const auto add = [&](const Vertex& a, const Vertex& b, const Vertex& c) {
    mrpt::opengl::TTriangle triangle;
    triangle.vertices = {a, b, c};
    triangles.insertTriangle(triangle);
  };
  for (int side = 0; side < kSides; ++side) {
    for (int ring = 0; ring < rings; ++ring) {
      const auto a = vertex(ring, side, 0), b = vertex(ring, side + 1, 0);
      const auto c = vertex(ring + 1, side + 1, 0), d = vertex(ring + 1, side, 0);
      add(a, b, c);
      add(a, c, d);
    }
    for (const int end : {0, rings}) {
      add(vertex(end, side, 0), vertex(end, side + 1, 0), vertex(end, side, 1));
    }
  }
}

}  // namespace

std::vector<mrpt::opengl::CSetOfTriangles::Ptr> drawnWalker(const Walker& walker,
                                                            std::size_t index) {
  std::vector<mrpt::opengl::CSetOfTriangles::Ptr> result;
  auto seed = static_cast<std::uint32_t>(1000 * index);
  for (const auto& part : partsOf(walker)) {
    auto triangles = mrpt::opengl::CSetOfTriangles::Create();
    for (const auto& limb : part.limbs) {
      addLimb(*triangles, limb, walker.height_m / 1.75, ++seed);
    }
    triangles->enableLight(false);
    triangles->setName(nameOf(index, part.name));
    result.push_back(triangles);
  }
  return result;
}

void moveWalker(mrpt::opengl::COpenGLScene& scene, const Walker& walker, std::size_t index,
                double time_s) {
  const double scale = walker.height_m / 1.75;
  const auto body = walker.poseAt(time_s);
  const mrpt::poses::CPose3D T_world_walker(body.x, body.y, 0.0, body.phi, 0.0, 0.0);
  const double phase = kRadiansPerStep * walker.distanceAt(time_s) / (kStepM * scale);
  for (const auto& part : partsOf(walker)) {
    const auto object = scene.getByName(nameOf(index, part.name));
    if (!object) continue;
    const double pitch = part.swing * kSwing * std::sin(phase);
    object->setPose(T_world_walker +
                    mrpt::poses::CPose3D(0.0, scale * part.y, scale * part.z, 0.0, pitch, 0.0));
  }
}

}  // namespace colonnade
