// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "residuals.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace colonnade {
namespace {

constexpr float kMinBrightnessSigma = 1.5f;
constexpr float kMaxBrightnessSigma = 12.0f;
/// Of a brightness gradient, mean of two images' central differences, where a difference of
/// brightness has kMinBrightnessSigma: 1 / sqrt(8) of it; levels a pixel.
constexpr double kGradientSigma = 0.53;
constexpr std::size_t kFeignedStride = 4;  ///< one point of so many stands for all
constexpr float kMinSurfaceSigma = 1.0f;   ///< in units of the sensor's noise model
constexpr float kMaxSurfaceSigma = 3.0f;

/// Projection of the reference's points into the current camera.
struct Projection {
  Projection(const AlignmentState& state, const PinholeCamera& camera)
      : R(state.T_current_reference.linear().cast<float>()),
        t(state.T_current_reference.translation().cast<float>()),
        fx(static_cast<float>(camera.fx_px)),
        fy(static_cast<float>(camera.fy_px)),
        cx(static_cast<float>(camera.cx_px)),
        cy(static_cast<float>(camera.cy_px)) {}
  Eigen::Vector3f inCamera(const Eigen::Vector3f& p_reference) const { return R * p_reference + t; }

  Eigen::Matrix3f R;
  Eigen::Vector3f t;
  float fx, fy, cx, cy;
};

/// Where a point is seen, if it is within the picture, with the neighbours bilinear values need.
struct Pixel {
  float u, v;
};
std::optional<Pixel> pixelOf(const Eigen::Vector3f& q, const Projection& projection,
                             const PyramidLevel& level) {
  if (!(q.z() > 0.2f)) return std::nullopt;
  const float u = projection.fx * q.x() / q.z() + projection.cx;
  const float v = projection.fy * q.y() / q.z() + projection.cy;
  const float u_max = static_cast<float>(level.intensity.cols) - 2.001f;
  const float v_max = static_cast<float>(level.intensity.rows) - 2.001f;
  if (!(u >= 1.0f && v >= 1.0f && u < u_max && v < v_max)) return std::nullopt;
  return Pixel{u, v};
}

/// The four channels of a pixel, bilinear.
Eigen::Vector4f sample(const cv::Mat& intensity, float u, float v) {
  using Channels = Eigen::Map<const Eigen::Vector4f>;
  const int iu = static_cast<int>(u);
  const int iv = static_cast<int>(v);
  const float a = u - static_cast<float>(iu);
  const float b = v - static_cast<float>(iv);
  const auto* upper = intensity.ptr<float>(iv) + 4 * iu;
  const auto* lower = intensity.ptr<float>(iv + 1) + 4 * iu;
  return (1.0f - b) * ((1.0f - a) * Channels(upper) + a * Channels(upper + 4)) +
         b * ((1.0f - a) * Channels(lower) + a * Channels(lower + 4));
}

/// Sum of w var(n) J^T J with J = (I, -[q]x): what random normals would add to H.
struct FeignedInformation {
  float weight = 1e-3f;
  Eigen::Vector3f first = Eigen::Vector3f::Zero();
  Eigen::Matrix3f second = 1e-3f * Eigen::Matrix3f::Identity();

  void add(float noise, const Eigen::Vector3f& q) {
    weight += noise;
    first += noise * q;
    second += noise * (q.squaredNorm() * Eigen::Matrix3f::Identity() - q * q.transpose());
  }
  Matrix6 matrix() const {
    Matrix6 sum;
    sum.topLeftCorner<3, 3>() = static_cast<double>(weight) * Eigen::Matrix3d::Identity();
    sum.topRightCorner<3, 3>() = -skew(first.cast<double>());
    sum.bottomLeftCorner<3, 3>() = skew(first.cast<double>());
    sum.bottomRightCorner<3, 3>() = second.cast<double>();
    return sum;
  }
};

/// Sum of J_u^T J_u + J_v^T J_v, the rows of points with a gradient of one level a pixel across and
/// one down: what random gradients of that size would add to H.
struct FeignedByGradients {
  Eigen::Matrix<float, 6, 6> sum = Eigen::Matrix<float, 6, 6>::Zero();

  void add(const Eigen::Vector3f& q, float fu, float fv) {
    Eigen::Matrix<float, 6, 2> J;
    const Eigen::Vector3f across(fu, 0.0f, -fu * q.x() / q.z());
    const Eigen::Vector3f down(0.0f, fv, -fv * q.y() / q.z());
    J << across, down, q.cross(across), q.cross(down);
    sum.noalias() += J * J.transpose();
  }
};

}  // namespace

