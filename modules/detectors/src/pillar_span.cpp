// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "pillar_span.hpp"

#include <algorithm>
#include <cmath>

#include "colonnade/detectors/depth_noise.hpp"
#include "nearest_pixel.hpp"
#include "statistics.hpp"

namespace colonnade {
namespace {

constexpr int kPause_px = 4;             // past the end: an edge may fade a little early
constexpr int kBeside_px = 5;            // from the edge, clear of displaced depth
constexpr int kLeastRows = 6;            // that tell
constexpr int kBorder_px = 6;            // an edge that comes so near leaves the picture
constexpr double kLeastGap_m = 0.12;     // of height without the edge
constexpr double kLastStretch_m = 0.05;  // before the floor or the head: an edge reaches it or ends
constexpr double kGapRows = 14.0;        // at least, or kLastStretch_m, without an edge
constexpr double kEnd_px = 6.0;          // by which a line may end too early
constexpr double kTallFade_m = 1.0;      // of an edge whose contrast may fade before it ends,
constexpr double kLowFade_m = 0.9;       // and of one that comes down so far that
constexpr double kBoard_m = 0.8;         // no board hangs there
constexpr double kFadePart = 0.2;        // of the seen edge, at its end and before that
constexpr double kFaded = 0.6, kFading = 0.85;  // of its strongest part, there and before that
constexpr double kFaintest = 20.0;              // gray levels: where lines cease to be found
constexpr double kHeadDoubt_m = 0.2;            // of min_head_m, to call an edge tall
constexpr double kFar_m = 1e3;
constexpr double kLeastContrast = 4.5;  // gray levels, median: more than noise and shades leave
constexpr double kLeastShare = 0.15;    // of its own contrast that an edge keeps where it goes on

std::size_t rowsBetween(double top, double bottom) {
  return bottom >= top ? static_cast<std::size_t>(bottom - top) + 1 : 0;
}

struct Evidence {
  int seen = 0;
  int ended = 0;
  std::vector<int> contrasts;  ///< by row, gray levels in the sense of the edge

  /// may_turn: before a skirting board the contrast may turn about and become weaker, and the
  /// corner is still there.
  bool endedWithoutTrace(int own_contrast, bool may_turn) && {
    if (seen < kLeastRows || 5 * ended <= 3 * seen) return false;
    const int median = medianOf(contrasts);
    return may_turn ? std::abs(median) < kLeastContrast
                    : median < std::max(kLeastContrast, kLeastShare * own_contrast);
  }
};

/// Gray levels across the line in the sense of its gradient.
std::optional<int> contrastAt(const cv::Mat& gray, const RefinedLine& line, double v) {
  const int u = roundToInt(line.across(v)), row = static_cast<int>(v);
  if (u < 3 || u + 3 >= gray.cols || row < 0 || row >= gray.rows) return std::nullopt;
  const auto* p = gray.ptr<unsigned char>(row);
  return line.gradient_sign * (p[u + 2] - p[u - 2]);
}

/// What lies beyond the ends of a line of known range.
class Beyond {
 public:
  explicit Beyond(const UprightEdge& edge)
      : gray_(edge.gray),
        depth_(edge.depth),
        camera_(edge.camera),
        line_(edge.line),
        range_m_(*edge.range_m),
        one_sided_(edge.one_sided),
        tolerance_m_(edge.options.surface_step_m + 3.0 * kinectDepthSigma(range_m_)),
        in_reach_(range_m_ + tolerance_m_ < edge.reach_m) {}

  double heightAt(double v) const {
    const Eigen::Vector3d ray = camera_.ray(line_.at(v));
    return camera_.height() + range_m_ * ray.z() / ray.head<2>().norm();
  }

