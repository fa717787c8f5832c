// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "path_map.hpp"

#include <algorithm>
#include <cmath>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"
#include "line_plot.hpp"

namespace colonnade {

PathMap::PathMap(const PathMapOptions& options) : options_(options) {
  const bool pinhole = options_.model == "pinhole";
  const bool calibrated = pinhole ? options_.pinhole_px_m > 0.0 && options_.focal_px > 0.0
                                  : options_.at_zero_px > 0.0 && options_.decades_per_m > 0.0 &&
                                        options_.slope_m_per_px != 0.0;
  if (!calibrated)
    throw Error("path map: [PathMap] has no calibration of the model " + options_.model +
                    (pinhole ? " (pinhole_px_m, focal_px)"
                             : " (at_zero_px, decades_per_m, slope_m_per_px)") +
                    "; colonnade calibrate -o writes one",
                ExitCode::kUsage);
}

void PathMap::add(const Frame& frame, const std::optional<PillarPlace>& pillar) {
  if (pillar && pillar->delta_rho_px && *pillar->delta_rho_px > 0.0) {
    Point point{frame.stamp_s, frame.index, 0.0, 0.0};
    const double left_px = *pillar->left_rho_px;
    if (options_.model == "pinhole") {
      point.distance_m = PinholeFit{options_.pinhole_px_m}.distance(*pillar->delta_rho_px);
      point.shift_m =
          ObliqueFit{options_.focal_px, options_.centre_px}.lateral(left_px, point.distance_m);
    } else {
      point.distance_m = ExponentialFit{options_.at_zero_px, options_.decades_per_m}.distance(
          *pillar->delta_rho_px);
      point.shift_m = LinearFit{options_.slope_m_per_px, options_.offset_m}.lateral(left_px);
    }
    period_.push_back(point);
  }
  if (++frames_in_period_ >= options_.period_frames) closePeriod();
}

void PathMap::finish() {
  if (frames_in_period_ > 1) closePeriod();
}

void PathMap::closePeriod() {
  frames_in_period_ = 0;
  if (period_.empty()) return;
  const Point first = period_.front();
  const Point last = period_.back();
  double sum = 0.0;
  int count = 0;
  for (const Point& point : period_) {
    if (std::abs(point.distance_m - first.distance_m) > options_.tolerance_m) continue;
    sum += point.distance_m;
    ++count;
  }
  if (path_.empty()) path_.push_back({first.stamp_s, first.frame, first.shift_m, sum / count});
  // Within the tolerance there was no change of distance, and its mean says more than one frame.
  const bool moved = std::abs(last.distance_m - first.distance_m) > options_.tolerance_m;
  path_.push_back({last.stamp_s, last.frame, last.shift_m, moved ? last.distance_m : sum / count});
  period_.clear();
}

void PathMap::write(const std::filesystem::path& folder) const {
  std::string table = "stamp,frame,shift_m,distance_m\n";
  PlotSeries path{"camera", cv::Scalar(180, 90, 20), {}};
  PlotSeries start{"start", cv::Scalar(60, 160, 60), {}, true};
  for (const Point& point : path_) {
    table += formatFixed(point.stamp_s, 6) + "," + std::to_string(point.frame) + "," +
             formatFixed(point.shift_m, 4) + "," + formatFixed(point.distance_m, 4) + "\n";
    path.points.emplace_back(point.shift_m, -point.distance_m);
  }
  writeFileAtomically(folder / "path_map.csv", table);
  if (path_.empty()) return;
  start.points.push_back(path.points.front());
  LinePlot plot{"Path of the camera before the pillar",
                "shift to the right of its left edge, m",
                "behind it, m",
                true,
                {},
                {}};
  plot.series = {path, start, {"pillar", cv::Scalar(40, 40, 220), {{0.0, 0.0}}, true}};
  writePlot(folder / "path_map.png", plot);
}

}  // namespace colonnade
