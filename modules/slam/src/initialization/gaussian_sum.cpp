// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "colonnade/filter/gate.hpp"
#include "depth_series.hpp"
#include "policies.hpp"
#include "two_poses.hpp"

namespace colonnade {
namespace {

/// Delayed by a sum of Gaussians along the first ray, told in the axes of the first pose and so
/// apart from the map, which later bearings prune to one (thesis 2015, section 1.4, reference [14]:
/// Lemaire, Lacroix and Sola 2005). The last term becomes the landmark if the present bearing
/// agrees with it, and is corrected by that bearing.
class GaussianSum final : public ClonedInitialization {
 public:
  GaussianSum(const InitializationOptions& options, const Measurement& first, PoseClones& clones,
              EkfSlam& filter)
      : ClonedInitialization(first, clones, filter),
        series_(depthSeries(options)),
        shares_(series_.size(), 1.0 / static_cast<double>(series_.size())),
        prune_share_(options.prune_share) {}

  Verdict see(const BearingSighting& sighting, EkfSlam& filter) override {
    if (!filter.state().find(clone())) return {Verdict::kRejected, {}, "its first pose is gone"};
    const Way way = wayFromClone(filter.state(), clone());
    // Views from nearly the same place share the errors of the way there and of the first bearing;
    // a view counts when its baseline is well beyond that of the last one that did.
    const double baseline_m = acrossFirstRay(way, sighting.measurement);
    const bool counts = baseline_m > kBaselineGrowth * last_baseline_m_;
    if (counts) last_baseline_m_ = std::max(baseline_m, kShortestBaseline_m);
    double nearest2 = HUGE_VAL;
    for (std::size_t j = 0; j < series_.size(); ++j) {
      if (shares_[j] == 0.0) continue;
      const auto [distance2, log_likelihood] = judge(series_[j], way, sighting.measurement);
      nearest2 = std::min(nearest2, distance2);
      if (counts) shares_[j] *= std::exp(log_likelihood);
    }
    if (nearest2 > chiSquareQuantile(filter.options().gate_probability, 1)) {
      if (++misfits_ > kMostMisfits) return {Verdict::kRejected, {}, "no distance fits"};
    } else {
      misfits_ = 0;
    }
    normaliseAndPrune(shares_, prune_share_);
    const auto left =
        std::count_if(shares_.begin(), shares_.end(), [](double s) { return s > 0.0; });
    if (left == 0) return {Verdict::kRejected, {}, "no distance fits"};
    if (left > 1 || !sighting.confirmed || misfits_ > 0) return {};
    return found(sighting, filter);
  }

 private:
  struct Judgement {
    double distance2;
    double log_likelihood;
  };
  /// The present bearing if the landmark were of this term.
  Judgement judge(const DepthTerm& term, const Way& way, const Measurement& now) const {
    Measurement ray = first();
    ray.z = Eigen::Vector2d(first().z(0), term.distance_m);
    const InverseMeasurement place = pointFromRange(Pose2{}, ray);
    const auto predicted =
        predictMeasurement(way.T_clone_robot, BlockKind::kPoint, place.block, now);
    const Eigen::RowVector2d H_ray = predicted.H_block * place.J_z;
    const double S = (predicted.H_robot * way.covariance * predicted.H_robot.transpose()).value() +
                     H_ray(0) * H_ray(0) * first().R(0, 0) +
                     H_ray(1) * H_ray(1) * term.sigma_m * term.sigma_m + now.R(0, 0);
    const double nu = innovationOf(now, predicted.z)(0);
    return {nu * nu / S, -0.5 * (nu * nu / S + std::log(S))};
  }

  Verdict found(const BearingSighting& sighting, EkfSlam& filter) const {
    const auto last =
        std::find_if(shares_.begin(), shares_.end(), [](double s) { return s > 0.0; });
    const DepthTerm& term = series_[static_cast<std::size_t>(last - shares_.begin())];
    // rho = 1 / s, so its standard deviation is sigma / s^2.
    const auto id = filter.addLandmarkOnRay(clone(), first(), 1.0 / term.distance_m,
                                            term.sigma_m / (term.distance_m * term.distance_m));
    if (!id) return {Verdict::kRejected, {}, "not finite"};
    const Match match{*id, sighting.measurement};
    if (!filter.update({&match, 1}).front()) {
      filter.remove(*id);
      return {Verdict::kRejected, {}, "no distance fits"};
    }
    return {Verdict::kFounded, id, {}};
  }

  double acrossFirstRay(const Way& way, const Measurement& now) const {
    const Eigen::Vector2d baseline =
        transform(way.T_clone_robot, now.p_robot_camera) - first().p_robot_camera;
    const double alpha = first().z(0);
    return std::abs(baseline.y() * std::cos(alpha) - baseline.x() * std::sin(alpha));
  }

  static constexpr int kMostMisfits = 3;
  static constexpr double kBaselineGrowth = 1.1;
  static constexpr double kShortestBaseline_m = 0.02;
  double last_baseline_m_ = 0.0;
  std::vector<DepthTerm> series_;
  std::vector<double> shares_;
  double prune_share_;
  int misfits_ = 0;
};

}  // namespace

std::unique_ptr<BearingInitialization> beginGaussianSum(const InitializationOptions& options,
                                                        const Measurement& first,
                                                        PoseClones& clones, EkfSlam& filter) {
  return std::make_unique<GaussianSum>(options, first, clones, filter);
}

}  // namespace colonnade