  /// The row at a height, as far as the picture goes.
  double rowAt(double height_m) const {
    double v = line_.begin;
    for (int i = 0; i < 3; ++i) {  // the line is nearly upright
      const double per_row = heightAt(v + 1.0) - heightAt(v);
      v = std::clamp(v + (height_m - heightAt(v)) / per_row, 2.0, gray_.rows - 3.0);
    }
    return v;
  }
  /// Is there a stretch in which neither depth nor the image shows the edge?
  bool hasGap(double top, double bottom, int own_contrast, bool may_turn) const {
    const double row_m = heightAt(top) - heightAt(top + 1.0);
    const double stretch = std::max(kGapRows, kLastStretch_m / row_m);
    if (between(top, bottom).endedWithoutTrace(own_contrast, may_turn)) return true;
    for (double v = top; v + stretch <= bottom; v += 0.5 * stretch)
      if (between(v, v + stretch).endedWithoutTrace(own_contrast, may_turn)) return true;
    return bottom - top > stretch &&
           between(bottom - stretch, bottom).endedWithoutTrace(own_contrast, may_turn);
  }
  /// Has the contrast of a tall edge become weaker and weaker towards an end (way: 1 down, -1 up)
  /// until it was too faint to be seen, as where the light on its two sides becomes the same?
  /// Boards, panels and cabinets end at once.
  bool fadesTowards(const SeenSpan& span, int way) const {
    const double foot_m = heightAt(span.bottom), seen_m = heightAt(span.top) - foot_m;
    if (seen_m < (foot_m < kBoard_m ? kLowFade_m : kTallFade_m)) return false;
    const double end = way > 0 ? span.bottom : span.top;
    const double part = kFadePart * (span.bottom - span.top);
    const auto contrastWithin = [&](double from, double to) {
      std::vector<int> contrasts;
      for (double i = from; i < to; i += 1.0)
        if (const auto contrast = contrastAt(gray_, line_, end - way * i))
          contrasts.push_back(*contrast);
      return medianOf(contrasts);
    };
    int strongest = 0;
    for (int i = 0; i * kFadePart < 1.0 - 1e-9; ++i)
      strongest = std::max(strongest, contrastWithin(i * part, (i + 1) * part));
    const int last = contrastWithin(kEnd_px, kEnd_px + part);
    return last < std::min(kFaded * strongest, kFaintest) &&
           contrastWithin(kEnd_px + part, kEnd_px + 2.0 * part) < kFading * strongest;
  }
  Evidence between(double top, double bottom) const {
    const double first = std::max(top, 2.0), last = std::min(bottom, gray_.rows - 3.0);
    Evidence evidence;
    evidence.contrasts.reserve(rowsBetween(first, last));
    for (double v = first; v <= last; v += 1.0) addRow(v, evidence);
    return evidence;
  }

 private:
  void addRow(double v, Evidence& evidence) const {
    const auto contrast = contrastAt(gray_, line_, v);
    if (!contrast) return;
    const Pixel here{roundToInt(line_.across(v)), roundToInt(v)};
    const auto left = depth_.rangeAt(here.u - kBeside_px, here.v);
    const auto right = depth_.rangeAt(here.u + kBeside_px, here.v);
    // Where depth is missing on both sides, or beyond its reach, the contrast alone tells.
    const double left_m = left.value_or(kFar_m), right_m = right.value_or(kFar_m);
    const double nearer = std::min(left_m, right_m), farther = std::max(left_m, right_m);
    if (nearer < range_m_ - tolerance_m_) return;  // hidden
    const bool near_side = nearer < range_m_ + tolerance_m_;
    // What has no depth behind the edge elsewhere says nothing here either.
    if (one_sided_ && in_reach_ && near_side && farther == kFar_m) return;
    ++evidence.seen;
    evidence.contrasts.push_back(*contrast);
    const bool step_goes_on = near_side && (farther < kFar_m || in_reach_) &&
                              farther > range_m_ + 2.0 * tolerance_m_ &&
                              !isOnePlane(here, left_m, right_m);
    evidence.ended += step_goes_on ? 0 : 1;
  }

  /// A wall that is seen at a grazing angle has other ranges left and right too. Along a row 1 /
  /// range of a vertical plane is linear, and so the sides foretell the difference between them.
  bool isOnePlane(const Pixel& here, double left_m, double right_m) const {
    const auto left = depth_.rangeAt(here.u - 2 * kBeside_px, here.v);
    const auto right = depth_.rangeAt(here.u + 2 * kBeside_px, here.v);
    if (!left || !right) return false;
    const double foretold = 1.0 / left_m - 1.0 / *left + 1.0 / *right - 1.0 / right_m;
    const double step = 1.0 / right_m - 1.0 / left_m - foretold;
    return std::abs(step) * range_m_ * range_m_ < tolerance_m_;
  }

