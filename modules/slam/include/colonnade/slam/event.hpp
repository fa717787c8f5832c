// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "colonnade/base/landmark.hpp"

namespace colonnade {

/// Something worth a line in events.csv.
struct Event {
  double stamp_s = 0.0;
  std::size_t frame = 0;
  std::string what;  ///< birth, settled, purged, axis, refusal, coasting ...
  std::optional<LandmarkId> landmark;
  std::string reason;
};

}  // namespace colonnade
