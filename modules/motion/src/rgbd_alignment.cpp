// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rgbd_alignment.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace colonnade {
namespace {

using Vector8f = Eigen::Matrix<float, 8, 1>;
using Matrix8f = Eigen::Matrix<float, 8, 8>;
using Matrix8 = Eigen::Matrix<double, 8, 8>;
using Vector8 = Eigen::Matrix<double, 8, 1>;

/// The unknowns: T_current_reference and the affine change of brightness I' = (1 + gain) I + bias.
struct State {
  Eigen::Isometry3d T_current_reference = Eigen::Isometry3d::Identity();
  double gain = 0.0;
  double bias = 0.0;
};

/// Normal equations H dx = -g of the unknowns (twist on the left, gain, bias), cost and counts.
struct System {
  Matrix8 H = Matrix8::Zero();
  Vector8 g = Vector8::Zero();
  int count = 0;
  double sigma = 0.0;       ///< used for the weights, within bounds
  double full_sigma = 0.0;  ///< as estimated
  double cost = 0.0;        ///< sum of robust costs
};

// Scales are estimated, within bounds: a wrong pose must not turn everything into noise.
constexpr float kMaxBrightnessSigma = 12.0f;
constexpr float kMaxSurfaceSigma = 3.0f;

struct Row {
  Vector8f J;
  float r;
};

/// 1.4826 times the median of |r|: the standard deviation of the bulk of the residuals.
float robustSigma(std::vector<float>& magnitudes) {
  if (magnitudes.empty()) return 0.0f;
  const auto middle = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() / 2);
  std::nth_element(magnitudes.begin(), middle, magnitudes.end());
  return 1.4826f * *middle;
}

/// Adds rows with the weights of a Student distribution of 5 degrees of freedom (Kerl et al. 2013,
/// "Robust odometry estimation for RGB-D cameras", eq. 14), single precision in short runs only.
void accumulate(const std::vector<Row>& rows, float sigma, System& system) {
  constexpr float kFreedom = 5.0f;
  constexpr std::size_t kRun = 128;
  const float inverse_variance = 1.0f / (sigma * sigma);
  for (std::size_t begin = 0; begin < rows.size(); begin += kRun) {
    Matrix8f H = Matrix8f::Zero();
    Vector8f g = Vector8f::Zero();
    float cost = 0.0f;
    const std::size_t end = std::min(begin + kRun, rows.size());
    for (std::size_t i = begin; i < end; ++i) {
      const Row& row = rows[i];
      const float squared = row.r * row.r * inverse_variance;
      const float weight = (kFreedom + 1.0f) / (kFreedom + squared) * inverse_variance;
      const Vector8f weighted = weight * row.J;
      H.noalias() += weighted * row.J.transpose();
      g.noalias() += weighted * row.r;
      cost += std::log1p(squared / kFreedom);
    }
    system.H += H.cast<double>();
    system.g += g.cast<double>();
    system.cost += 0.5 * (static_cast<double>(kFreedom) + 1.0) * static_cast<double>(cost);
  }
  system.count = static_cast<int>(rows.size());
  system.sigma = static_cast<double>(sigma);
}

class Problem {
 public:
  Problem(const Reference& reference, const RgbdPyramid& current, const AlignmentOptions& options)
      : reference_(reference), current_(current), options_(options) {}

