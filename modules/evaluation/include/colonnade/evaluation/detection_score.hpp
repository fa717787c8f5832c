// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "colonnade/base/landmark.hpp"

namespace colonnade {

/// A landmark in one picture: the ends of its line in pixels and, where known, how far it is.
struct ImageLine {
  LandmarkKind kind = LandmarkKind::kPillarEdge;
  Eigen::Vector2d a_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d b_px = Eigen::Vector2d::Zero();
  std::optional<double> distance_m;
};

/// The part of a line inside a picture; nothing where it passes by (Liang and Barsky 1984).
std::optional<ImageLine> clipped(const ImageLine& line, int width_px, int height_px);

/// What a line in a picture is worth as a landmark.
enum class TrueClass {
  kWanted,     ///< a landmark: right, and missed where it is not found (kinds of landmarks; round)
  kStructure,  ///< an edge of the building beside a listed one: right, not missed (minor)
  kLeaf,     ///< of an open door, at rest, but perhaps elsewhere tomorrow: right in the wide sense
             ///< only, and counted apart
  kFixed,    ///< vertical and at rest, but no edge that stands on the floor and stays where it is
             ///< (fixture, mark, cabinet): right in the wide sense only
  kMovable,  ///< furniture: wrong
  kPane,     ///< no line but the box around a pane: what lies behind is not in the table
};

/// What really is in that picture.
struct TrueImageLine : ImageLine {
  TrueClass true_class = TrueClass::kWanted;
  std::string called;  ///< in the file
  int landmark = -1;
  double visible_px = 0.0;
  double contrast = 0.0;  ///< gray levels across it
};

/// STEM_columns.csv of a simulated log, by stamp in microseconds. Throws Error.
using TrueImageLines = std::map<std::int64_t, std::vector<TrueImageLine>>;
TrueImageLines readColumnsCsv(const std::filesystem::path& path);
std::int64_t microseconds(double stamp_s);

struct DetectionScoreOptions {
  double tolerance_px = 3.0;   ///< across the line, at both ends of what the two have in common
  double least_overlap = 0.5;  ///< of the shorter one
  /// True lines a detector has to find; all others it may.
  double max_distance_m = 6.0;
  double max_corner_distance_m = 3.81;  ///< depth-slope corners, whatever their contrast
  double min_visible_px = 60.0;
  double min_contrast = 15.0;
};

/// Scores detections of one kind over many pictures.
///   precision: share of the detections that lie on a true line of their kind:
///     for pillars an edge of the building that stands on the floor, or the outline of a round one.
///     Pillars on a line of whatever it be that is farther, shorter or fainter than the options ask
///     for are ignored: neither right nor wrong. So are those on nothing that lie in a pane
///   precision_wide: pillars on any line that is vertical in space and stays where it is counted
///     as right too: boards, joints, panels, open doors, cabinets. Never table legs or people
///   precision_no_leaf: as precision, without those on leaves of open doors
///   recall: share of the true lines to be found that have a detection
///   offset_rms_px: across the line, of right detections from the nearest line at rest
class DetectionScore {
 public:
  explicit DetectionScore(const DetectionScoreOptions& options = {}) : options_(options) {}

  /// One picture: accepted detections against what is there.
  void add(const std::vector<ImageLine>& detected, const std::vector<TrueImageLine>& there);

  struct Kind {
    std::size_t detected = 0, right = 0, right_wide = 0, ignored = 0, on_leaves = 0;
    std::size_t wanted = 0, found = 0;
    double offset_squares = 0.0;
    double distance_squares = 0.0;
    std::size_t distances = 0;
    std::map<std::string, std::size_t> lie_on;  ///< detections by what is there; "nothing"

    double precision() const;
    double precisionWide() const;
    double precisionNoLeaf() const;
    double recall() const;
    double offsetRms() const;
    double distanceRms() const;
  };
  const Kind& of(LandmarkKind kind) const { return kinds_[static_cast<std::size_t>(kind)]; }
  const DetectionScoreOptions& options() const { return options_; }

 private:
  DetectionScoreOptions options_;
  std::array<Kind, kLandmarkKinds> kinds_{};
};

nlohmann::ordered_json toJson(const DetectionScore& score);
std::string toText(const DetectionScore& score);

}  // namespace colonnade
