// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/detection_score.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "colonnade/base/csv_table.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

std::optional<LandmarkKind> kindOfName(const std::string& text) {
  for (int i = 0; i < kLandmarkKinds; ++i)
    if (text == name(static_cast<LandmarkKind>(i))) return static_cast<LandmarkKind>(i);
  return std::nullopt;
}

/// The kind and class of a row; nothing for a person or a mirror, in which there is nothing to
/// find.
std::optional<std::pair<LandmarkKind, TrueClass>> meaningOf(const std::string& text) {
  if (const auto kind = kindOfName(text)) return std::pair(*kind, TrueClass::kWanted);
  const auto upright = [](TrueClass what) { return std::pair(LandmarkKind::kPillarEdge, what); };
  if (text == "round") return upright(TrueClass::kWanted);
  if (text == "minor") return upright(TrueClass::kStructure);
  if (text == "furniture") return upright(TrueClass::kMovable);
  if (text == "leaf") return upright(TrueClass::kLeaf);
  if (text == "glass") return upright(TrueClass::kPane);
  for (const char* fixed : {"fixture", "mark", "cabinet"})
    if (text == fixed) return upright(TrueClass::kFixed);
  return std::nullopt;
}

/// The offset across `there` of the part of `seen` beside it, if they share enough and lie near
/// enough at both ends of that part.
std::optional<double> offsetAcross(const ImageLine& seen, const ImageLine& there,
                                   const DetectionScoreOptions& options) {
  const Eigen::Vector2d axis = there.b_px - there.a_px;
  const double length = axis.norm();
  const Eigen::Vector2d across_seen = seen.b_px - seen.a_px;
  if (length < 1.0 || across_seen.norm() < 1.0) return std::nullopt;
  const Eigen::Vector2d along = axis / length;
  const Eigen::Vector2d normal(-along.y(), along.x());
  double t0 = along.dot(seen.a_px - there.a_px), t1 = along.dot(seen.b_px - there.a_px);
  double d0 = normal.dot(seen.a_px - there.a_px), d1 = normal.dot(seen.b_px - there.a_px);
  if (t0 > t1) {
    std::swap(t0, t1);
    std::swap(d0, d1);
  }
  const double from = std::max(0.0, t0), to = std::min(length, t1);
  if (to - from < options.least_overlap * std::min(length, t1 - t0) || !(t1 > t0))
    return std::nullopt;
  const auto at = [&](double t) { return d0 + (d1 - d0) * (t - t0) / (t1 - t0); };
  if (std::max(std::abs(at(from)), std::abs(at(to))) > options.tolerance_px) return std::nullopt;
  return at(0.5 * (from + to));
}

/// Near, long and strong enough to be judged.
bool isWithinLimits(const TrueImageLine& line, const DetectionScoreOptions& options) {
  const bool by_depth = line.kind == LandmarkKind::kDepthSlope;
  const double farthest_m = by_depth ? options.max_corner_distance_m : options.max_distance_m;
  return line.visible_px >= options.min_visible_px &&
         (by_depth || line.contrast >= options.min_contrast) &&
         (!line.distance_m || *line.distance_m <= farthest_m);
}

/// Does a line lie in the box around a pane?
bool liesIn(const TrueImageLine& pane, const ImageLine& seen, double tolerance_px) {
  const Eigen::Vector2d least = pane.a_px.array() - tolerance_px;
  const Eigen::Vector2d most = pane.b_px.array() + tolerance_px;
  const auto inside = [&](const Eigen::Vector2d& p_px) {
    return (p_px.array() >= least.array()).all() && (p_px.array() <= most.array()).all();
  };
  return inside(seen.a_px) && inside(seen.b_px);
}

bool isWanted(const TrueImageLine& line, const DetectionScoreOptions& options) {
  return line.true_class == TrueClass::kWanted && isWithinLimits(line, options);
}

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