  System photometric(const State& state, std::size_t level, int stride) {
    System system;
    const auto& points = reference_.photometric[level];
    const PyramidLevel& image = current_.levels[level];
    const Eigen::Matrix3f R = state.T_current_reference.linear().cast<float>();
    const Eigen::Vector3f t = state.T_current_reference.translation().cast<float>();
    const auto fx = static_cast<float>(image.camera.fx_px);
    const auto fy = static_cast<float>(image.camera.fy_px);
    const auto cx = static_cast<float>(image.camera.cx_px);
    const auto cy = static_cast<float>(image.camera.cy_px);
    const float u_max = static_cast<float>(image.intensity.cols) - 2.001f;
    const float v_max = static_cast<float>(image.intensity.rows) - 2.001f;
    const auto gain = static_cast<float>(1.0 + state.gain);
    const auto bias = static_cast<float>(state.bias);
    rows_.clear();
    magnitudes_.clear();
    for (std::size_t i = 0; i < points.size(); i += static_cast<std::size_t>(stride)) {
      const PhotometricPoint& point = points[i];
      const Eigen::Vector3f q = R * point.p_reference + t;
      if (q.z() < 0.2f) continue;
      const float inverse_z = 1.0f / q.z();
      const float u = fx * q.x() * inverse_z + cx;
      const float v = fy * q.y() * inverse_z + cy;
      if (!(u >= 1.0f && v >= 1.0f && u < u_max && v < v_max)) continue;
      const int iu = static_cast<int>(u);
      const int iv = static_cast<int>(v);
      // Hidden behind something nearer: another surface's brightness.
      const float seen =
          image.depth_m.at<float>(static_cast<int>(v + 0.5f), static_cast<int>(u + 0.5f));
      if (seen > 0.0f && seen < q.z() - (0.05f + 0.04f * q.z())) continue;
      const float a = u - static_cast<float>(iu);
      const float b = v - static_cast<float>(iv);
      const auto* upper = image.intensity.ptr<float>(iv) + 4 * iu;
      const auto* lower = image.intensity.ptr<float>(iv + 1) + 4 * iu;
      using Pixel = Eigen::Map<const Eigen::Vector4f>;
      const Eigen::Vector4f value =
          (1.0f - b) * ((1.0f - a) * Pixel(upper) + a * Pixel(upper + 4)) +
          b * ((1.0f - a) * Pixel(lower) + a * Pixel(lower + 4));
      Row row;
      row.r = value[0] - gain * point.brightness - bias;
      const float gu = 0.5f * (value[1] + gain * point.gradient.x()) * fx * inverse_z;
      const float gv = 0.5f * (value[2] + gain * point.gradient.y()) * fy * inverse_z;
      const Eigen::Vector3f j(gu, gv, -(gu * q.x() + gv * q.y()) * inverse_z);
      const Eigen::Vector3f jr = q.cross(j);
      row.J << j, jr, -point.brightness, -1.0f;
      rows_.push_back(row);
      magnitudes_.push_back(std::abs(row.r));
    }
    const float sigma = robustSigma(magnitudes_);
    accumulate(rows_, std::clamp(sigma, 1.5f, kMaxBrightnessSigma), system);
    system.full_sigma = std::max(static_cast<double>(sigma), system.sigma);
    return system;
  }

  System surfaces(const State& state, float gate_m, int stride) {
    System system;
    const PyramidLevel& image = current_.levels.front();
    const Eigen::Matrix3f R = state.T_current_reference.linear().cast<float>();
    const Eigen::Vector3f t = state.T_current_reference.translation().cast<float>();
    const auto fx = static_cast<float>(image.camera.fx_px);
    const auto fy = static_cast<float>(image.camera.fy_px);
    const auto cx = static_cast<float>(image.camera.cx_px);
    const auto cy = static_cast<float>(image.camera.cy_px);
    float feigned_weight = 1e-3f;
    Eigen::Vector3f feigned_first = Eigen::Vector3f::Zero();
    Eigen::Matrix3f feigned_second = 1e-3f * Eigen::Matrix3f::Identity();
    rows_.clear();
    magnitudes_.clear();
    for (std::size_t i = 0; i < reference_.surfaces.size(); i += static_cast<std::size_t>(stride)) {
      const SurfacePoint& point = reference_.surfaces[i];
      const Eigen::Vector3f q = R * point.p_reference + t;
      if (q.z() < 0.2f) continue;
      const float u = fx * q.x() / q.z() + cx + 0.5f;
      const float v = fy * q.y() / q.z() + cy + 0.5f;
      if (!(u >= 0.0f && v >= 0.0f)) continue;
      const int iu = static_cast<int>(u);
      const int iv = static_cast<int>(v);
      if (iu >= image.depth_m.cols || iv >= image.depth_m.rows) continue;
      const float depth = image.depth_m.at<float>(iv, iu);
      if (depth <= 0.0f) continue;
      const Eigen::Vector3f seen((static_cast<float>(iu) - cx) / fx * depth,
                                 (static_cast<float>(iv) - cy) / fy * depth, depth);
      const Eigen::Vector3f n = R * point.normal;
      const float r = n.dot(q - seen);
      const float weight = std::sqrt(point.inverse_variance);
      if (std::abs(r) > std::max(gate_m, 4.0f / weight)) continue;
      Row row;
      row.r = r * weight;
      const Eigen::Vector3f nr = q.cross(n);
      const float noise = point.inverse_variance * point.normal_variance;
      feigned_weight += noise;
      feigned_first += noise * q;
      feigned_second += noise * (q.squaredNorm() * Eigen::Matrix3f::Identity() - q * q.transpose());
      row.J << weight * n, weight * nr, 0.0f, 0.0f;
      rows_.push_back(row);
      magnitudes_.push_back(std::abs(row.r));
    }
    // Sum of w var(n) J^T J with J = (I, -[q]x): what random normals would add to H.
    Matrix6 feigned;
    feigned.topLeftCorner<3, 3>() =
        static_cast<double>(feigned_weight) * Eigen::Matrix3d::Identity();
    feigned.topRightCorner<3, 3>() = -skew(feigned_first.cast<double>());
    feigned.bottomLeftCorner<3, 3>() = skew(feigned_first.cast<double>());
    feigned.bottomRightCorner<3, 3>() = feigned_second.cast<double>();
    const float sigma = robustSigma(magnitudes_);
    accumulate(rows_, std::clamp(sigma, 1.0f, kMaxSurfaceSigma), system);
    system.full_sigma = std::max(static_cast<double>(sigma), system.sigma);
    suppressWeakDirections(feigned / (system.sigma * system.sigma), system);
    return system;
  }

