// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/pillar_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace colonnade {
namespace {

Eigen::Vector2d position(const Measurement& m) {
  return m.z[1] * Eigen::Vector2d(std::cos(m.z[0]), std::sin(m.z[0]));
}

struct Pair {
  double width_px = 0.0;
  double width_m = 0.0;
  std::size_t first = 0;
  std::size_t second = 0;
};

/// Share of the shorter edge beside which the other one runs.
double commonStretch(const Detection& a, const Detection& b) {
  const double top = std::max(a.a_px.y(), b.a_px.y());
  const double bottom = std::min(a.b_px.y(), b.b_px.y());
  const double shorter = std::min(a.b_px.y() - a.a_px.y(), b.b_px.y() - b.a_px.y());
  return shorter > 0.0 ? (bottom - top) / shorter : 0.0;
}

/// On which side of an edge the pillar lies whose shade is known: +1 right, -1 left, 0 neither or
/// both.
int sideOfBody(const Detection& edge, const ShadeOptions& shade) {
  return static_cast<int>(hasShade(edge.appearance.right, shade)) -
         static_cast<int>(hasShade(edge.appearance.left, shade));
}

double column(const Detection& edge) { return 0.5 * (edge.a_px + edge.b_px).x(); }

}  // namespace

void refuseFalseEdges(Detections& detections, const ShadeOptions& shade) {
  if (!shade.known()) return;
  for (auto& edge : detections) {
    if (!edge.accepted() || sideOfBody(edge, shade) != 0) continue;
    edge.refusal =
        hasShade(edge.appearance.left, shade) ? "inside the known shade" : "not of the known shade";
  }
  // An edge is false if another one on the same side of the same body gives a larger width: it lies
  // outside, near by in terms of that width, and no other border lies between them.
  constexpr double kShareOfWidth = 0.25;
  std::vector<bool> inner(detections.size(), false);
  for (std::size_t i = 0; i < detections.size(); ++i) {
    const auto& edge = detections[i];
    if (!edge.accepted()) continue;
    const int body = sideOfBody(edge, shade);
    for (const auto& outer : detections) {
      if (!outer.accepted() || sideOfBody(outer, shade) != body) continue;
      const double outward_px = body * (column(edge) - column(outer));
      if (outward_px <= 0.0 || commonStretch(edge, outer) < 0.5) continue;
      for (const auto& opposite : detections) {
        if (!opposite.accepted() || sideOfBody(opposite, shade) != -body) continue;
        const double width_px = body * (column(opposite) - column(outer));
        if (width_px > outward_px && outward_px < kShareOfWidth * width_px) inner[i] = true;
      }
    }
  }
  for (std::size_t i = 0; i < detections.size(); ++i)
    if (inner[i]) detections[i].refusal = "false edge inside a pillar";
}

void pairPillars(Detections& detections, const PillarOptions& options, const ShadeOptions& shade) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < detections.size(); ++i) {
    for (std::size_t j = i + 1; j < detections.size(); ++j) {
      const auto& a = detections[i];
      const auto& b = detections[j];
      if (!a.accepted() || !b.accepted() || commonStretch(a, b) < 0.6) continue;
      if (a.appearance.gradient_sign * b.appearance.gradient_sign >= 0) continue;
      if (a.measurement.hasRange() != b.measurement.hasRange()) continue;
      const int body = shade.known() ? sideOfBody(column(a) < column(b) ? a : b, shade) : 1;
      if (body != 1) continue;  // the gap between two pillars
      Pair pair{std::abs((a.a_px + a.b_px - b.a_px - b.b_px).x()) / 2.0, 0.0, i, j};
      if (a.measurement.hasRange()) {
        pair.width_m = (position(a.measurement) - position(b.measurement)).norm();
        if (pair.width_m < options.min_pair_width_m || pair.width_m > options.max_pair_width_m) {
          continue;
        }
      } else if (pair.width_px > options.max_pair_width_px) {
        continue;
      }
      pairs.push_back(pair);
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.width_px, a.first, a.second) < std::tie(b.width_px, b.first, b.second);
  });
  for (const auto& pair : pairs) {
    auto& a = detections[pair.first];
    auto& b = detections[pair.second];
    if (a.partner || b.partner) continue;
    a.partner = pair.second;
    b.partner = pair.first;
    a.width_m = b.width_m = pair.width_m;
  }
}

}  // namespace colonnade