std::optional<ImageLine> clipped(const ImageLine& line, int width_px, int height_px) {
  const Eigen::Vector2d way = line.b_px - line.a_px;
  const Eigen::Vector2d last(width_px - 1, height_px - 1);
  double from = 0.0, to = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    if (way(axis) == 0.0) {
      if (line.a_px(axis) < 0.0 || line.a_px(axis) > last(axis)) return std::nullopt;
      continue;
    }
    const double t0 = -line.a_px(axis) / way(axis);
    const double t1 = (last(axis) - line.a_px(axis)) / way(axis);
    from = std::max(from, std::min(t0, t1));
    to = std::min(to, std::max(t0, t1));
  }
  if (!(from < to)) return std::nullopt;
  ImageLine inside = line;
  inside.a_px = line.a_px + from * way;
  inside.b_px = line.a_px + to * way;
  return inside;
}

std::int64_t microseconds(double stamp_s) { return std::llround(1e6 * stamp_s); }

TrueImageLines readColumnsCsv(const std::filesystem::path& path) {
  CsvTable table(
      path, {"stamp", "id", "kind", "u0", "v0", "u1", "v1", "length_px", "range_m", "contrast"},
      "a table of what each frame shows");
  TrueImageLines lines;
  while (const auto row = table.next()) {
    auto& frame = lines[microseconds(row->number("stamp"))];
    const auto meaning = meaningOf(row->text("kind"));
    if (!meaning) continue;
    TrueImageLine line;
    std::tie(line.kind, line.true_class) = *meaning;
    line.called = row->text("kind");
    line.a_px = {row->number("u0"), row->number("v0")};
    line.b_px = {row->number("u1"), row->number("v1")};
    if (!row->empty("range_m")) line.distance_m = row->number("range_m");
    if (line.true_class != TrueClass::kPane) line.landmark = row->integer("id");
    line.visible_px = row->number("length_px");
    line.contrast = row->empty("contrast") ? 0.0 : std::abs(row->number("contrast"));
    frame.push_back(line);
  }
  return lines;
}

void DetectionScore::add(const std::vector<ImageLine>& detected,
                         const std::vector<TrueImageLine>& there) {
  std::vector<bool> found(there.size(), false);
  for (const ImageLine& seen : detected) {
    Kind& kind = kinds_[static_cast<std::size_t>(seen.kind)];
    ++kind.detected;
    std::optional<double> nearest;
    std::size_t nearest_line = 0;
    bool within_limits[2] = {};  // by rank: is one of the lines it lies on
    bool in_pane = false;
    double closest = options_.tolerance_px;  // to any line at rest: what it really is
    const auto rank = [&](std::size_t i) {   // what counts most, then what lies nearest
      return there[i].true_class > TrueClass::kStructure ? 1 : 0;
    };
    for (std::size_t i = 0; i < there.size(); ++i) {
      if (there[i].kind != seen.kind) continue;
      if (there[i].true_class == TrueClass::kPane) {
        in_pane |= liesIn(there[i], seen, options_.tolerance_px);
        continue;
      }
      const auto offset = offsetAcross(seen, there[i], options_);
      if (!offset) continue;
      found[i] = true;
      within_limits[rank(i)] |= isWithinLimits(there[i], options_);
      if (there[i].true_class <= TrueClass::kFixed) closest = std::min(closest, std::abs(*offset));
      if (nearest && std::pair(rank(nearest_line), std::abs(*nearest)) <=
                         std::pair(rank(i), std::abs(*offset)))
        continue;
      nearest = offset;
      nearest_line = i;
    }
    if (seen.kind == LandmarkKind::kPillarEdge &&
        (nearest ? !within_limits[rank(nearest_line)] : in_pane)) {
      ++kind.ignored;
      continue;
    }
    ++kind.lie_on[!nearest                             ? "nothing"
                  : there[nearest_line].called.empty() ? name(seen.kind)
                                                       : there[nearest_line].called];
    if (!nearest) continue;
    kind.on_leaves += there[nearest_line].true_class == TrueClass::kLeaf ? 1 : 0;
    kind.right_wide += there[nearest_line].true_class <= TrueClass::kFixed ? 1 : 0;
    if (there[nearest_line].true_class > TrueClass::kStructure) continue;
    ++kind.right;
    kind.offset_squares += closest * closest;
    // The distance of a floor edge is across the line, the truth's to the middle of what is seen.
    if (seen.kind == LandmarkKind::kFloorEdge) continue;
    if (!seen.distance_m || !there[nearest_line].distance_m) continue;
    const double error = *seen.distance_m - *there[nearest_line].distance_m;
    kind.distance_squares += error * error;
    ++kind.distances;
  }
  for (std::size_t i = 0; i < there.size(); ++i) {
    if (!isWanted(there[i], options_)) continue;
    Kind& kind = kinds_[static_cast<std::size_t>(there[i].kind)];
    ++kind.wanted;
    kind.found += found[i] ? 1 : 0;
  }
}