  /// Both in information form.
  System combined(const State& state, std::size_t level, int stride, float gate_m,
                  System* photometric_part, System* surface_part) {
    System sum;
    // A broad prior on the brightness change keeps it out of the null space.
    sum.H(6, 6) += 1.0 / (0.1 * 0.1);
    sum.g(6) += state.gain / (0.1 * 0.1);
    sum.H(7, 7) += 1.0 / (20.0 * 20.0);
    sum.g(7) += state.bias / (20.0 * 20.0);
    if (options_.use_photometric) {
      add(photometric(state, level, stride), options_.photometric_correlation, sum,
          photometric_part);
    }
    if (options_.use_surfaces) {
      add(surfaces(state, gate_m, stride), options_.surface_correlation, sum, surface_part);
    }
    return sum;
  }

  /// The change of brightness alone, at a fixed pose.
  void fitBrightness(State& state) {
    for (int i = 0; i < 4; ++i) {
      System system = combined(state, 0, 1, 0.07f, nullptr, nullptr);
      const Eigen::Vector2d dx =
          -system.H.bottomRightCorner<2, 2>().ldlt().solve(system.g.tail<2>());
      state.gain = std::clamp(state.gain + dx(0), -0.5, 0.5);
      state.bias = std::clamp(state.bias + dx(1), -80.0, 80.0);
    }
  }

  const Reference& reference() const { return reference_; }
  const AlignmentOptions& options() const { return options_; }

 private:
  static void add(const System& part, double correlation, System& sum, System* copy) {
    sum.H += part.H / correlation;
    sum.g += part.g / correlation;
    sum.cost += part.cost / correlation;
    sum.count += part.count;
    if (copy) *copy = part;
  }

  /// Keeps only what the surfaces really constrain: along a corridor the normal matrix holds little
  /// but the noise of the normals (`feigned`), and a point-to-plane fit slides there while its
  /// residual is fine. Directions are the generalised eigenvectors of both matrices.
  void suppressWeakDirections(const Matrix6& feigned, System& system) const {
    if (system.count == 0) return;
    const Matrix6 H = system.H.topLeftCorner<6, 6>();
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6> eigen(H, feigned);
    if (eigen.info() != Eigen::Success || !eigen.eigenvalues().allFinite()) {
      system = System{};
      return;
    }
    Vector6 keep;
    for (int i = 0; i < 6; ++i) {
      const double ratio = std::max(0.0, eigen.eigenvalues()(i)) / options_.weak_direction_ratio;
      keep(i) = std::pow(ratio, 4) / (1.0 + std::pow(ratio, 4));
    }
    // V^T feigned V = I, so (feigned V)^T is the inverse of V.
    const Matrix6 W = feigned * eigen.eigenvectors();
    system.H.topLeftCorner<6, 6>() =
        W * keep.cwiseProduct(eigen.eigenvalues()).asDiagonal() * W.transpose();
    system.g.head<6>() =
        W * keep.cwiseProduct(eigen.eigenvectors().transpose() * system.g.head<6>());
  }

  const Reference& reference_;
  const RgbdPyramid& current_;
  const AlignmentOptions& options_;
  std::vector<Row> rows_;
  std::vector<float> magnitudes_;
};

/// One Gauss-Newton step; returns how far it moved (metres plus radians), or infinity.
double step(const System& system, State& state) {
  Matrix8 damped = system.H;
  // Directions nobody sees stay where the guess put them: 1 m, 1 rad.
  damped.diagonal().head<6>().array() += 1.0;
  const Eigen::LDLT<Matrix8> ldlt(damped);
  const Vector8 dx = -ldlt.solve(system.g);
  if (ldlt.info() != Eigen::Success || !dx.allFinite()) {
    return std::numeric_limits<double>::infinity();
  }
  state.T_current_reference = expSe3(dx.head<6>()) * state.T_current_reference;
  orthonormalise(state.T_current_reference);
  state.gain = std::clamp(state.gain + dx(6), -0.5, 0.5);
  state.bias = std::clamp(state.bias + dx(7), -80.0, 80.0);
  return dx.head<3>().norm() + dx.segment<3>(3).norm();
}

