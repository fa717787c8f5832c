// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "pillar_span.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "colonnade/detectors/depth_noise.hpp"
#include "statistics.hpp"

namespace colonnade {
namespace {

constexpr int kPause_px = 4;            // past the end: an edge may fade a little early
constexpr int kBeside_px = 5;           // from the edge, clear of displaced depth
constexpr int kLeastRows = 6;           // that tell
constexpr int kBorder_px = 6;           // an edge that comes so near leaves the picture
constexpr double kLeastGap_m = 0.12;    // of height without the edge
constexpr double kLeastContrast = 4.5;  // gray levels, median: more than noise and shades leave
constexpr double kLeastShare = 0.15;    // of its own contrast that an edge keeps where it goes on

struct Evidence {
  int seen = 0;
  int ended = 0;
  /// By row, gray levels in the sense of the edge. Before a skirting board it may turn about: the
  /// corner is still there.
  std::vector<int> contrasts;

  bool endedWithoutTrace(int own_contrast) {
    return seen >= kLeastRows && 4 * ended > 3 * seen &&
           std::abs(medianOf(contrasts)) < std::max(kLeastContrast, kLeastShare * own_contrast);
  }
};

class Beyond {
 public:
  Beyond(const cv::Mat& gray, const DepthView& depth, const LevelledCamera& camera,
         const RefinedLine& line, double range_m, const PillarOptions& options)
      : gray_(gray),
        depth_(depth),
        camera_(camera),
        line_(line),
        range_m_(range_m),
        tolerance_m_(options.surface_step_m + 3.0 * kinectDepthSigma(range_m)) {}

  double heightAt(double v) const {
    const Eigen::Vector3d ray = camera_.ray(line_.at(v));
    return camera_.height() + range_m_ * ray.z() / ray.head<2>().norm();
  }

  /// Median over the seen part of the line, gray levels.
  int ownContrast() const {
    Evidence evidence;
    for (double v = line_.begin; v <= line_.end; v += 1.0) addContrast(v, evidence);
    return medianOf(evidence.contrasts);
  }

  /// Rows from `from` (excluded) on, one by one, while `goesOn` and the picture lasts.
  template <class GoesOn>
  Evidence look(double from, int step, GoesOn goesOn) const {
    Evidence evidence;
    for (double v = from + step * kPause_px; v > 1.0 && v < gray_.rows - 2.0; v += step) {
      if (!goesOn(heightAt(v))) break;
      addRow(v, evidence);
    }
    return evidence;
  }

 private:
  bool addContrast(double v, Evidence& evidence) const {
    const auto u = static_cast<int>(std::lround(line_.across(v))), row = static_cast<int>(v);
    if (u < 3 || u + 3 >= gray_.cols || row < 0 || row >= gray_.rows) return false;
    const auto* p = gray_.ptr<unsigned char>(row);
    evidence.contrasts.push_back(line_.gradient_sign * (p[u + 2] - p[u - 2]));
    return true;
  }

  void addRow(double v, Evidence& evidence) const {
    if (!addContrast(v, evidence)) return;
    const Eigen::Vector2d here = line_.at(v);
    const Eigen::Vector2d aside(kBeside_px, 0.0);
    const auto left = depth_.at(here - aside), right = depth_.at(here + aside);
    if (!left || !right) return;
    const double nearer = std::min(left->range_m, right->range_m);
    const double farther = std::max(left->range_m, right->range_m);
    if (nearer < range_m_ - tolerance_m_) return;  // hidden
    ++evidence.seen;
    const bool step_goes_on =
        nearer < range_m_ + tolerance_m_ && farther > range_m_ + 2.0 * tolerance_m_;
    evidence.ended += step_goes_on ? 0 : 1;
  }

  const cv::Mat& gray_;
  const DepthView& depth_;
  const LevelledCamera& camera_;
  const RefinedLine& line_;
  double range_m_;
  double tolerance_m_;
};

}  // namespace

std::string reasonAgainstSpan(const cv::Mat& gray, const DepthView& depth,
                              const LevelledCamera& camera, const RefinedLine& line,
                              const SeenSpan& span, std::optional<double> range_m,
                              const PillarOptions& options) {
  const auto elevation = [&](double v) {
    const Eigen::Vector3d ray = camera.ray(line.at(v));
    return ray.z() / ray.head<2>().norm();
  };
  const bool leaves_above = span.top < kBorder_px;
  const bool leaves_below = span.bottom > gray.rows - 1 - kBorder_px;
  if (!range_m) {
    if (!leaves_above && elevation(span.top) < 0.0 && options.min_head_m > camera.height())
      return "ends below the horizon";
    if (!leaves_below && elevation(span.bottom) > 0.0 && options.max_foot_m < camera.height())
      return "ends above the horizon";
    return "";
  }
  const Beyond beyond(gray, depth, camera, line, *range_m, options);
  const double foot_m = beyond.heightAt(span.bottom), head_m = beyond.heightAt(span.top);
  if (!leaves_below && foot_m > options.max_foot_m) {
    const double until_m = std::min(0.5 * options.max_foot_m, foot_m - kLeastGap_m);
    if (beyond.look(span.bottom, 1, [&](double h) { return h > until_m; })
            .endedWithoutTrace(beyond.ownContrast()))
      return "ends above the floor";
  }
  if (!leaves_above && head_m < options.min_head_m) {
    const double until_m = std::max(options.min_head_m, head_m + kLeastGap_m);
    if (beyond.look(span.top, -1, [&](double h) { return h < until_m; })
            .endedWithoutTrace(beyond.ownContrast()))
      return "too low for a part of the building";
  }
  return "";
}

bool isShade(const cv::Mat& gray, const RefinedLine& line) {
  constexpr int kReach_px = 7;
  constexpr int kWide_px = 6;  // of the steep part; a sharp edge has 3 or 4
  std::array<double, 2 * kReach_px + 1> profile{};
  for (double v = line.begin; v <= line.end; v += 1.0) {
    const auto u = static_cast<int>(std::lround(line.across(v))), row = static_cast<int>(v);
    if (u < kReach_px || u + kReach_px >= gray.cols || row < 0 || row >= gray.rows) continue;
    const auto* p = gray.ptr<unsigned char>(row) + u - kReach_px;
    for (std::size_t k = 0; k < profile.size(); ++k) profile[k] += p[k];
  }
  const auto steepness = [&](int k) {
    const auto i = static_cast<std::size_t>(k + kReach_px);
    return line.gradient_sign * (profile[i + 1] - profile[i - 1]);
  };
  int wide = 1;
  for (const int way : {-1, 1})
    for (int k = way; std::abs(k) < kReach_px && steepness(k) > 0.5 * steepness(0); k += way)
      ++wide;
  return wide >= kWide_px;
}

}  // namespace colonnade