double DetectionScore::Kind::precision() const { return share(right, detected - ignored); }
double DetectionScore::Kind::precisionWide() const { return share(right_wide, detected - ignored); }
double DetectionScore::Kind::precisionNoLeaf() const {
  return share(right, detected - ignored - on_leaves);
}
double DetectionScore::Kind::recall() const { return share(found, wanted); }
double DetectionScore::Kind::offsetRms() const {
  return right == 0 ? 0.0 : std::sqrt(offset_squares / static_cast<double>(right));
}
double DetectionScore::Kind::distanceRms() const {
  return distances == 0 ? 0.0 : std::sqrt(distance_squares / static_cast<double>(distances));
}

nlohmann::ordered_json toJson(const DetectionScore& score) {
  nlohmann::ordered_json json;
  for (int i = 0; i < kLandmarkKinds; ++i) {
    const auto& kind = score.of(static_cast<LandmarkKind>(i));
    const auto orNull = [](bool known, double value) {
      return known ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
    };
    json[name(static_cast<LandmarkKind>(i))] = {
        {"detected", kind.detected},
        {"ignored", kind.ignored},
        {"precision", orNull(kind.detected > kind.ignored, kind.precision())},
        {"precision_wide", orNull(kind.detected > kind.ignored, kind.precisionWide())},
        {"precision_no_leaf",
         orNull(kind.detected > kind.ignored + kind.on_leaves, kind.precisionNoLeaf())},
        {"wanted", kind.wanted},
        {"recall", orNull(kind.wanted > 0, kind.recall())},
        {"offset_rms_px", orNull(kind.right > 0, kind.offsetRms())},
        {"distance_rms_m", orNull(kind.distances > 0, kind.distanceRms())},
        {"lie_on", kind.lie_on}};
  }
  return json;
}

std::string toText(const DetectionScore& score) {
  const auto& o = score.options();
  std::string text = "against the truth, within " + formatFixed(o.tolerance_px, 1) +
                     " px; lines nearer than " + formatFixed(o.max_distance_m, 1) + " m (corners " +
                     formatFixed(o.max_corner_distance_m, 1) + " m), " +
                     formatFixed(o.min_visible_px, 0) + " px or more in view, contrast " +
                     formatFixed(o.min_contrast, 0) + " or more (corners any)\n";
  for (int i = 0; i < kLandmarkKinds; ++i) {
    const auto& kind = score.of(static_cast<LandmarkKind>(i));
    std::string line = name(static_cast<LandmarkKind>(i));
    line.resize(12, ' ');
    const auto orDash = [](bool known, double value, int decimals) {
      return known ? formatFixed(value, decimals) : std::string("-");
    };
    line +=
        "precision " + orDash(kind.detected > kind.ignored, kind.precision(), 3) +
        (kind.right_wide > kind.right
             ? " (" + formatFixed(kind.precisionNoLeaf(), 3) + " without open doors, " +
                   formatFixed(kind.precisionWide(), 3) + " with them, boards, panels, cabinets)"
             : "") +
        " of " + std::to_string(kind.detected - kind.ignored) +
        (kind.ignored > 0 ? " (" + std::to_string(kind.ignored) + " beyond limits ignored)" : "") +
        ", recall " + orDash(kind.wanted > 0, kind.recall(), 3) + " of " +
        std::to_string(kind.wanted) + ", offset " + orDash(kind.right > 0, kind.offsetRms(), 2) +
        " px rms, distance " + orDash(kind.distances > 0, kind.distanceRms(), 3) + " m rms\n";
    text += line;
    if (kind.right + kind.ignored == kind.detected) continue;
    text += "            lie on";
    for (const auto& [what, count] : kind.lie_on) text += " " + what + " " + std::to_string(count);
    text += "\n";
  }
  return text;
}

}  // namespace colonnade
