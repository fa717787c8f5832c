// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rgbd_pyramid.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace colonnade {
namespace {

constexpr int kFinestWidth_px = 400;
constexpr int kSmallestHeight_px = 24;
constexpr float kMinDepth_m = 0.3f;
constexpr float kMaxDepth_m = 8.0f;

PinholeCamera halved(const PinholeCamera& camera) {
  PinholeCamera half = camera;
  half.width_px = camera.width_px / 2;
  half.height_px = camera.height_px / 2;
  half.fx_px = 0.5 * camera.fx_px;
  half.fy_px = 0.5 * camera.fy_px;
  half.cx_px = 0.5 * (camera.cx_px + 0.5) - 0.5;  // pixel centres have whole coordinates
  half.cy_px = 0.5 * (camera.cy_px + 0.5) - 0.5;
  return half;
}

/// Mean of the foremost surface in each 2 x 2 block: never mixes two surfaces.
cv::Mat halvedDepth(const cv::Mat& depth_m) {
  cv::Mat half(depth_m.rows / 2, depth_m.cols / 2, CV_32FC1);
  for (int v = 0; v < half.rows; ++v) {
    const float* upper = depth_m.ptr<float>(2 * v);
    const float* lower = depth_m.ptr<float>(2 * v + 1);
    float* out = half.ptr<float>(v);
    for (int u = 0; u < half.cols; ++u) {
      const float values[4] = {upper[2 * u], upper[2 * u + 1], lower[2 * u], lower[2 * u + 1]};
      float nearest = kMaxDepth_m;
      for (float value : values) {
        if (value >= kMinDepth_m && value < nearest) nearest = value;
      }
      float sum = 0.0f;
      int count = 0;
      for (float value : values) {
        if (value >= kMinDepth_m && value <= 1.03f * nearest) {
          sum += value;
          ++count;
        }
      }
      out[u] = count > 0 && nearest < kMaxDepth_m ? sum / static_cast<float>(count) : 0.0f;
    }
  }
  return half;
}

/// Brightness with central differences beside it, so that one interpolation fetches all three.
cv::Mat withDerivatives(const cv::Mat& gray) {
  cv::Mat out(gray.rows, gray.cols, CV_32FC4, cv::Scalar::all(0));
  for (int v = 0; v < gray.rows; ++v) {
    const float* above = gray.ptr<float>(std::max(v - 1, 0));
    const float* here = gray.ptr<float>(v);
    const float* below = gray.ptr<float>(std::min(v + 1, gray.rows - 1));
    auto* to = out.ptr<cv::Vec4f>(v);
    for (int u = 0; u < gray.cols; ++u) {
      const int left = std::max(u - 1, 0);
      const int right = std::min(u + 1, gray.cols - 1);
      to[u] = {here[u], 0.5f * (here[right] - here[left]), 0.5f * (below[u] - above[u]), 0.0f};
    }
  }
  return out;
}

bool isContinuous(const cv::Mat& depth_m, int u, int v) {
  const float centre = depth_m.at<float>(v, u);
  if (!(centre > 0.0f)) return false;
  const float tolerance = 0.04f * centre + 0.02f;
  for (int dv = -1; dv <= 1; ++dv) {
    const float* row = depth_m.ptr<float>(v + dv);
    for (int du = -1; du <= 1; ++du) {
      const float value = row[u + du];
      if (value > 0.0f && std::abs(value - centre) > tolerance) return false;
    }
  }
  return true;
}

}  // namespace

RgbdPyramid makePyramid(const Frame& frame, int levels) {
  RgbdPyramid pyramid;
  if (frame.depth_m.empty() || !frame.camera.isCalibrated()) return pyramid;
  PinholeCamera camera = frame.camera;
  pyramid.gray = frame.gray.empty() ? cv::Mat::zeros(frame.depth_m.size(), CV_8UC1) : frame.gray;
  cv::Mat depth_m = frame.depth_m;
  while (camera.width_px > kFinestWidth_px) {
    camera = halved(camera);
    cv::Mat smaller;
    cv::resize(pyramid.gray, smaller, {camera.width_px, camera.height_px}, 0, 0, cv::INTER_AREA);
    pyramid.gray = smaller;
    depth_m = halvedDepth(depth_m);
  }
  cv::Mat gray;
  pyramid.gray.convertTo(gray, CV_32F);
  cv::GaussianBlur(gray, gray, {3, 3}, 0.7);
  for (int level = 0; level < levels; ++level) {
    pyramid.levels.push_back({camera, withDerivatives(gray), depth_m});
    if (level + 1 == levels || camera.height_px < 2 * kSmallestHeight_px) break;
    camera = halved(camera);
    cv::Mat smaller;
    cv::resize(gray, smaller, {camera.width_px, camera.height_px}, 0, 0, cv::INTER_AREA);
    gray = smaller;
    depth_m = halvedDepth(depth_m);
  }
  return pyramid;
}

