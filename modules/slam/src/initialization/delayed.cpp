// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "policies.hpp"

namespace colonnade {
namespace {

/// Delayed until baseline and parallax suffice (thesis 2015, section 1.4, reference [13]: Munguia
/// and Grau 2007): the landmark of the first and the present bearing, with its correlations.
class Delayed final : public ClonedInitialization {
 public:
  Delayed(const InitializationOptions& options, const Measurement& first, PoseClones& clones,
          EkfSlam& filter)
      : ClonedInitialization(first, clones, filter),
        min_baseline_m_(options.min_baseline_m),
        min_parallax_(options.min_parallax) {}

  Verdict see(const BearingSighting& sighting, EkfSlam& filter) override {
    if (!sighting.confirmed) return {};
    const auto seen = filter.parallax(clone(), first(), sighting.measurement);
    if (!seen || seen->baseline_m < min_baseline_m_ || std::abs(seen->angle) < min_parallax_)
      return {};
    if (seen->inverse_depth < 2.0 * seen->inverse_depth_sigma)
      return {Verdict::kRejected, {}, "rays do not meet"};
    return foundByTwoBearings(sighting.measurement, filter);
  }

 private:
  double min_baseline_m_;
  double min_parallax_;
};

}  // namespace

std::unique_ptr<BearingInitialization> beginDelayed(const InitializationOptions& options,
                                                    const Measurement& first, PoseClones& clones,
                                                    EkfSlam& filter) {
  return std::make_unique<Delayed>(options, first, clones, filter);
}

}  // namespace colonnade
