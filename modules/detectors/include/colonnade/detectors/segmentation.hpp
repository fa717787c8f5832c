// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "colonnade/base/options.hpp"
#include "colonnade/base/pose2.hpp"
#include "colonnade/detectors/detection.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// What counts as moving and as reflective, and how much of a detection may lie on it.
struct SegmentationOptions {
  static constexpr const char* kSection = "Segmentation";
  bool moving = true;
  bool reflective = true;
  double short_history_s = 0.3;      ///< age of the former view for what is quick
  double long_history_s = 0.9;       ///< and for what is slow
  double memory_s = 3.0;             ///< age of views that tell what stood behind who moved on
  double tolerance_m = 0.10;         ///< of depth between two views
  double tolerance_per_m2 = 0.012;   ///< grows with squared depth, as stereo noise does
  double min_moving_area_m2 = 0.03;  ///< smaller changes are noise at outlines
  double grow_m = 0.35;              ///< from what changed to the rest of the body
  double max_speed_m_s = 2.0;        ///< of people
  double max_moving_share = 0.5;     ///< more of the view than this: the motion was wrong
  double min_share_on_moving = 0.3;  ///< of a detection's places
  double sensor_reach_m = 6.0;       ///< where depth ends
  double border_reach = 0.8;         ///< of that: surfaces around a pane are nearer
  double min_border_share = 0.75;    ///< of a pane's outline that must be such a surface
  double min_pane_share = 0.004;     ///< of the image
  double min_share_on_reflective = 0.6;

  void visit(OptionVisitor& v) {
    v.flag("moving", moving, "refuse what is seen on people and other moving things");
    v.flag("reflective", reflective, "refuse what is seen in panes and mirrors");
    v.number("short_history_s", short_history_s, {0.01, 5}, "age of the former view, quick things");
    v.number("long_history_s", long_history_s, {0.01, 10}, "age of the former view, slow things");
    v.number("memory_s", memory_s, {0, 60}, "age of views that tell what somebody hid");
    v.number("tolerance_m", tolerance_m, {0.01, 1}, "of depth between two views");
    v.number("tolerance_per_m2", tolerance_per_m2, {0, 0.2}, "added, times the squared depth");
    v.number("min_moving_area_m2", min_moving_area_m2, {0, 1}, "smaller changes are noise");
    v.number("grow_m", grow_m, {0, 2}, "from what changed to the rest of the body");
    v.number("max_speed_m_s", max_speed_m_s, {0.1, 20}, "of what moves");
    v.number("max_moving_share", max_moving_share, {0.01, 1},
             "more of the view moving means that the motion is wrong");
    v.number("min_share_on_moving", min_share_on_moving, {0, 1}, "of a detection, to refuse it");
    v.number("sensor_reach_m", sensor_reach_m, {0.5, 50}, "where depth ends");
    v.number("border_reach", border_reach, {0.1, 1}, "share of the reach around a pane");
    v.number("min_border_share", min_border_share, {0, 1}, "of a pane's outline with such depth");
    v.number("min_pane_share", min_pane_share, {0, 1}, "of the image; smaller holes are no panes");
    v.number("min_share_on_reflective", min_share_on_reflective, {0, 1},
             "of a detection, to refuse it");
  }
};

/// The image in square cells: what of it moves and what mirrors.
struct Segmentation {
  enum Label : std::uint8_t { kStatic = 0, kMoving = 1, kReflective = 2 };
  int cell_px = 0;
  int columns = 0;
  int rows = 0;
  std::vector<std::uint8_t> labels;  ///< row by row; empty: nothing is known
  std::vector<float> near_m;         ///< nearest depth in each cell; 0 = not measured

  bool empty() const { return labels.empty(); }
  bool contains(const Eigen::Vector2d& p_px) const { return cellOf(p_px).has_value(); }
  /// Of the cell of a pixel; kStatic outside the image.
  Label at(const Eigen::Vector2d& p_px) const;
  /// Nearest depth in the cell of a pixel, metres; 0 = not measured.
  float nearestAt(const Eigen::Vector2d& p_px) const;
  std::size_t count(Label label) const;

 private:
  std::optional<std::size_t> cellOf(const Eigen::Vector2d& p_px) const;
};

/// Keeps the depth of the last seconds and tells, frame by frame, what does not fit a static world
/// and which holes in the depth are panes or mirrors.
///
/// Moving: a surface where a former view looked through free space, or the place of a surface that
/// the present view looks through, if what is seen behind may be the same thing farther off and is
/// not known as a part of the room that it no longer hides. Both
/// need depth in both views: people beyond the sensor's reach are not seen.
/// Reflective: an area without depth whose outline is a surface well within the sensor's reach; so
/// a way out into the distance is none.
class Segmenter {
 public:
  explicit Segmenter(const SegmentationOptions& options = {});
  ~Segmenter();
  Segmenter(Segmenter&&) noexcept;
  Segmenter& operator=(Segmenter&&) noexcept;

  /// T_previous_robot: how the robot moved since the frame given before; nothing when it is not
  /// known, which forgets the former views. Empty without depth.
  Segmentation segment(const Frame& frame, const std::optional<Pose2>& T_previous_robot);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Refuses, with the reasons `moving` and `reflective`, accepted detections that lie there.
void refuseSegmented(const Frame& frame, const Segmentation& segmentation,
                     const SegmentationOptions& options, Detections& detections);

}  // namespace colonnade
