// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "detect_tally.hpp"

#include <nlohmann/json.hpp>

#include "colonnade/base/text.hpp"
#include "measured.hpp"

namespace colonnade {

void DetectTally::add(const DetectStages::Seen& seen) {
  ++frames;
  edges_ms.push_back(seen.edges_ms);
  detectors_ms.push_back(seen.detectors_ms);
  for (const std::string& reason : seen.lacking) ++lacking[reason];
  for (const Detection& detection : seen.detections) {
    const std::string kind = name(detection.kind());
    ++(detection.accepted() ? accepted[kind] : refused[kind + ": " + detection.refusal]);
  }
}

nlohmann::ordered_json DetectTally::json() const {
  return {
      {"frames", frames},
      {"accepted", accepted},
      {"refused", refused},
      {"lacking", lacking},
      {"timing_ms", {{"edges", timingJson(edges_ms)}, {"detectors", timingJson(detectors_ms)}}}};
}

std::string DetectTally::text() const {
  std::string text = "frames     " + std::to_string(frames) + "\n";
  for (const auto& [reason, count] : lacking)
    text += "lacking    " + std::to_string(count) + " frames: " + reason + "\n";
  for (const auto& [kind, count] : accepted)
    text += kind + std::string(kind.size() < 11 ? 11 - kind.size() : 1, ' ') +
            std::to_string(count) + " accepted\n";
  for (const auto& [reason, count] : refused)
    text += "refused    " + std::to_string(count) + " " + reason + "\n";
  return text + "time       " + formatFixed(quantile(edges_ms, 0.5), 1) + " ms edges, " +
         formatFixed(quantile(detectors_ms, 0.5), 1) + " ms detectors (median of a frame)\n";
}

}  // namespace colonnade
