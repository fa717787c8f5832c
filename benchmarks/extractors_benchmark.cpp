// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// Line extractors on the same frames, and the whole stage against OpenCV's Canny and HoughLines:
//   benchmark_extractors LOG [--still N] [--every N]
// Accuracy where STEM_columns.csv lies beside LOG (simulated logs), repeatability over the first N
// frames, which a resting camera took. Prints a Markdown table.
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <map>
#include <memory>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/ximgproc/edge_drawing.hpp>
#include <opencv2/ximgproc/fast_line_detector.hpp>
#include <string>
#include <vector>

#include "colonnade/base/log_path.hpp"
#include "colonnade/base/memory.hpp"
#include "colonnade/detectors/detector_bank.hpp"
#include "colonnade/detectors/edge_view_of.hpp"
#include "colonnade/detectors/levelled_camera.hpp"
#include "colonnade/evaluation/detection_score.hpp"
#include "colonnade/frames/rawlog_source.hpp"
#include "colonnade/motion/motion_estimator.hpp"

namespace colonnade {
namespace {

/// Time this thread has had a processor for: other programs do not count.
double milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}
double millisecondsSince(double start) { return milliseconds() - start; }

constexpr double kLeastLength_px = 40.0;
constexpr double kFromVertical = radians(10.0);

using Segments = std::vector<ImageLine>;

Segments toSegments(const RefinedLines& lines) {
  Segments segments;
  for (const RefinedLine& line : lines)
    segments.push_back({LandmarkKind::kPillarEdge, line.at(line.begin), line.at(line.end), {}});
  return segments;
}

Segments toSegments(const std::vector<cv::Vec4f>& lines) {
  Segments segments;
  for (const cv::Vec4f& l : lines)
    segments.push_back(
        {LandmarkKind::kPillarEdge, Eigen::Vector2d(l[0], l[1]), Eigen::Vector2d(l[2], l[3]), {}});
  return segments;
}

/// Long lines along the projected vertical, from top to bottom.
Segments verticals(const Segments& all, const LevelledCamera& camera) {
  Segments kept;
  for (ImageLine line : all) {
    if (line.a_px.y() > line.b_px.y()) std::swap(line.a_px, line.b_px);
    const Eigen::Vector2d along = line.b_px - line.a_px;
    const Eigen::Vector2d down = camera.downDirection(0.5 * (line.a_px + line.b_px));
    if (along.norm() >= kLeastLength_px && along.normalized().dot(down) > std::cos(kFromVertical))
      kept.push_back(line);
  }
  return kept;
}

struct Extractor {
  std::string name;
  std::function<Segments(const Frame&)> extract;
  double total_ms = 0.0;
  std::size_t lines = 0;
  DetectionScore score{};
  Segments former{};
  std::size_t offered = 0, again = 0;
  double shift_squares = 0.0;

