// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/baselines/baseline.hpp"

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"
#include "dead_reckoning.hpp"
#include "difodo.hpp"
#include "kf_slam.hpp"
#include "kinect_slam.hpp"

namespace colonnade {

const std::vector<std::string>& baselineNames() {
  static const std::vector<std::string> names = {"kinect-3d-slam", "difodo", "kf-slam",
                                                 "dead-reckoning"};
  return names;
}

std::unique_ptr<Baseline> makeBaseline(const std::string& name, const BaselineOptions& options) {
  if (name == "kinect-3d-slam") return std::make_unique<KinectSlam>(options.kinect, options.motion);
  if (name == "difodo") return std::make_unique<Difodo>(options.difodo, options.motion);
  if (name == "kf-slam") return std::make_unique<KfSlam>(options);
  if (name == "dead-reckoning") return std::make_unique<DeadReckoning>();
  throw Error("no baseline " + name + "; there are " + joined(baselineNames(), ", "),
              ExitCode::kUsage);
}

}  // namespace colonnade
