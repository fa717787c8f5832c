// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "wall_line.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "colonnade/base/angle.hpp"

namespace colonnade {
namespace {

constexpr double kSameLine_m = 0.03;
constexpr double kSameDirection = radians(1.0);

Interval extentAlong(const WallLine& line, const WallLine& other, const Interval& piece) {
  const double a = line.along(other.p + piece.begin * other.u);
  const double b = line.along(other.p + piece.end * other.u);
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace

double coveredLength(const Interval& interval, std::vector<Interval> others) {
  std::sort(others.begin(), others.end(),
            [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
  double covered = 0.0;
  double reached = interval.begin;
  for (const auto& other : others) {
    const Interval part = overlap({reached, interval.end}, other);
    covered += part.length();
    reached = std::max(reached, part.end);
  }
  return covered;
}

int WallLine::mostObservations() const {
  return *std::max_element(observations.begin(), observations.end());
}

double WallLine::length() const {
  double sum = 0.0;
  for (const auto& piece : pieces) sum += piece.length();
  return sum;
}

WallLine toLine(const LandmarkRecord& record) {
  WallLine line;
  line.id = record.id;
  line.p = record.p_world;
  const double direction = record.direction.value_or(0.0);
  line.u = {std::cos(direction), std::sin(direction)};
  const double a = line.along(record.extent_a);
  const double b = line.along(record.extent_b);
  line.pieces = {{std::min(a, b), std::max(a, b)}};
  line.observations = {record.observations};
  line.hallway = record.hallway;
  return line;
}

std::vector<WallLine> joinLines(const LandmarkMap& map) {
  std::vector<WallLine> single;
  for (const auto& record : map)
    if (record.kind == LandmarkKind::kFloorEdge) single.push_back(toLine(record));
  std::stable_sort(single.begin(), single.end(), [](const WallLine& a, const WallLine& b) {
    return a.length() > b.length() + 1e-9;
  });
  std::vector<WallLine> lines;
  for (const auto& piece : single) {
    const Eigen::Vector2d middle =
        piece.p + 0.5 * (piece.pieces.front().begin + piece.pieces.front().end) * piece.u;
    const auto same = std::find_if(lines.begin(), lines.end(), [&](const WallLine& line) {
      return line.hallway == piece.hallway && std::abs(line.across(middle)) <= kSameLine_m &&
             std::abs(lineAngle(piece, line)) <= kSameDirection;
    });
    if (same == lines.end()) {
      lines.push_back(piece);
      continue;
    }
    same->pieces.push_back(extentAlong(*same, piece, piece.pieces.front()));
    same->observations.push_back(piece.observations.front());
  }
  return lines;
}

double lineAngle(const WallLine& a, const WallLine& b) {
  const double turn = std::atan2(b.u.x() * a.u.y() - b.u.y() * a.u.x(), b.u.dot(a.u));
  return std::remainder(turn, kPi);
}

LineFit fitLine(const WallLine& estimate, const WallLine& truth) {
  LineFit fit;
  fit.angle = lineAngle(estimate, truth);
  fit.extent = extentAlong(truth, estimate, estimate.pieces.front());
  fit.gap_m = std::numeric_limits<double>::infinity();
  double weighted = 0.0;
  double nearest = 0.0;
  for (const auto& piece : truth.pieces) {
    const Interval both = overlap(fit.extent, piece);
    fit.on_truth_m += both.length();
    weighted += both.length() * 0.5 * (both.begin + both.end);
    const double gap = std::max(0.0, both.begin - both.end);
    if (gap >= fit.gap_m) continue;
    fit.gap_m = gap;
    nearest = std::clamp(0.5 * (both.begin + both.end), fit.extent.begin, fit.extent.end);
  }
  const double middle = fit.on_truth_m > 0.0 ? weighted / fit.on_truth_m : nearest;
  // The estimate's point beside `middle` of the truth.
  const double slope = std::tan(fit.angle);
  fit.offset_m = truth.across(estimate.p) + slope * (middle - truth.along(estimate.p));
  return fit;
}

}  // namespace colonnade