NormalEquations photometricEquations(const std::vector<PhotometricPoint>& points,
                                     const PyramidLevel& current, const AlignmentState& state,
                                     double weak_direction_ratio, ResidualBuffer& buffer) {
  const Projection projection(state, current.camera);
  const auto gain = static_cast<float>(1.0 + state.gain);
  const auto bias = static_cast<float>(state.bias);
  float shared_gradient = 0.0f;
  float reference_gradient = 1e-3f;
  FeignedByGradients feigned;
  buffer.rows.clear();
  buffer.magnitudes.clear();
  for (const PhotometricPoint& point : points) {
    const Eigen::Vector3f q = projection.inCamera(point.p_reference);
    const auto pixel = pixelOf(q, projection, current);
    if (!pixel) continue;
    const auto [u, v] = *pixel;
    const float inverse_z = 1.0f / q.z();
    // Hidden behind something nearer: another surface's brightness.
    const float seen =
        current.depth_m.at<float>(static_cast<int>(v + 0.5f), static_cast<int>(u + 0.5f));
    if (seen > 0.0f && seen < q.z() - (0.05f + 0.04f * q.z())) continue;
    const Eigen::Vector4f value = sample(current.intensity, u, v);
    const float gu = 0.5f * (value[1] + gain * point.gradient.x()) * projection.fx * inverse_z;
    const float gv = 0.5f * (value[2] + gain * point.gradient.y()) * projection.fy * inverse_z;
    shared_gradient += point.gradient.dot(value.segment<2>(1));
    reference_gradient += point.gradient.squaredNorm();
    const Eigen::Vector3f j(gu, gv, -(gu * q.x() + gv * q.y()) * inverse_z);
    const Eigen::Vector3f j_turn = q.cross(j);
    ResidualRow row;
    row.r = value[0] - gain * point.brightness - bias;
    row.J << j, j_turn, -point.brightness, -1.0f;
    if (buffer.rows.size() % kFeignedStride == 0)
      feigned.add(q, projection.fx * inverse_z, projection.fy * inverse_z);
    buffer.rows.push_back(row);
    buffer.magnitudes.push_back(std::abs(row.r));
  }
  NormalEquations equations =
      normalEquations(buffer.rows, buffer.magnitudes, kMinBrightnessSigma, kMaxBrightnessSigma);
  constexpr double kNoise = static_cast<double>(kFeignedStride) * kGradientSigma * kGradientSigma;
  Matrix6 noise = kNoise * feigned.sum.cast<double>();
  noise += (1e-3 + 1e-6 * noise.trace()) * Matrix6::Identity();
  suppressWeakDirections(noise / (equations.sigma * equations.sigma), weak_direction_ratio,
                         equations);
  equations.gradient_agreement = static_cast<double>(shared_gradient / reference_gradient);
  return equations;
}

std::vector<float> brightnessResiduals(const std::vector<PhotometricPoint>& points,
                                       const PyramidLevel& current, const AlignmentState& state) {
  const Projection projection(state, current.camera);
  const auto gain = static_cast<float>(1.0 + state.gain);
  const auto bias = static_cast<float>(state.bias);
  std::vector<float> residuals;
  residuals.reserve(points.size());
  for (const PhotometricPoint& point : points) {
    const auto pixel = pixelOf(projection.inCamera(point.p_reference), projection, current);
    residuals.push_back(pixel ? std::abs(sample(current.intensity, pixel->u, pixel->v)[0] -
                                         gain * point.brightness - bias)
                              : -1.0f);
  }
  return residuals;
}

NormalEquations surfaceEquations(const std::vector<SurfacePoint>& points,
                                 const PyramidLevel& current, const AlignmentState& state,
                                 float gate_m, double weak_direction_ratio,
                                 ResidualBuffer& buffer) {
  const Projection projection(state, current.camera);
  const auto u_end = static_cast<float>(current.depth_m.cols);
  const auto v_end = static_cast<float>(current.depth_m.rows);
  FeignedInformation feigned;
  buffer.rows.clear();
  buffer.magnitudes.clear();
  for (const SurfacePoint& point : points) {
    const Eigen::Vector3f q = projection.inCamera(point.p_reference);
    if (!(q.z() > 0.2f)) continue;
    const float u = projection.fx * q.x() / q.z() + projection.cx + 0.5f;
    const float v = projection.fy * q.y() / q.z() + projection.cy + 0.5f;
    if (!(u >= 0.0f && v >= 0.0f && u < u_end && v < v_end)) continue;
    const int iu = static_cast<int>(u);
    const int iv = static_cast<int>(v);
    const float depth = current.depth_m.at<float>(iv, iu);
    if (!(depth > 0.0f)) continue;
    const Eigen::Vector3f seen((static_cast<float>(iu) - projection.cx) / projection.fx * depth,
                               (static_cast<float>(iv) - projection.cy) / projection.fy * depth,
                               depth);
    const Eigen::Vector3f n = projection.R * point.normal;
    const float r = n.dot(q - seen);
    const float inverse_sigma = std::sqrt(point.inverse_variance);
    if (!(std::abs(r) < std::max(gate_m, 4.0f / inverse_sigma))) continue;
    feigned.add(point.inverse_variance * point.normal_variance, q);
    const Eigen::Vector3f j_turn = q.cross(n);
    ResidualRow row;
    row.r = inverse_sigma * r;
    row.J << inverse_sigma * n, inverse_sigma * j_turn, 0.0f, 0.0f;
    buffer.rows.push_back(row);
    buffer.magnitudes.push_back(std::abs(row.r));
  }
  NormalEquations equations =
      normalEquations(buffer.rows, buffer.magnitudes, kMinSurfaceSigma, kMaxSurfaceSigma);
  suppressWeakDirections(feigned.matrix() / (equations.sigma * equations.sigma),
                         weak_direction_ratio, equations);
  return equations;
}

}  // namespace colonnade
