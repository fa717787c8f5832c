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

constexpr int kPause_px = 4;          // past the end: an edge may fade a little early
constexpr int kBeside_px = 5;         // from the edge, clear of displaced depth
constexpr int kLeastRows = 6;         // that tell
constexpr int kBorder_px = 6;         // an edge that comes so near leaves the picture
constexpr double kLeastGap_m = 0.12;  // of height without the edge
constexpr double kFar_m = 1e3;
constexpr double kLeastContrast = 4.5;  // gray levels, median: more than noise and shades leave
constexpr double kLeastShare = 0.15;    // of its own contrast that an edge keeps where it goes on

struct Evidence {
  int seen = 0;
  int ended = 0;
  std::vector<int> contrasts;  ///< by row, gray levels in the sense of the edge

  /// may_turn: before a skirting board the contrast may turn about, and the corner is still there.
  bool endedWithoutTrace(int own_contrast, bool may_turn) {
    if (seen < kLeastRows || 5 * ended <= 3 * seen) return false;
    const int left = medianOf(contrasts);
    return (may_turn ? std::abs(left) : left) <
           std::max(kLeastContrast, kLeastShare * own_contrast);
  }
};

/// Gray levels across the line in the sense of its gradient.
std::optional<int> contrastAt(const cv::Mat& gray, const RefinedLine& line, double v) {
  const auto u = static_cast<int>(std::lround(line.across(v))), row = static_cast<int>(v);
  if (u < 3 || u + 3 >= gray.cols || row < 0 || row >= gray.rows) return std::nullopt;
  const auto* p = gray.ptr<unsigned char>(row);
  return line.gradient_sign * (p[u + 2] - p[u - 2]);
}

/// The same, median over a line.
int ownContrast(const cv::Mat& gray, const RefinedLine& line) {
  std::vector<int> contrasts;
  for (double v = line.begin; v <= line.end; v += 1.0)
    if (const auto contrast = contrastAt(gray, line, v)) contrasts.push_back(*contrast);
  return medianOf(contrasts);
}

/// What lies beyond the ends of a line of known range.
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
  void addRow(double v, Evidence& evidence) const {
    const auto contrast = contrastAt(gray_, line_, v);
    if (!contrast) return;
    const Eigen::Vector2d here = line_.at(v);
    const Eigen::Vector2d aside(kBeside_px, 0.0);
    const auto left = depth_.at(here - aside), right = depth_.at(here + aside);
    // Where depth is missing there is nothing at the edge's own range, at which it measures.
    const double left_m = left ? left->range_m : kFar_m, right_m = right ? right->range_m : kFar_m;
    const double nearer = std::min(left_m, right_m), farther = std::max(left_m, right_m);
    if (nearer < range_m_ - tolerance_m_) return;  // hidden
    const bool near_side = nearer < range_m_ + tolerance_m_;
    if (near_side && farther == kFar_m) return;
    ++evidence.seen;
    evidence.contrasts.push_back(*contrast);
    const bool step_goes_on =
        near_side && farther > range_m_ + 2.0 * tolerance_m_ && !isOnePlane(here, left_m, right_m);
    evidence.ended += step_goes_on ? 0 : 1;
  }

  /// A wall that is seen at a grazing angle has other ranges left and right too. Along a row 1 /
  /// range of a vertical plane is linear, and so the sides foretell the difference between them.
  bool isOnePlane(const Eigen::Vector2d& here, double left_m, double right_m) const {
    const Eigen::Vector2d aside(2.0 * kBeside_px, 0.0);
    const auto left = depth_.at(here - aside), right = depth_.at(here + aside);
    if (!left || !right) return false;
    const double foretold =
        1.0 / left_m - 1.0 / left->range_m + 1.0 / right->range_m - 1.0 / right_m;
    const double step = 1.0 / right_m - 1.0 / left_m - foretold;
    return std::abs(step) * range_m_ * range_m_ < tolerance_m_;
  }

  const cv::Mat& gray_;
  const DepthView& depth_;
  const LevelledCamera& camera_;
  const RefinedLine& line_;
  double range_m_;
  double tolerance_m_;
};

/// What lies beyond the ends of a line without a range.
class BeyondUnranged {
 public:
  BeyondUnranged(const cv::Mat& gray, const DepthView& depth, const RefinedLine& line)
      : gray_(gray), depth_(depth), line_(line) {}

