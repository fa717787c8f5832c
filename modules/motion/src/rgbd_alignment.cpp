// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rgbd_alignment.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <compare>
#include <cstddef>
#include <limits>
#include <optional>

#include "residuals.hpp"

namespace colonnade {
namespace {

constexpr float kFinestGate_m = 0.07f;
constexpr double kGainSigma = 0.1;
constexpr double kBiasSigma = 20.0;  ///< brightness levels
/// The coarsest level is no surer of the end of a way, at the resolution of the finest.
constexpr double kSameWay_px = 2.0;
/// A last step, metres plus radians. Where one at the finest level is longer than `kNear` the prior
/// was not near enough to start there.
constexpr double kSettled = 2e-4;
constexpr double kNear = 1e-3;

double squared(double value) { return value * value; }

struct Parts {
  NormalEquations photometric;
  NormalEquations surfaces;
};

/// How well a pose fits at the finest level; less is better.
struct Fit {
  /// Where the views hardly overlap, something alike is soon found.
  bool compares_little = true;
  /// Minus the logarithm of the posterior. Points out of view say nothing: in a turn some must
  /// leave it, and what loses fewer of them is no better for that.
  double cost = std::numeric_limits<double>::infinity();

  auto operator<=>(const Fit&) const = default;
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
                               options_.lens_falloff, options_.weak_direction_ratio, buffer_);
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

  Fit fit(const AlignmentState& state) {
    const Parts both = parts(state, 0, kFinestGate_m);
    const std::size_t textured = reference_.photometric.front().size();
    const double compared = options_.use_photometric && textured >= kPointsToRelyOn
                                ? share(both.photometric, textured)
                                : share(both.surfaces, reference_.surfaces.size());
    const auto sum = [](const NormalEquations& part, std::size_t of, double correlation) {
      return static_cast<double>(of) / correlation * meanCost(part);
    };
    const Vector6 twist = logSe3(state.T_current_reference * prior_.T_reference_current);
    const double cost =
        sum(both.photometric, reference_.photometric.front().size(),
            options_.photometric_correlation) +
        sum(both.surfaces, reference_.surfaces.size(), options_.surface_correlation) +
        0.5 * twist.dot(prior_.information * twist);
    return {compared < options_.min_share, cost};
  }

  /// Root mean square distance of the reference's surfaces in the picture, as either state has it.
  double pixelsApart(const AlignmentState& a, const AlignmentState& b) const {
    constexpr std::size_t kStride = 16;
    const double focal_px = current_.levels.front().camera.fx_px;
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < reference_.surfaces.size(); i += kStride) {
      const Eigen::Vector3d p = reference_.surfaces[i].p_reference.cast<double>();
      const Eigen::Vector3d q_a = a.T_current_reference * p;
      const Eigen::Vector3d q_b = b.T_current_reference * p;
      if (!(q_a.z() > 0.2 && q_b.z() > 0.2)) continue;
      sum += squared(focal_px) * (q_a / q_a.z() - q_b / q_b.z()).squaredNorm();
      ++count;
    }
    return count == 0 ? std::numeric_limits<double>::infinity() : std::sqrt(sum / count);
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
    alignment.photometric_share = share(both.photometric, reference_.photometric.front().size());
    alignment.surface_share = share(both.surfaces, reference_.surfaces.size());
    alignment.converged = alignment.covariance.allFinite();
    if (both.photometric.count > 0) addFalloff(state, equations, alignment);
    return alignment;
  }

 private:
  static double share(const NormalEquations& part, std::size_t of) {
    return of == 0 ? 0.0 : static_cast<double>(part.count) / static_cast<double>(of);
  }

  /// The Schur complement of all other unknowns.
  void addFalloff(const AlignmentState& state, const NormalEquations& others,
                  Alignment& alignment) {
    const NormalEquations photometric =
        photometricEquations(reference_.photometric.front(), current_.levels.front(), state,
                             options_.lens_falloff, 0.0, buffer_);
    const FalloffEquation falloff = falloffEquation(buffer_, photometric.full_sigma);
    const double correlation = options_.photometric_correlation;
    const Vector8 solved = others.H.ldlt().solve(falloff.mixed) / correlation;
    const double information = (falloff.H - falloff.mixed.dot(solved)) / correlation;
    const double gradient = falloff.g / correlation - solved.dot(others.g);
    if (!(information > 0.0) || !std::isfinite(gradient)) return;
    alignment.falloff_information = information;
    alignment.falloff_step = -gradient / information;
  }

