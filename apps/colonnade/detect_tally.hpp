// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "detect_stages.hpp"

namespace colonnade {

/// What the detectors saw over all frames, for detect.json and the closing lines.
struct DetectTally {
  std::size_t frames = 0;
  std::map<std::string, std::size_t> accepted;  ///< by kind
  std::map<std::string, std::size_t> refused;   ///< by kind and reason
  std::map<std::string, std::size_t> lacking;   ///< frames of which nothing can be told, by reason
  std::vector<double> edges_ms;
  std::vector<double> detectors_ms;

  void add(const DetectStages::Seen& seen);
  nlohmann::ordered_json json() const;
  std::string text() const;
};

}  // namespace colonnade