  /// From an end (excluded) on, a part of the picture's height: has the contrast gone?
  bool endedWithoutTrace(double from, int step) const {
    const int reach = gray_.rows / 10;
    Evidence evidence;
    for (int i = 0; i < reach; ++i)
      if (const auto contrast = contrastAt(gray_, line_, from + step * (kPause_px + i)))
        evidence.contrasts.push_back(*contrast);
    evidence.seen = evidence.ended = static_cast<int>(evidence.contrasts.size());
    return evidence.endedWithoutTrace(ownContrast(gray_, line_), true);
  }
  /// Does depth show something below this end that is higher than the floor?
  bool standsOnNoFloor(double end, double foot_m) const {
    constexpr int kLooked_px = 12;
    std::vector<double> heights_m;
    for (int i = 0; i < kLooked_px; ++i)
      if (const auto seen = depth_.at(line_.at(end + kPause_px + i)))
        heights_m.push_back(seen->height());
    return static_cast<int>(heights_m.size()) >= kLeastRows && medianOf(heights_m) > foot_m;
  }

 private:
  const cv::Mat& gray_;
  const DepthView& depth_;
  const RefinedLine& line_;
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
    if (leaves_below) return "";
    const BeyondUnranged beyond(gray, depth, line);
    if (beyond.standsOnNoFloor(span.bottom, options.max_foot_m) &&
        beyond.endedWithoutTrace(span.bottom, 1))
      return "ends above the floor";
    // If the lower end is on the floor, that says how far it is, and so how tall; if it is hidden
    // or above the floor, the edge is taken for farther and taller than it is.
    const double foot = elevation(span.bottom), head = elevation(span.top);
    if (!leaves_above && foot < 0.0 && camera.height() * (1.0 - head / foot) < options.min_head_m &&
        beyond.endedWithoutTrace(span.top, -1))
      return "too low for a part of the building";
    return "";
  }
  const Beyond beyond(gray, depth, camera, line, *range_m, options);
  const double foot_m = beyond.heightAt(span.bottom), head_m = beyond.heightAt(span.top);
  if (!leaves_below && foot_m > options.max_foot_m) {
    const double until_m = std::min(0.5 * options.max_foot_m, foot_m - kLeastGap_m);
    const bool may_turn = foot_m < 2.0 * options.max_foot_m;
    if (beyond.look(span.bottom, 1, [&](double h) { return h > until_m; })
            .endedWithoutTrace(ownContrast(gray, line), may_turn))
      return "ends above the floor";
  }
  if (!leaves_above && head_m < options.min_head_m) {
    const double until_m = std::max(options.min_head_m, head_m + kLeastGap_m);
    if (beyond.look(span.top, -1, [&](double h) { return h < until_m; })
            .endedWithoutTrace(ownContrast(gray, line), false))
      return "too low for a part of the building";
  }
  return "";
}

AcrossProfile::AcrossProfile(const cv::Mat& gray, const RefinedLine& line) {
  constexpr double kMostRows = 96.0;
  const double step = std::max(1.0, (line.end - line.begin) / kMostRows);
  int rows = 0;
  for (double v = line.begin; v <= line.end; v += step) {
    const auto u = static_cast<int>(std::lround(line.across(v))), row = static_cast<int>(v);
    if (row < 0 || row >= gray.rows) continue;
    if (u < 0 || u >= gray.cols) continue;
    const auto* p = gray.ptr<unsigned char>(row);
    for (int k = -kReach_px; k <= kReach_px; ++k)
      sums_[static_cast<std::size_t>(k + kReach_px)] += p[std::clamp(u + k, 0, gray.cols - 1)];
    ++rows;
  }
  for (auto& sum : sums_) sum *= line.gradient_sign / std::max(1.0, static_cast<double>(rows));
}

bool AcrossProfile::isShade() const {
  constexpr int kFar_px = 6;
  constexpr int kWide_px = 6;  // of the steep part; a sharp edge has 3 or 4
  const auto steepness = [&](int k) { return at(k + 1) - at(k - 1); };
  int wide = 1;
  for (const int way : {-1, 1})
    for (int k = way; std::abs(k) <= kFar_px && steepness(k) > 0.5 * steepness(0); k += way) ++wide;
  return wide >= kWide_px;
}

bool AcrossProfile::isThinLine(int width_px) const {
  constexpr int kEdge_px = 3;         // within which it has risen
  constexpr double kReturned = 0.35;  // of its step is what may be left of it
  double low = at(0), high = at(0);
  for (int k = 1; k <= kEdge_px; ++k) {
    low = std::min(low, at(-k));
    high = std::max(high, at(k));
  }
  const double rest = kReturned * (high - low);
  const int last = std::min(width_px, kReach_px - 1);
  for (int k = 2; k <= last; ++k) {
    if (0.5 * (at(k) + at(k + 1)) < low + rest) return true;
    if (0.5 * (at(-k) + at(-k - 1)) > high - rest) return true;
  }
  return false;
}

}  // namespace colonnade
