// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "policies.hpp"

namespace colonnade {

std::unique_ptr<BearingInitialization> beginInitialization(const InitializationOptions& options,
                                                           const Measurement& first,
                                                           PoseClones& clones, EkfSlam& filter) {
  if (!first.z.allFinite() || !first.R.allFinite() || !first.p_robot_camera.allFinite())
    return nullptr;
  if (options.policy == "gaussian-sum") return beginGaussianSum(options, first, clones, filter);
  if (options.policy == "sample-entropy") return beginSampleEntropy(options, first, clones, filter);
  if (options.policy == "undelayed") return beginUndelayed(options, first, clones, filter);
  return beginDelayed(options, first, clones, filter);
}

}  // namespace colonnade