  const cv::Mat& gray_;
  const DepthView& depth_;
  const LevelledCamera& camera_;
  const RefinedLine& line_;
  double range_m_;
  bool one_sided_;
  double tolerance_m_;
  bool in_reach_;
};

/// What lies beyond the ends of a line without a range.
class BeyondUnranged {
 public:
  explicit BeyondUnranged(const UprightEdge& edge)
      : gray_(edge.gray), depth_(edge.depth), line_(edge.line), contrast_(edge.contrast) {}

  Evidence between(double top, double bottom) const {
    Evidence evidence;
    evidence.contrasts.reserve(rowsBetween(top, bottom));
    for (double v = top; v <= bottom; v += 1.0)
      if (const auto contrast = contrastAt(gray_, line_, v))
        evidence.contrasts.push_back(*contrast);
    evidence.seen = evidence.ended = static_cast<int>(evidence.contrasts.size());
    return evidence;
  }
  /// From an end (excluded) on, a part of the picture's height: has the contrast gone?
  bool endedWithoutTrace(double from, int step) const {
    const double first = from + step * kPause_px, last = first + step * gray_.rows / 10.0;
    return between(std::min(first, last), std::max(first, last)).endedWithoutTrace(contrast_, true);
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
  int contrast_;
};

/// Does depth beside most of a line not show a surface at this range? Where depth is missing it
/// does not.
bool isElsewhere(const DepthView& depth, const RefinedLine& line, double range_m) {
  constexpr int kPlaces = 8;
  constexpr int kElsewhere_px = 5;
  const double tolerance_m = 0.1 + 3.0 * kinectDepthSigma(range_m);
  int here = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const double v = line.begin + (line.end - line.begin) * (i + 0.5) / kPlaces;
    const int u = roundToInt(line.across(v)), row = roundToInt(v);
    const auto left = depth.rangeAt(u - kElsewhere_px, row);
    const auto right = depth.rangeAt(u + kElsewhere_px, row);
    if (!left && !right) continue;  // nothing where depth reaches
    const double nearer = std::min(left ? *left : *right, right ? *right : *left);
    here += std::abs(nearer - range_m) < tolerance_m ? 1 : 0;
  }
  return 2 * here < kPlaces;
}

/// What continues a line, in the order of their upper ends.
RefinedLines piecesOf(const UprightEdge& edge, const RefinedLines& lines) {
  const RefinedLine& line = edge.line;
  const auto& range_m = edge.range_m;
  constexpr double kAside_px = 2.5;
  constexpr double kBelowFloor_m = 0.15;
  RefinedLines pieces;
  for (const auto& other : lines) {
    if (!other.steep || other.gradient_sign != line.gradient_sign) continue;
    const auto apart = [&](double s) { return std::abs(other.across(s) - line.across(s)); };
    if (std::max(apart(other.begin), apart(other.end)) > kAside_px) continue;
    const Eigen::Vector3d lowest = edge.camera.ray(line.at(other.end));
    if (range_m &&
        edge.camera.height() + *range_m * lowest.z() / lowest.head<2>().norm() < -kBelowFloor_m)
      continue;
    if (range_m && isElsewhere(edge.depth, other, *range_m)) continue;
    pieces.push_back(other);
  }
  std::sort(pieces.begin(), pieces.end(),
            [](const auto& a, const auto& b) { return a.begin < b.begin; });
  return pieces;
}

bool leavesAbove(const SeenSpan& span) { return span.top < kBorder_px; }
bool leavesBelow(const UprightEdge& edge, const SeenSpan& span) {
  return span.bottom > edge.gray.rows - 1 - kBorder_px;
}

std::string reasonAgainstUnranged(const UprightEdge& edge, const SeenSpan& span) {
  const PillarOptions& options = edge.options;
  const double height_m = edge.camera.height();
  const auto elevation = [&](double v) {
    const Eigen::Vector3d ray = edge.camera.ray(edge.line.at(v));
    return ray.z() / ray.head<2>().norm();
  };
  if (!leavesAbove(span) && elevation(span.top) < 0.0 && options.min_head_m > height_m)
    return "ends below the horizon";
  if (!leavesBelow(edge, span) && elevation(span.bottom) > 0.0 && options.max_foot_m < height_m)
    return "ends above the horizon";
  if (leavesBelow(edge, span)) return "";
  const BeyondUnranged beyond(edge);
  if (beyond.standsOnNoFloor(span.bottom, options.max_foot_m) &&
      beyond.endedWithoutTrace(span.bottom, 1))
    return "ends above the floor";
  // If the lower end is on the floor, that says how far it is, and so how tall; if it is hidden
  // or above the floor, the edge is taken for farther and taller than it is.
  const double foot = elevation(span.bottom), head = elevation(span.top);
  if (!leavesAbove(span) && foot < 0.0 && height_m * (1.0 - head / foot) < options.min_head_m &&
      beyond.endedWithoutTrace(span.top, -1))
    return "too low for a part of the building";
  return "";
}

}  // namespace

int contrastOf(const cv::Mat& gray, const RefinedLine& line) {
  std::vector<int> contrasts;
  contrasts.reserve(rowsBetween(line.begin, line.end));
  for (double v = line.begin; v <= line.end; v += 1.0)
    if (const auto contrast = contrastAt(gray, line, v)) contrasts.push_back(*contrast);
  return medianByCounting<-255, 255>(contrasts);
}

SeenSpan seenSpan(const UprightEdge& edge, const RefinedLines& lines) {
  const auto isGap = [&](double top, double bottom) {
    const double from = top + kPause_px, to = bottom - kPause_px;
    return (edge.range_m ? Beyond(edge).between(from, to) : BeyondUnranged(edge).between(from, to))
        .endedWithoutTrace(edge.contrast, false);
  };
  const RefinedLine& line = edge.line;
  const RefinedLines pieces = piecesOf(edge, lines);
  SeenSpan span{line.begin, line.end};
  for (const auto& piece : pieces) {
    if (piece.end <= span.bottom || piece.begin < line.begin) continue;
    if (isGap(span.bottom, piece.begin)) break;
    span.bottom = piece.end;
  }
  for (auto piece = pieces.rbegin(); piece != pieces.rend(); ++piece) {
    if (piece->begin >= span.top || piece->end > line.end) continue;
    if (isGap(piece->end, span.top)) break;
    span.top = piece->begin;
  }
  return span;
}

bool hasGapInside(const UprightEdge& edge, const SeenSpan& span) {
  return Beyond(edge).hasGap(span.top + kPause_px, span.bottom - kPause_px, edge.contrast, false);
}

SpanVerdict judgeSpan(const UprightEdge& edge, const SeenSpan& span) {
  if (!edge.range_m) return {reasonAgainstUnranged(edge, span)};
  const Beyond beyond(edge);
  const PillarOptions& options = edge.options;
  const double foot_m = beyond.heightAt(span.bottom), head_m = beyond.heightAt(span.top);
  const double row_m = beyond.heightAt(span.bottom) - beyond.heightAt(span.bottom + 1.0);
  const double highest_foot_m = options.max_foot_m + kEnd_px * row_m;
  const auto fades = [&](int way) { return edge.may_fade && beyond.fadesTowards(span, way); };
  if (!leavesBelow(edge, span) && foot_m > highest_foot_m) {
    const double from = span.bottom + kPause_px;
    const bool may_turn = foot_m < 2.0 * options.max_foot_m;
    const double until_m = std::min(0.5 * options.max_foot_m, foot_m - kLeastGap_m);
    const bool ends =
        beyond.between(from, beyond.rowAt(until_m)).endedWithoutTrace(edge.contrast, may_turn) ||
        beyond.hasGap(from, beyond.rowAt(highest_foot_m), edge.contrast, may_turn);
    if (ends && !fades(1)) return {"ends above the floor"};
  }
  if (!leavesAbove(span) && head_m < options.min_head_m) {
    const double from = span.top - kPause_px;
    const double until = beyond.rowAt(std::max(options.min_head_m, head_m + kLeastGap_m));
    if (beyond.hasGap(until, from, edge.contrast, false) && !fades(-1))
      return {"too low for a part of the building", UprightHeight::kLow};
  }
  const bool tall = head_m > options.min_head_m - kHeadDoubt_m;
  return {"", tall ? UprightHeight::kTall : UprightHeight::kUnknown};
}

}  // namespace colonnade
