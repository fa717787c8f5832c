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
/// Noise of gradients grows with that of brightness; residuals larger still are not all noise.
constexpr double kLoudest = 2.0;
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

/// What a pixel would show on the axis of the lens: brightness and its derivatives.
struct OnAxis {
  OnAxis(float brightness_seen, const Eigen::Vector2f& gradient_seen, const Eigen::Vector3f& p,
         float falloff, const Projection& projection) {
    const float x = p.x() / p.z();
    const float y = p.y() / p.z();
    const float tan_squared = x * x + y * y;
    const float scale = 1.0f / std::max(0.2f, 1.0f - falloff * tan_squared);
    brightness = scale * brightness_seen;
    gradient = scale * gradient_seen + 2.0f * falloff * scale * brightness *
                                           Eigen::Vector2f(x / projection.fx, y / projection.fy);
    by_falloff = scale * tan_squared;
  }

  float brightness;
  Eigen::Vector2f gradient;
  float by_falloff;  ///< relative
};

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
                                     double lens_falloff, double weak_direction_ratio,
                                     ResidualBuffer& buffer) {
  const Projection projection(state, current.camera);
  const auto falloff = static_cast<float>(lens_falloff);
  const auto gain = static_cast<float>(1.0 + state.gain);
  const auto bias = static_cast<float>(state.bias);
  float shared_gradient = 0.0f;
  float reference_gradient = 1e-3f;
  FeignedByGradients feigned;
  int in_view = 0;
  buffer.rows.clear();
  buffer.by_falloff.clear();
  buffer.magnitudes.clear();
  for (const PhotometricPoint& point : points) {
    const Eigen::Vector3f q = projection.inCamera(point.p_reference);
    const auto pixel = pixelOf(q, projection, current);
    if (!pixel) continue;
    ++in_view;
    const auto [u, v] = *pixel;
    const float inverse_z = 1.0f / q.z();
    // Hidden behind something nearer: another surface's brightness.
    const float seen =
        current.depth_m.at<float>(static_cast<int>(v + 0.5f), static_cast<int>(u + 0.5f));
    if (seen > 0.0f && seen < q.z() - (0.05f + 0.04f * q.z())) continue;
    const Eigen::Vector4f value = sample(current.intensity, u, v);
    const OnAxis now(value[0], value.segment<2>(1), q, falloff, projection);
    const OnAxis then(point.brightness, point.gradient, point.p_reference, falloff, projection);
    const float gu =
        0.5f * (now.gradient.x() + gain * then.gradient.x()) * projection.fx * inverse_z;
    const float gv =
        0.5f * (now.gradient.y() + gain * then.gradient.y()) * projection.fy * inverse_z;
    shared_gradient += point.gradient.dot(value.segment<2>(1));
    reference_gradient += point.gradient.squaredNorm();
    const Eigen::Vector3f j(gu, gv, -(gu * q.x() + gv * q.y()) * inverse_z);
    const Eigen::Vector3f j_turn = q.cross(j);
    ResidualRow row;
    row.r = now.brightness - gain * then.brightness - bias;
    row.J << j, j_turn, -then.brightness, -1.0f;
    // The mean of both brightnesses, as their difference is the residual.
    buffer.by_falloff.push_back(0.5f * (now.brightness + gain * then.brightness) *
                                (now.by_falloff - then.by_falloff));
    if (buffer.rows.size() % kFeignedStride == 0)
      feigned.add(q, projection.fx * inverse_z, projection.fy * inverse_z);
    buffer.rows.push_back(row);
    buffer.magnitudes.push_back(std::abs(row.r));
  }
  NormalEquations equations =
      normalEquations(buffer.rows, buffer.magnitudes, kMinBrightnessSigma, kMaxBrightnessSigma);
  constexpr double kNoise = static_cast<double>(kFeignedStride) * kGradientSigma * kGradientSigma;
  const double louder =
      std::min(equations.sigma / static_cast<double>(kMinBrightnessSigma), kLoudest);
  Matrix6 noise = louder * louder * kNoise * feigned.sum.cast<double>();
  noise += (1e-3 + 1e-6 * noise.trace()) * Matrix6::Identity();
  suppressWeakDirections(noise / (equations.sigma * equations.sigma), weak_direction_ratio,
                         equations);
  equations.in_view = in_view;
  equations.gradient_agreement = static_cast<double>(shared_gradient / reference_gradient);
  return equations;
}

FalloffEquation falloffEquation(const ResidualBuffer& buffer, double sigma) {
  const auto inverse_variance = static_cast<float>(1.0 / (sigma * sigma));
  FalloffEquation equation;
  for (std::size_t i = 0; i < buffer.by_falloff.size(); ++i) {
    const ResidualRow& row = buffer.rows[i];
    const float j = buffer.by_falloff[i];
    const float weighted = studentWeight(row.r * row.r * inverse_variance) * inverse_variance * j;
    equation.H += static_cast<double>(weighted * j);
    equation.g += static_cast<double>(weighted * row.r);
    equation.mixed += (weighted * row.J).cast<double>();
  }
  return equation;
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

float brightnessNoise(std::vector<float> residuals) {
  constexpr float kLeast = 1.0f;
  constexpr float kQuartileOfNoise = 0.3186f;  // of |noise|, in sigmas
  std::erase_if(residuals, [](float r) { return r < 0.0f; });
  if (residuals.empty()) return kLeast;
  const auto quartile = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 4);
  std::nth_element(residuals.begin(), quartile, residuals.end());
  return std::max(*quartile / kQuartileOfNoise, kLeast);
}

NormalEquations surfaceEquations(const std::vector<SurfacePoint>& points,
                                 const PyramidLevel& current, const AlignmentState& state,
                                 float gate_m, double weak_direction_ratio,
                                 ResidualBuffer& buffer) {
  const Projection projection(state, current.camera);
  const auto u_end = static_cast<float>(current.depth_m.cols);
  const auto v_end = static_cast<float>(current.depth_m.rows);
  FeignedInformation feigned;
  int in_view = 0;
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
    ++in_view;
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
  equations.in_view = in_view;
  return equations;
}

}  // namespace colonnade