std::vector<PhotometricPoint> selectPhotometricPoints(const PyramidLevel& level, int cell_px,
                                                      float min_gradient) {
  std::vector<PhotometricPoint> points;
  const int rows = level.depth_m.rows;
  const int cols = level.depth_m.cols;
  for (int v0 = 2; v0 + cell_px <= rows - 2; v0 += cell_px) {
    for (int u0 = 2; u0 + cell_px <= cols - 2; u0 += cell_px) {
      float best = min_gradient * min_gradient;
      int best_u = -1;
      int best_v = -1;
      for (int v = v0; v < v0 + cell_px; ++v) {
        const auto* row = level.intensity.ptr<cv::Vec4f>(v);
        const float* depth_row = level.depth_m.ptr<float>(v);
        for (int u = u0; u < u0 + cell_px; ++u) {
          const float squared = row[u][1] * row[u][1] + row[u][2] * row[u][2];
          if (squared > best && depth_row[u] > 0.0f && isContinuous(level.depth_m, u, v)) {
            best = squared;
            best_u = u;
            best_v = v;
          }
        }
      }
      if (best_u < 0) continue;
      const auto& pixel = level.intensity.at<cv::Vec4f>(best_v, best_u);
      const float depth = level.depth_m.at<float>(best_v, best_u);
      points.push_back(
          {level.camera.ray(best_u, best_v).cast<float>() * depth, {pixel[1], pixel[2]}, pixel[0]});
    }
  }
  return points;
}

std::vector<SurfacePoint> selectSurfacePoints(const PyramidLevel& level, int cell_px) {
  // On a plane the inverse depth is affine in the pixel: 1/z = a u + b v + c. Disparity noise is
  // even in 1/z, so this fit is the right one and needs no iteration.
  constexpr int kRadius = 4;
  constexpr int kMinCount = 55;  // of 81
  std::vector<SurfacePoint> points;
  const auto& camera = level.camera;
  const int rows = level.depth_m.rows;
  const int cols = level.depth_m.cols;
  for (int v = kRadius; v < rows - kRadius; v += cell_px) {
    for (int u = kRadius; u < cols - kRadius; u += cell_px) {
      const float centre = level.depth_m.at<float>(v, u);
      if (!(centre > 0.0f)) continue;
      Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
      Eigen::Vector3d b = Eigen::Vector3d::Zero();
      double squares = 0.0;
      int count = 0;
      for (int dv = -kRadius; dv <= kRadius; ++dv) {
        const float* row = level.depth_m.ptr<float>(v + dv);
        for (int du = -kRadius; du <= kRadius; ++du) {
          if (!(row[u + du] > 0.0f)) continue;
          const double inverse = 1.0 / static_cast<double>(row[u + du]);
          const double x = du;
          const double y = dv;
          A(0, 0) += x * x;
          A(0, 1) += x * y;
          A(0, 2) += x;
          A(1, 1) += y * y;
          A(1, 2) += y;
          b += inverse * Eigen::Vector3d(x, y, 1.0);
          squares += inverse * inverse;
          ++count;
        }
      }
      if (count < kMinCount) continue;
      A(2, 2) = count;
      A.triangularView<Eigen::StrictlyLower>() = A.transpose();
      const Eigen::LDLT<Eigen::Matrix3d> ldlt(A);
      const Eigen::Vector3d fit = ldlt.solve(b);
      const double rms = std::sqrt(std::max(0.0, (squares - fit.dot(b)) / count));
      // Edges, steps and curved things are no patch.
      const double sigma = static_cast<double>(depthSigma(centre)) / (centre * centre);
      if (rms > 3.0 * sigma + 0.001 || fit.z() <= 0.05) continue;
      const double c = fit.z() - fit.x() * u - fit.y() * v;
      Eigen::Vector3d normal(fit.x() * camera.fx_px, fit.y() * camera.fy_px,
                             c + fit.x() * camera.cx_px + fit.y() * camera.cy_px);
      const double plane_distance = 1.0 / normal.norm();
      normal *= plane_distance;
      const Eigen::Vector3d ray = camera.ray(u, v);
      const double cosine = normal.dot(ray) / ray.norm();
      if (cosine < 0.15) continue;  // seen along the surface: depth says nothing
      const double along = normal.dot(ray) * static_cast<double>(depthSigma(centre));
      // Var(slope) = sigma^2 A^-1; depth noise is smooth over a few pixels, hence the factor.
      constexpr double kNeighboursThatErrAlike = 4.0;
      const double slope = plane_distance * std::max(rms, 0.5 * sigma) * camera.fx_px;
      const double normal_variance =
          kNeighboursThatErrAlike * slope * slope * ldlt.solve(Eigen::Vector3d::UnitX()).x();
      points.push_back({(ray / fit.z()).cast<float>(), -normal.cast<float>(),
                        static_cast<float>(1.0 / (along * along + 1e-6)),
                        static_cast<float>(normal_variance)});
    }
  }
  return points;
}

}  // namespace colonnade
