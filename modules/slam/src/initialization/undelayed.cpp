// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "depth_series.hpp"
#include "policies.hpp"

namespace colonnade {
namespace {

/// Undelayed (thesis 2015, section 1.4, reference [11]: Sola, Monin, Devy and Lemaire 2005): a
/// geometric series of Gaussians along the first ray, eq. (9), each a landmark of the state. Every
/// further bearing multiplies their aggregated likelihoods, eq. (10) and (11), deletes the unlikely
/// and corrects the state by those left, each with the share of the information its likelihood
/// gives it: R / share, so that together they tell what one bearing does (federated information
/// sharing). When one is left, it is the landmark. Beside the paper: the first bearing is shared
/// out as well, since the terms would else count its error as many times as there are terms; and
/// while the terms disagree, the spread of what they predict adds to R.
class Undelayed final : public BearingInitialization {
 public:
  Undelayed(const InitializationOptions& options, const Measurement& first, EkfSlam& filter)
      : prune_share_(options.prune_share) {
    const auto series = depthSeries(options);
    const auto terms = static_cast<double>(series.size());
    for (const DepthTerm& term : series) {
      Measurement on_ray = first;
      on_ray.z = Eigen::Vector2d(first.z(0), term.distance_m);
      on_ray.R = Eigen::Vector2d(first.R(0, 0) * terms, term.sigma_m * term.sigma_m).asDiagonal();
      const auto id = filter.addLandmark(on_ray);
      if (!id) continue;
      filter.evidence(*id).hypothesis = true;
      members_.push_back(*id);
      shares_.push_back(1.0 / terms);
    }
  }

  Verdict see(const BearingSighting& sighting, EkfSlam& filter) override {
    if (!fits(sighting.measurement, filter)) {
      if (++misfits_ > kMostMisfits) return {Verdict::kRejected, {}, "no distance fits"};
      return {};
    }
    misfits_ = 0;
    weigh(sighting, filter);
    prune(filter);
    if (members_.empty()) return {Verdict::kRejected, {}, "no distance fits"};
    share(sighting, filter);
    if (members_.size() > 1 || !sighting.confirmed) return {};
    const LandmarkId founded = members_.front();
    filter.evidence(founded).hypothesis = false;
    members_.clear();
    return {Verdict::kFounded, founded, {}};
  }

  void leave(EkfSlam& filter) override {
    for (const LandmarkId member : members_) filter.remove(member);
    members_.clear();
  }

 private:
  bool fits(const Measurement& measurement, const EkfSlam& filter) const {
    return std::any_of(members_.begin(), members_.end(), [&](LandmarkId member) {
      const auto innovation = filter.innovation(member, measurement);
      return innovation && innovation->within_gate;
    });
  }

  void weigh(const BearingSighting& sighting, const EkfSlam& filter) {
    Measurement measurement = sighting.measurement;
    measurement.R *= sighting.noise_scale;
    for (std::size_t j = 0; j < members_.size(); ++j) {
      const auto innovation = filter.innovation(members_[j], measurement);
      shares_[j] *= innovation  // of a place that is no longer in the state there is none
                        ? std::exp(-0.5 * innovation->distance2) / std::sqrt(innovation->S(0, 0))
                        : 0.0;
    }
  }

  void prune(EkfSlam& filter) {
    normaliseAndPrune(shares_, prune_share_);
    std::size_t kept = 0;
    for (std::size_t j = 0; j < members_.size(); ++j) {
      if (shares_[j] == 0.0) {
        filter.remove(members_[j]);
        continue;
      }
      members_[kept] = members_[j];
      shares_[kept++] = shares_[j];
    }
    members_.resize(kept);
    shares_.resize(kept);
  }

  void share(const BearingSighting& sighting, EkfSlam& filter) const {
    std::vector<Match> matches;
    const double spread2 = disagreement2(sighting.measurement, filter);
    for (std::size_t j = 0; j < members_.size(); ++j) {
      matches.push_back({members_[j], sighting.measurement});
      Measurement& share = matches.back().measurement;
      share.R(0, 0) = (share.R(0, 0) + spread2) / shares_[j];
    }
    // Innovations of places that are mostly wrong tell nothing of the filter's health.
    const InnovationHealth health = filter.health();
    filter.update(matches, sighting.noise_scale);
    filter.health() = health;
  }

  /// The variance of the bearings the members predict, by their shares.
  double disagreement2(const Measurement& measurement, const EkfSlam& filter) const {
    double mean = 0.0;
    double square = 0.0;
    for (std::size_t j = 0; j < members_.size(); ++j) {
      const auto innovation = filter.innovation(members_[j], measurement);
      if (!innovation) continue;
      mean += shares_[j] * innovation->nu(0);
      square += shares_[j] * innovation->nu(0) * innovation->nu(0);
    }
    return std::max(0.0, square - mean * mean);
  }

  static constexpr int kMostMisfits = 3;
  std::vector<LandmarkId> members_;
  std::vector<double> shares_;  ///< aggregated likelihoods, one for each member
  double prune_share_;
  int misfits_ = 0;
};

}  // namespace

std::unique_ptr<BearingInitialization> beginUndelayed(const InitializationOptions& options,
                                                      const Measurement& first, PoseClones&,
                                                      EkfSlam& filter) {
  return std::make_unique<Undelayed>(options, first, filter);
}

}  // namespace colonnade
