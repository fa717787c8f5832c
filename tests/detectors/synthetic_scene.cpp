// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "synthetic_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <random>

#include "colonnade/detectors/depth_noise.hpp"

namespace colonnade::testing {
namespace {

struct Hit {
  double t = std::numeric_limits<double>::infinity();  ///< in ray lengths, = depth
  double gray = 90.0;                                  ///< of nothing at all
};

double floorGray(const Scene& scene, const Eigen::Vector2d& p) {
  for (const auto& strip : scene.strips) {
    const Eigen::Vector2d along = (strip.b - strip.a).normalized();
    const Eigen::Vector2d d = p - strip.a;
    const double s = along.dot(d);
    const double across = along.x() * d.y() - along.y() * d.x();
    if (s >= 0.0 && s <= (strip.b - strip.a).norm() && std::abs(across) <= strip.width_m / 2.0) {
      return strip.gray;
    }
  }
  return scene.floor_gray;
}

Hit cast(const Scene& scene, const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
  Hit hit;
  if (ray.z() < -1e-6) {
    const double t = -origin.z() / ray.z();
    hit = {t, floorGray(scene, (origin + t * ray).head<2>())};
  }
  for (const auto& face : scene.faces) {
    const Eigen::Vector2d along = face.b - face.a;
    // Points of the face: a + s along + z (lean, 0) at height z.
    Eigen::Matrix3d m;
    m.col(0) << along, 0.0;
    m.col(1) << face.lean, 0.0, 1.0;
    m.col(2) = -ray;
    if (std::abs(m.determinant()) < 1e-12) continue;
    const Eigen::Vector3d from(origin.x() - face.a.x(), origin.y() - face.a.y(), origin.z());
    const Eigen::Vector3d solution = m.inverse() * from;
    const double s = solution.x();
    const double z = solution.y();
    const double t = solution.z();
    if (s < 0.0 || s > 1.0 || z < face.bottom_m || z > face.top_m) continue;
    if (t > 0.0 && t < hit.t) hit = {t, face.gray};
  }
  return hit;
}

}  // namespace

Eigen::Isometry3d mounting(const CameraPlace& place) {
  Eigen::Matrix3d R_robot_level;  // optical axes of a level camera that looks along x
  R_robot_level << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(place.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
               Eigen::AngleAxisd(place.pitch_down, Eigen::Vector3d::UnitY()).toRotationMatrix() *
               Eigen::AngleAxisd(place.roll, Eigen::Vector3d::UnitX()).toRotationMatrix() *
               R_robot_level;
  T.translation() << place.p_robot, place.height_m;
  return T;
}

Frame render(const Scene& scene, const CameraPlace& place, int width_px, int height_px) {
  Frame frame;
  const double focal = 535.0 * width_px / 640.0;
  frame.camera = {width_px, height_px, focal, focal, 0.49 * width_px, 0.51 * height_px};
  frame.T_robot_camera = mounting(place);
  frame.gray.create(height_px, width_px, CV_8UC1);
  frame.depth_m.create(height_px, width_px, CV_32FC1);
  const Eigen::Vector3d origin = frame.T_robot_camera.translation();
  const Eigen::Matrix3d R = frame.T_robot_camera.linear();
  for (int v = 0; v < height_px; ++v) {
    for (int u = 0; u < width_px; ++u) {
      double sum = 0.0;
      for (const double dv : {-1.0 / 3.0, 0.0, 1.0 / 3.0}) {
        for (const double du : {-1.0 / 3.0, 0.0, 1.0 / 3.0}) {
          const Hit hit = cast(scene, origin, R * frame.camera.ray(u + du, v + dv));
          sum += hit.gray;
          if (du == 0.0 && dv == 0.0) {
            frame.depth_m.at<float>(v, u) = hit.t < 9.0 ? static_cast<float>(hit.t) : 0.0F;
          }
        }
      }
      frame.gray.at<unsigned char>(v, u) = static_cast<unsigned char>(std::lround(sum / 9.0));
    }
  }
  return frame;
}

Frame withNoise(const Frame& frame, double gray_sigma, std::uint32_t seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  Frame noisy = frame;
  noisy.gray = frame.gray.clone();
  noisy.depth_m = frame.depth_m.clone();
  const int blocks = (frame.depth_m.cols + 2) / 3;
  std::vector<double> shared(static_cast<std::size_t>(blocks));
  for (int v = 0; v < frame.gray.rows; ++v) {
    if (v % 3 == 0) std::generate(shared.begin(), shared.end(), [&] { return normal(generator); });
    for (int u = 0; u < frame.gray.cols; ++u) {
      auto& gray = noisy.gray.at<unsigned char>(v, u);
      gray = cv::saturate_cast<unsigned char>(gray + gray_sigma * normal(generator));
      auto& depth = noisy.depth_m.at<float>(v, u);
      if (depth > 0.0F) {
        depth += static_cast<float>(kinectDepthSigma(static_cast<double>(depth)) *
                                    shared[static_cast<std::size_t>(u / 3)]);
      }
    }
  }
  return noisy;
}

Detections detectAll(const Frame& frame, const DetectorOptions& options) {
  const auto edges = makeEdgeLineBackend(kDefaultBackend, {})->extract(frame.gray);
  return DetectorBank(options).detect(frame, edges);
}

Detections accepted(const Detections& detections, LandmarkKind kind) {
  Detections result;
  std::copy_if(detections.begin(), detections.end(), std::back_inserter(result),
               [&](const Detection& d) { return d.accepted() && d.kind() == kind; });
  return result;
}

const Detection* nearestBearing(const Detections& detections, double bearing) {
  const auto off = [&](const Detection& d) {
    return std::abs(wrapAngle(d.measurement.z[0] - bearing));
  };
  const auto best =
      std::min_element(detections.begin(), detections.end(),
                       [&](const Detection& a, const Detection& b) { return off(a) < off(b); });
  return best == detections.end() ? nullptr : &*best;
}

}  // namespace colonnade::testing
