// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/segmentation.hpp"

#include <algorithm>
#include <deque>

#include "background.hpp"
#include "depth_cells.hpp"
#include "moving_cells.hpp"
#include "reflective_cells.hpp"

namespace colonnade {

std::optional<std::size_t> Segmentation::cellOf(const Eigen::Vector2d& p_px) const {
  if (empty() || !p_px.allFinite()) return std::nullopt;
  const Eigen::Vector2d cell = (p_px.array() + 0.5) / cell_px;
  if (cell.minCoeff() < 0.0 || cell.x() >= columns || cell.y() >= rows) return std::nullopt;
  return static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(columns) +
         static_cast<std::size_t>(cell.x());
}

Segmentation::Label Segmentation::at(const Eigen::Vector2d& p_px) const {
  const auto cell = cellOf(p_px);
  return cell ? static_cast<Label>(labels[*cell]) : kStatic;
}

float Segmentation::nearestAt(const Eigen::Vector2d& p_px) const {
  const auto cell = cellOf(p_px);
  return cell ? near_m[*cell] : 0.0F;
}

std::size_t Segmentation::count(Label label) const {
  return static_cast<std::size_t>(
      std::count(labels.begin(), labels.end(), static_cast<std::uint8_t>(label)));
}

struct Segmenter::Impl {
  SegmentationOptions options;
  std::deque<DepthGlimpse> views;  ///< oldest first
  std::deque<DepthGlimpse> older;  ///< than those, and less frequent
  Pose2 T_world_robot;             ///< in a world of its own

  /// The youngest view that is at least so old, up to twice that and some.
  const DepthGlimpse* viewOfAge(double age_s, double now_s) const {
    constexpr double kSlack_s = 0.02;
    for (auto view = views.rbegin(); view != views.rend(); ++view) {
      const double age = now_s - view->stamp_s;
      if (age >= age_s - kSlack_s) return age <= 2.0 * age_s + 0.2 ? &*view : nullptr;
    }
    return nullptr;
  }

  /// Empty where it cannot be told.
  std::vector<std::uint8_t> moving(const DepthGlimpse& now, const Frame& frame) {
    std::vector<std::uint8_t> marks(now.cells.near_m.size(), 0);
    // After a gap in the depth a view may be older than anything it can testify to.
    const double oldest_s = now.stamp_s - std::max(options.memory_s, 2.0 * options.long_history_s);
    std::vector<const DepthGlimpse*> all;
    for (const auto* list : {&older, &views})
      for (const DepthGlimpse& view : *list)
        if (view.stamp_s >= oldest_s) all.push_back(&view);
    Background background(now, std::move(all), options);
    const DepthGlimpse* last = nullptr;
    for (const double age_s : {options.short_history_s, options.long_history_s}) {
      const DepthGlimpse* const former = viewOfAge(age_s, now.stamp_s);
      if (!former || former == last) continue;
      last = former;
      if (!markMoving(now, *former, background, options, marks)) {
        forget();
        return {};
      }
    }
    if (!last) return {};
    completeMoving(now, frame, background, options, marks);
    return marks;
  }

  void forget() {
    views.clear();
    older.clear();
  }

  void remember(DepthGlimpse&& now) {
    const double oldest_s = now.stamp_s - options.long_history_s - 0.02;
    // One view older than the longest history stays: it is the one of that age.
    while (views.size() > 1 && views[1].stamp_s <= oldest_s) {
      if (older.empty() || views[0].stamp_s >= older.back().stamp_s + options.short_history_s)
        older.push_back(std::move(views[0]));
      views.pop_front();
    }
    while (!older.empty() && older[0].stamp_s < now.stamp_s - options.memory_s) older.pop_front();
    views.push_back(std::move(now));
  }
};

Segmenter::Segmenter(const SegmentationOptions& options) : impl_(std::make_unique<Impl>()) {
  impl_->options = options;
}
Segmenter::~Segmenter() = default;
Segmenter::Segmenter(Segmenter&&) noexcept = default;
Segmenter& Segmenter::operator=(Segmenter&&) noexcept = default;

Segmentation Segmenter::segment(const Frame& frame, const std::optional<Pose2>& T_previous_robot) {
  auto& [options, views, older, T_world_robot] = *impl_;
  if (!T_previous_robot || (!views.empty() && frame.stamp_s <= views.back().stamp_s))
    impl_->forget();
  if (T_previous_robot) T_world_robot = T_world_robot * *T_previous_robot;
  Segmentation result;
  if (!(options.moving || options.reflective) || !frame.camera.isCalibrated()) return result;
  DepthGlimpse now{frame.stamp_s,
                   T_world_robot.toIsometry3() * frame.T_robot_camera,
                   makeDepthCells(frame),
                   {},
                   {}};
  if (now.cells.empty()) return result;
  result.cell_px = now.cells.cell_px;
  result.columns = now.cells.columns;
  result.rows = now.cells.rows;
  result.near_m = now.cells.near_m;
  result.labels.assign(result.near_m.size(), Segmentation::kStatic);
  if (options.reflective) {
    const auto marks = reflectiveCells(now.cells, options);
    for (std::size_t i = 0; i < marks.size(); ++i)
      if (marks[i]) result.labels[i] = Segmentation::kReflective;
  }
  if (options.moving) {
    now.moving = impl_->moving(now, frame);
    for (std::size_t i = 0; i < now.moving.size(); ++i)
      if (now.moving[i]) result.labels[i] = Segmentation::kMoving;
    now.walls = wallLines(now, options);
    impl_->remember(std::move(now));
  }
  return result;
}

}  // namespace colonnade
