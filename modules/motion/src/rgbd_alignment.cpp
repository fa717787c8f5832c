// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rgbd_alignment.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "residuals.hpp"

namespace colonnade {
namespace {

constexpr float kFinestGate_m = 0.07f;
constexpr double kGainSigma = 0.1;
constexpr double kBiasSigma = 20.0;  ///< brightness levels

double squared(double value) { return value * value; }

struct Parts {
  NormalEquations photometric;
  NormalEquations surfaces;
};

class Problem {
 public:
  Problem(const Reference& reference, const RgbdPyramid& current, const MotionPrior& prior,
          const AlignmentOptions& options)
      : reference_(reference), current_(current), prior_(prior), options_(options) {}

  Parts parts(const AlignmentState& state, std::size_t level, float gate_m) {
    Parts parts;
    if (options_.use_photometric) {
      parts.photometric =
          photometricEquations(reference_.photometric[level], current_.levels[level], state,
                               options_.weak_gradient_ratio, buffer_);
    }
    if (options_.use_surfaces) {
      parts.surfaces = surfaceEquations(reference_.surfaces, current_.levels.front(), state, gate_m,
                                        options_.weak_direction_ratio, buffer_);
    }
    return parts;
  }

  /// All in information form. `as_estimated`: with the scales that the residuals really have,
  /// instead of the bounded ones that keep the iteration going.
  NormalEquations sum(const Parts& parts, const AlignmentState& state, bool as_estimated) const {
    NormalEquations sum;
    add(parts.photometric, options_.photometric_correlation, as_estimated, sum);
    add(parts.surfaces, options_.surface_correlation, as_estimated, sum);
    sum.H(6, 6) += 1.0 / squared(kGainSigma);
    sum.g(6) += state.gain / squared(kGainSigma);
    sum.H(7, 7) += 1.0 / squared(kBiasSigma);
    sum.g(7) += state.bias / squared(kBiasSigma);
    // T_cr = exp(twist) T_cr(prior), and exp(twist) on this side is exp(-e) of the prior's error.
    const Vector6 twist = logSe3(state.T_current_reference * prior_.T_reference_current);
    sum.H.topLeftCorner<6, 6>() += prior_.information;
    sum.g.head<6>() += prior_.information * twist;
    return sum;
  }

  NormalEquations combined(const AlignmentState& state, std::size_t level, float gate_m) {
    return sum(parts(state, level, gate_m), state, false);
  }

  /// What a start is worth at a level: mean cost of a residual, where points that fell out of view
  /// cost like outliers and the scale counts, so that a bad start does not win by a large one.
  double cost(const AlignmentState& state, std::size_t level, float gate_m) {
    const Parts both = parts(state, level, gate_m);
    return meanCost(both.photometric, reference_.photometric[level].size()) +
           meanCost(both.surfaces, reference_.surfaces.size());
  }

  /// The change of brightness alone, at a fixed pose.
  void fitBrightness(AlignmentState& state) {
    for (int i = 0; i < 4; ++i) {
      const NormalEquations equations = combined(state, 0, kFinestGate_m);
      const Eigen::Vector2d dx =
          -equations.H.bottomRightCorner<2, 2>().ldlt().solve(equations.g.tail<2>());
      state.gain = std::clamp(state.gain + dx(0), -0.5, 0.5);
      state.bias = std::clamp(state.bias + dx(1), -80.0, 80.0);
    }
  }

  Alignment result(const AlignmentState& state) {
    const Parts both = parts(state, 0, kFinestGate_m);
    const NormalEquations equations = sum(both, state, true);
    Alignment alignment;
    alignment.T_reference_current = state.T_current_reference.inverse();
    alignment.covariance = equations.H.inverse().topLeftCorner<6, 6>();
    alignment.gradient_agreement = both.photometric.gradient_agreement;
    alignment.photometric_count = both.photometric.count;
    alignment.surface_count = both.surfaces.count;
    const auto share = [](int count, std::size_t of) {
      return of == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(of);
    };
    alignment.photometric_share =
        share(both.photometric.count, reference_.photometric.front().size());
    alignment.surface_share = share(both.surfaces.count, reference_.surfaces.size());
    alignment.converged = alignment.covariance.allFinite();
    return alignment;
  }