  static void add(const NormalEquations& part, double correlation, bool as_estimated,
                  NormalEquations& sum) {
    if (part.count == 0) return;
    const double scale = as_estimated ? squared(part.sigma / part.full_sigma) : 1.0;
    sum.H += scale / correlation * part.H;
    sum.g += scale / correlation * part.g;
    sum.count += part.count;
  }

  /// Of a point in view; the scale counts, so that a bad pose does not win by a large one.
  static double meanCost(const NormalEquations& part) {
    if (part.in_view == 0) return kOutlierCost;
    const double lost = static_cast<double>(part.in_view) - part.count;
    const double scale = part.count * std::log(std::max(part.sigma, 1e-3));
    return (part.cost + scale + kOutlierCost * lost) / static_cast<double>(part.in_view);
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

/// Iterates at one level; returns the last step (metres plus radians), infinity if that leads
/// nowhere.
double refine(Problem& problem, std::size_t level, AlignmentState& state) {
  const int iterations = level == 0 ? 6 : 8;
  const float gate_m = level == 0 ? kFinestGate_m : 0.1f;
  const double enough = level == 0 ? 1e-4 : 5e-4;
  double moved = std::numeric_limits<double>::infinity();
  for (int i = 0; i < iterations; ++i) {
    moved = step(problem.combined(state, level, gate_m), state);
    if (!std::isfinite(moved) || moved < enough) break;
  }
  return moved;
}

AlignmentState atCoarsestLevel(Problem& problem, std::size_t coarsest, AlignmentState state) {
  for (int i = 0; i < 8; ++i) {
    const float gate_m = i < 4 ? 0.3f : 0.15f;
    if (step(problem.combined(state, coarsest, gate_m), state) < 2e-3) break;
  }
  return state;
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
  std::vector<AlignmentState> ends;  // where ways have settled
  AlignmentState best;
  Fit best_fit;
  const auto judge = [&](const AlignmentState& state, double moved) {
    if (moved < kSettled) ends.push_back(state);
    const Fit fit = problem.fit(state);
    if (std::isfinite(fit.cost) && fit < best_fit) {
      best_fit = fit;
      best = state;
    }
  };
  // At coarse levels someone who walks weighs more than lines on the floor, and shade that goes
  // with the lens more than what is left of texture: where the prior is near they only mislead.
  AlignmentState near{prior.T_reference_current.inverse(), 0.0, 0.0};
  const double moved = refine(problem, 0, near);
  if (moved < kNear) judge(near, moved);
  for (const Eigen::Isometry3d& guess : guesses) {
    AlignmentState state = atCoarsestLevel(problem, coarsest, {guess.inverse(), 0.0, 0.0});
    const bool is_known = std::any_of(ends.begin(), ends.end(), [&](const AlignmentState& other) {
      return problem.pixelsApart(state, other) < kSameWay_px;
    });
    if (is_known) continue;
    double last = 0.0;
    for (std::size_t level = std::max<std::size_t>(coarsest, 1);
         level-- > 0 && std::isfinite(last);)
      last = refine(problem, level, state);
    if (std::isfinite(last)) judge(state, last);
  }
  if (!std::isfinite(best_fit.cost)) return {};
  return problem.result(best);
}

std::optional<Alignment> alignNear(const Reference& reference, const RgbdPyramid& current,
                                   const MotionPrior& prior,
                                   const Eigen::Isometry3d& T_reference_current,
                                   const AlignmentOptions& options) {
  if (!areAlike(reference, current)) return std::nullopt;
  Problem problem(reference, current, prior, options);
  AlignmentState state{T_reference_current.inverse(), 0.0, 0.0};
  if (!(refine(problem, 0, state) < kNear)) return std::nullopt;
  return problem.result(state);
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
