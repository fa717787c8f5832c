// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "capture_times.hpp"

#include <algorithm>

#include "colonnade/simulation/random.hpp"

namespace colonnade {

std::vector<double> captureTimes(const CameraOptions& camera, double duration_s,
                                 std::uint64_t seed) {
  Random random(seed, "capture");
  const double limit_s = 0.4 / camera.rate_hz;  // so that frames stay in order
  std::vector<double> times = {0.0};
  for (std::int64_t k = 1;; ++k) {
    const double planned_s = static_cast<double>(k) / camera.rate_hz;
    if (planned_s > duration_s + 1e-9) return times;
    const double late_s = std::clamp(camera.stamp_jitter_s * random.normal(), -limit_s, limit_s);
    if (random.uniform() >= camera.drop_fraction) times.push_back(planned_s + late_s);
  }
}

}  // namespace colonnade