 private:
  static void add(const NormalEquations& part, double correlation, bool as_estimated,
                  NormalEquations& sum) {
    if (part.count == 0) return;
    const double scale = as_estimated ? squared(part.sigma / part.full_sigma) : 1.0;
    sum.H += scale / correlation * part.H;
    sum.g += scale / correlation * part.g;
    sum.count += part.count;
  }

  static double meanCost(const NormalEquations& part, std::size_t asked) {
    constexpr double kLost = 4.0;
    if (asked == 0) return 0.0;
    const double lost = static_cast<double>(asked) - part.count;
    const double scale = part.count * std::log(std::max(part.sigma, 1e-3));
    return (part.cost + scale + kLost * lost) / static_cast<double>(asked);
  }

  const Reference& reference_;
  const RgbdPyramid& current_;
  const MotionPrior& prior_;
  const AlignmentOptions& options_;
  ResidualBuffer buffer_;
};

/// One Gauss-Newton step; returns how far it moved (metres plus radians), or infinity.
double step(const NormalEquations& equations, AlignmentState& state) {
  const Eigen::LDLT<Matrix8> ldlt(equations.H);
  const Vector8 dx = -ldlt.solve(equations.g);
  if (ldlt.info() != Eigen::Success || !dx.allFinite()) {
    return std::numeric_limits<double>::infinity();
  }
  state.T_current_reference = expSe3(dx.head<6>()) * state.T_current_reference;
  orthonormalise(state.T_current_reference);
  state.gain = std::clamp(state.gain + dx(6), -0.5, 0.5);
  state.bias = std::clamp(state.bias + dx(7), -80.0, 80.0);
  return dx.head<3>().norm() + dx.segment<3>(3).norm();
}

bool areAlike(const Reference& reference, const RgbdPyramid& current) {
  return !current.levels.empty() && reference.photometric.size() == current.levels.size();
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

Alignment align(const Reference& reference, const RgbdPyramid& current, const MotionPrior& prior,
                const std::vector<Eigen::Isometry3d>& other_guesses,
                const AlignmentOptions& options) {
  if (!areAlike(reference, current)) return {};
  Problem problem(reference, current, prior, options);
  std::vector<Eigen::Isometry3d> guesses = {prior.T_reference_current};
  guesses.insert(guesses.end(), other_guesses.begin(), other_guesses.end());

  const std::size_t coarsest = current.levels.size() - 1;
  AlignmentState best;
  double best_cost = std::numeric_limits<double>::infinity();
  for (const Eigen::Isometry3d& guess : guesses) {
    AlignmentState state{guess.inverse(), 0.0, 0.0};
    for (int i = 0; i < 8; ++i) {
      const float gate_m = i < 4 ? 0.3f : 0.15f;
      if (step(problem.combined(state, coarsest, gate_m), state) < 2e-3) break;
    }
    const double cost = problem.cost(state, coarsest, 0.15f);
    if (cost < best_cost) {
      best_cost = cost;
      best = state;
    }
  }

  for (std::size_t level = coarsest; level-- > 0;) {
    const int iterations = level == 0 ? 6 : 8;
    const float gate_m = level == 0 ? kFinestGate_m : 0.1f;
    const double enough = level == 0 ? 1e-4 : 5e-4;
    for (int i = 0; i < iterations; ++i) {
      const double moved = step(problem.combined(best, level, gate_m), best);
      if (!std::isfinite(moved)) return {};
      if (moved < enough) break;
    }
  }
  return problem.result(best);
}

Alignment evaluateAt(const Reference& reference, const RgbdPyramid& current,
                     const MotionPrior& prior, const Eigen::Isometry3d& T_reference_current,
                     const AlignmentOptions& options) {
  if (!areAlike(reference, current)) return {};
  Problem problem(reference, current, prior, options);
  AlignmentState state{T_reference_current.inverse(), 0.0, 0.0};
  problem.fitBrightness(state);
  return problem.result(state);
}

}  // namespace colonnade