/// Mean cost of one residual; residuals that fell out of view cost like outliers.
double meanCost(const System& part, std::size_t asked) {
  constexpr double kLost = 4.0;
  if (asked == 0) return 0.0;
  const double lost = static_cast<double>(asked) - part.count;
  // The scale is estimated: a wrong pose must not look good because its scale is large.
  const double scale = part.count * std::log(std::max(part.sigma, 1e-3));
  return (part.cost + scale + kLost * lost) / static_cast<double>(asked);
}

double squared(double value) { return value * value; }

/// The normal matrices, residuals and covariance at a pose.
Alignment evaluate(Problem& problem, const State& state) {
  Alignment result;
  System photometric;
  System surfaces;
  System sum = problem.combined(state, 0, 1, 0.07f, &photometric, &surfaces);
  result.T_reference_current = state.T_current_reference.inverse();
  // The weights used bounded scales; the covariance knows the residuals as they are.
  if (photometric.count > 0) {
    sum.H += photometric.H / problem.options().photometric_correlation *
             (squared(photometric.sigma / photometric.full_sigma) - 1.0);
  }
  if (surfaces.count > 0) {
    sum.H += surfaces.H / problem.options().surface_correlation *
             (squared(surfaces.sigma / surfaces.full_sigma) - 1.0);
  }
  sum.H.diagonal().head<6>().array() += 1.0;
  result.covariance = sum.H.inverse().topLeftCorner<6, 6>();
  result.photometric_count = photometric.count;
  result.surface_count = surfaces.count;
  const auto share = [](int count, std::size_t of) {
    return of == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(of);
  };
  result.photometric_share = share(photometric.count, problem.reference().photometric[0].size());
  result.surface_share = share(surfaces.count, problem.reference().surfaces.size());
  result.photometric_sigma = photometric.full_sigma;
  result.surface_sigma = surfaces.full_sigma;
  result.converged = result.covariance.allFinite();
  return result;
}

}  // namespace

Reference makeReference(RgbdPyramid pyramid) {
  Reference reference;
  for (std::size_t level = 0; level < pyramid.levels.size(); ++level) {
    const int cell_px = level == 0 ? 4 : level == 1 ? 3 : 2;
    reference.photometric.push_back(selectPhotometricPoints(pyramid.levels[level], cell_px, 3.0f));
  }
  if (!pyramid.levels.empty()) reference.surfaces = selectSurfacePoints(pyramid.levels.front(), 6);
  reference.pyramid = std::move(pyramid);
  return reference;
}

Alignment align(const Reference& reference, const RgbdPyramid& current,
                const std::vector<Eigen::Isometry3d>& guesses, const AlignmentOptions& options) {
  Alignment result;
  if (current.levels.empty() || reference.photometric.size() != current.levels.size())
    return result;
  Problem problem(reference, current, options);

  const std::size_t coarsest = current.levels.size() - 1;
  State best;
  double best_cost = std::numeric_limits<double>::infinity();
  for (const Eigen::Isometry3d& guess : guesses) {
    State state{guess.inverse(), 0.0, 0.0};
    for (int i = 0; i < 8; ++i) {
      const float gate_m = i < 4 ? 0.3f : 0.15f;
      if (step(problem.combined(state, coarsest, 1, gate_m, nullptr, nullptr), state) < 2e-3) break;
    }
    System photometric;
    System surfaces;
    problem.combined(state, coarsest, 1, 0.15f, &photometric, &surfaces);
    double cost = 0.0;
    if (options.use_photometric) {
      cost += meanCost(photometric, reference.photometric[coarsest].size());
    }
    if (options.use_surfaces) cost += meanCost(surfaces, reference.surfaces.size());
    if (cost < best_cost) {
      best_cost = cost;
      best = state;
    }
  }

  for (std::size_t level = coarsest; level-- > 0;) {
    const int iterations = level == 0 ? 6 : 8;
    const float gate_m = level == 0 ? 0.07f : 0.1f;
    const double enough = level == 0 ? 1e-4 : 5e-4;
    for (int i = 0; i < iterations; ++i) {
      const double moved = step(problem.combined(best, level, 1, gate_m, nullptr, nullptr), best);
      if (!std::isfinite(moved)) return result;
      if (moved < enough) break;
    }
  }
  return evaluate(problem, best);
}

Alignment evaluateAt(const Reference& reference, const RgbdPyramid& current,
                     const Eigen::Isometry3d& T_reference_current,
                     const AlignmentOptions& options) {
  if (current.levels.empty() || reference.photometric.size() != current.levels.size()) return {};
  Problem problem(reference, current, options);
  State state{T_reference_current.inverse(), 0.0, 0.0};
  problem.fitBrightness(state);
  return evaluate(problem, state);
}

}  // namespace colonnade