  /// How many of the former still frame's lines are there again, and how far they wander.
  void compare(const Segments& now) {
    for (const ImageLine& line : former) {
      ++offered;
      const Eigen::Vector2d middle = 0.5 * (line.a_px + line.b_px);
      double least = 1e9;
      for (const ImageLine& other : now) {
        const Eigen::Vector2d along = other.b_px - other.a_px;
        if (middle.y() < other.a_px.y() || middle.y() > other.b_px.y()) continue;
        const double u = other.a_px.x() + along.x() * (middle.y() - other.a_px.y()) / along.y();
        least = std::min(least, std::abs(u - middle.x()));
      }
      if (least > 1.5) continue;
      ++again;
      shift_squares += least * least;
    }
  }
};

std::vector<Extractor> extractors() {
  std::vector<Extractor> all;
  const EdgeOptions edge_options;
  for (const char* name : {"opencv", "fixed"}) {
    const std::shared_ptr<EdgeLineBackend> backend = makeEdgeLineBackend(name, edge_options);
    all.push_back({std::string(name) + " seeds, refined", [backend](const Frame& frame) {
                     const EdgeLines edges = backend->extract(frame.gray, edgeViewOf(frame));
                     return toSegments(refineLines(frame.gray, edges, {}));
                   }});
  }
  const auto drawing = cv::ximgproc::createEdgeDrawing();
  drawing->params.MinLineLength = static_cast<int>(kLeastLength_px);
  all.push_back({"EDLines", [drawing](const Frame& frame) {
                   std::vector<cv::Vec4f> lines;
                   drawing->detectEdges(frame.gray);
                   drawing->detectLines(lines);
                   return toSegments(lines);
                 }});
  for (const bool merge : {false, true}) {
    const auto fast = cv::ximgproc::createFastLineDetector(static_cast<int>(kLeastLength_px),
                                                           1.414213562F, 50.0, 50.0, 3, merge);
    all.push_back({merge ? "FLD, merged" : "FLD", [fast](const Frame& frame) {
                     std::vector<cv::Vec4f> lines;
                     fast->detect(frame.gray, lines);
                     return toSegments(lines);
                   }});
  }
  return all;
}

/// OpenCV's own way to the lines of all angles, with the thresholds of our reference.
double millisecondsOfOpencv(const cv::Mat& gray) {
  const EdgeOptions options;
  const auto start = milliseconds();
  cv::Mat edges;
  std::vector<cv::Vec2f> lines;
  cv::Canny(gray, edges, options.canny_low, options.canny_high);
  cv::HoughLines(edges, lines, 1.0, CV_PI / 180.0,
                 gray.rows * options.vertical_votes_percent / 100);
  return millisecondsSince(start);
}

int run(const std::string& log, std::size_t still, std::size_t every) {
  cv::setNumThreads(1);
  const std::filesystem::path columns = logStem(log).string() + "_columns.csv";
  TrueImageLines truth;
  if (std::filesystem::exists(columns)) truth = readColumnsCsv(columns);
  RawlogSource source(log, {});
  const MotionOptions motion_options;
  const auto tracker = std::make_shared<CameraTracker>(motion_options);
  MountingEstimator mounting(motion_options, tracker);
  MotionEstimator motion(motion_options, tracker);
  auto all = extractors();
  struct Stage {
    std::unique_ptr<EdgeLineBackend> backend;
    DetectorBank detectors{};
    double edges_ms = 0.0, detectors_ms = 0.0;
  };
  std::map<std::string, Stage> stages;
  for (const char* name : {"opencv", "fixed"}) stages[name].backend = makeEdgeLineBackend(name, {});
  double opencv_ms = 0.0;
  std::size_t frames = 0;
  for (std::size_t number = 0; auto frame = source.next(); ++number) {
    if (frame->gray.empty()) continue;
    mounting.refine(*frame);
    const MotionIncrement moved = motion.increment(*frame, mounting.uncertainty());
    if (number % every != 0 && number >= still) continue;
    ++frames;
    const LevelledCamera camera(*frame);
    for (Extractor& extractor : all) {
      const auto start = milliseconds();
      const Segments found = extractor.extract(*frame);
      extractor.total_ms += millisecondsSince(start);
      const Segments upright = verticals(found, camera);
      extractor.lines += upright.size();
      if (const auto there = truth.find(microseconds(frame->stamp_s)); there != truth.end())
        extractor.score.add(upright, there->second);
      if (number < still) {
        extractor.compare(upright);
        extractor.former = upright;
      }
    }
    opencv_ms += millisecondsOfOpencv(frame->gray);
    for (auto& [name, stage] : stages) {
      const auto start = milliseconds();
      const EdgeLines edges = stage.backend->extract(frame->gray, edgeViewOf(*frame));
      stage.edges_ms += millisecondsSince(start);
      const auto middle = milliseconds();
      stage.detectors.detect(
          *frame, edges, moved.isMeasured() ? std::optional(moved.T_previous_robot) : std::nullopt);
      stage.detectors_ms += millisecondsSince(middle);
    }
  }
  const auto n = static_cast<double>(std::max<std::size_t>(frames, 1));
  std::printf("%s, %zu frames\n\n", log.c_str(), frames);
  std::printf(
      "| extractor | upright lines | recall | offset rms px | seen again | wander px | ms |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const Extractor& e : all) {
    const auto& pillars = e.score.of(LandmarkKind::kPillarEdge);
    std::printf("| %s | %.1f | %.3f | %.2f | %.3f | %.2f | %.2f |\n", e.name.c_str(),
                static_cast<double>(e.lines) / n, pillars.recall(), pillars.offsetRms(),
                e.offered ? static_cast<double>(e.again) / static_cast<double>(e.offered) : 0.0,
                e.again ? std::sqrt(e.shift_squares / static_cast<double>(e.again)) : 0.0,
                e.total_ms / n);
  }
  std::printf(
      "\n| stage, mean of a frame | edges ms | detectors ms | both ms |\n|---|---|---|---|\n");
  for (const auto& [name, stage] : stages)
    std::printf("| %s | %.2f | %.2f | %.2f |\n", name.c_str(), stage.edges_ms / n,
                stage.detectors_ms / n, (stage.edges_ms + stage.detectors_ms) / n);
  std::printf("| OpenCV's Canny and HoughLines alone | | | %.2f |\n", opencv_ms / n);
  return 0;
}

}  // namespace
}  // namespace colonnade

int main(int argc, char** argv) {
  colonnade::keepFreedMemory();
  std::size_t still = 0;
  std::size_t every = 1;
  std::string log;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--still" && i + 1 < argc)
      still = std::stoul(argv[++i]);
    else if (word == "--every" && i + 1 < argc)
      every = std::max(1UL, std::stoul(argv[++i]));
    else
      log = word;
  }
  if (log.empty()) {
    std::fprintf(stderr, "usage: benchmark_extractors LOG [--still N] [--every N]\n");
    return 2;
  }
  try {
    return colonnade::run(log, still, every);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
