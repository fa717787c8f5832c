// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "compare_table.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "colonnade/base/text.hpp"
#include "measured.hpp"

namespace colonnade {
namespace {

using Json = nlohmann::ordered_json;
using Format = std::function<std::string(double)>;

Format fixed(int decimals, double factor = 1.0) {
  return [=](double value) { return formatFixed(factor * value, decimals); };
}

std::string count(double value) {
  if (value >= 1e6) return formatFixed(value / 1e6, 1) + "M";
  if (value >= 1e4) return formatFixed(value / 1e3, 0) + "k";
  return formatFixed(value, 0);
}

std::string bytes(double value) {
  if (value >= 1e6) return formatFixed(value / 1e6, value >= 1e7 ? 0 : 1) + " MB";
  return formatFixed(value / 1e3, value >= 1e4 ? 0 : 1) + " kB";
}

std::string range(const std::vector<double>& sorted, const Format& format) {
  if (sorted.empty()) return "-";
  const std::string median = format(quantile(sorted, 0.5));
  if (sorted.size() == 1) return median;
  return median + " [" + format(sorted.front()) + ".." + format(sorted.back()) + "]";
}

std::string verdict(const MethodOutcome& outcome) {
  if (!outcome.method.missing.empty()) return "missing: " + outcome.method.missing;
  const std::size_t failures = outcome.failures();
  const std::size_t runs = outcome.runs.size();
  if (failures == 0) return "ok";
  const auto first = std::find_if(outcome.runs.begin(), outcome.runs.end(),
                                  [](const RunOutcome& run) { return !run.failure.empty(); });
  const std::string of = std::to_string(failures) + " of " + std::to_string(runs);
  if (2 * failures <= runs) return "ok, but " + of + " FAILED";
  return (runs == 1 ? "FAILED: " : "FAILED " + of + ": ") + first->failure;
}

/// Landmarks of a landmark map, points of a point map.
std::string mapCell(const MethodOutcome& outcome, const char* landmarks, const char* points,
                    const Format& format) {
  if (const auto values = outcome.values(landmarks); !values.empty())
    return format(quantile(values, 0.5));
  if (const auto values = outcome.values(points); !values.empty())
    return format(quantile(values, 0.5)) + " points";
  return "-";
}

struct Column {
  const char* title;
  std::function<std::string(const MethodOutcome&)> cell;
};

Column figure(const char* title, const char* name, Format format) {
  return {title, [=](const MethodOutcome& outcome) { return range(outcome.values(name), format); }};
}

const std::vector<Column>& columns() {
  static const std::vector<Column> all = {
      {"method", [](const MethodOutcome& outcome) { return outcome.method.label; }},
      {"verdict", verdict},
      figure("ATE m", "ate_m", fixed(3)),
      figure("RPE 1 m %", "rpe_1m_percent", fixed(1)),
      figure("drift %", "drift_percent", fixed(2)),
      figure("heading deg", "heading_deg", fixed(2)),
      figure("covers %", "coverage", fixed(0, 100.0)),
      {"map", [](const MethodOutcome& o) { return mapCell(o, "landmarks", "points", count); }},
      {"a frame",
       [](const MethodOutcome& o) {
         return mapCell(o, "landmarks_per_frame", "points_per_frame", fixed(1));
       }},
      figure("ms a frame", "frame_ms_median", fixed(1)),
      figure("95 % ms", "frame_ms_p95", fixed(1)),
      figure("MB", "peak_rss_mb", fixed(0)),
      figure("map on disk", "map_bytes", bytes),
  };
  return all;
}

std::string tableOf(const std::vector<MethodOutcome>& methods) {
  std::vector<std::vector<std::string>> rows(methods.size() + 1);
  for (const Column& column : columns()) {
    rows[0].push_back(column.title);
    for (std::size_t i = 0; i < methods.size(); ++i) rows[i + 1].push_back(column.cell(methods[i]));
  }
  std::vector<std::size_t> widths(columns().size(), 0);
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < widths.size(); ++c) {
      const std::string blanks(widths[c] - rows[r][c].size(), ' ');
      text += c < 2 ? "| " + rows[r][c] + blanks + " " : "| " + blanks + rows[r][c] + " ";
    }
    text += "|\n";
    if (r > 0) continue;
    for (std::size_t c = 0; c < widths.size(); ++c)
      text += "|" + std::string(widths[c] + 1, '-') + (c < 2 ? "-" : ":");
    text += "|\n";
  }
  return text;
}

std::string lacks(const LogContents& contents) {
  std::vector<std::string> words;
  if (!contents.image) words.push_back("no image");
  if (!contents.depth) words.push_back("no depth");
  if (!contents.odometry) words.push_back("no wheel odometry");
  if (!contents.truth) words.push_back("no ground truth given, so no errors");
  return words.empty() ? "images, depth, wheel odometry and ground truth are there"
                       : joined(words, "; ");
}

std::string timing(const ComparisonNotes& notes) {
  return "Each run is a process of its own, " +
         (notes.jobs == 1 ? std::string("one at a time")
                          : std::to_string(notes.jobs) + " at a time, which disturbs the times") +
         ", one thread. Time per frame: reading and processing, without what a method writes and "
         "without maps it never reads (Colonnade's scans and grid, the point map of "
         "kinect-3d-slam). "
         "MB: peak memory, such maps included. Map on disk: landmarks.csv or map.ply.";
}

/// Times are wall-clock times: says so when the runs had to share their processor.
std::string disturbance(const std::vector<MethodOutcome>& methods) {
  double wall_s = 0.0;
  double cpu_s = 0.0;
  for (const MethodOutcome& outcome : methods) {
    for (const double value : outcome.values("wall_s")) wall_s += value;
    for (const double value : outcome.values("cpu_s")) cpu_s += value;
  }
  if (cpu_s > 0.8 * wall_s) return "";
  return "The machine was busy: the runs had a processor for only " +
         formatFixed(100.0 * cpu_s / wall_s, 0) +
         " % of their time, so every time per frame is too long; compare none with another "
         "table.\n";
}

}  // namespace

std::string toMarkdown(const std::vector<MethodOutcome>& methods, const ComparisonNotes& notes) {
  std::string text = "# " + notes.log + "\n\n" + tableOf(methods) + "\n";
  text += "The log: " + lacks(notes.contents) + ".\n";
  text += failureRule() + "\n";
  text +=
      "Errors after a rigid SE(2) alignment, no scale, of the poses as estimated online. Random "
      "methods: median [least..greatest] of " +
      std::to_string(notes.random_runs) + " runs.\n";
  text += timing(notes) + "\n" + disturbance(methods);
  text += "A frame: landmarks measured, or corners matched, in the mean.\n\n";
  for (const MethodOutcome& outcome : methods) {
    text += "- " + outcome.method.label + ": " + outcome.method.how;
    if (const auto map_ms = outcome.values("map_ms_median"); !map_ms.empty() && map_ms.back() > 0.0)
      text +=
          "; its map takes " + formatFixed(quantile(map_ms, 0.5), 0) + " ms more at each key frame";
    if (const auto lost = outcome.values("lost_frames"); !lost.empty() && lost.back() > 0.0)
      text += "; frames lost: " + range(lost, fixed(0));
    for (const RunOutcome& run : outcome.runs)
      if (!run.remark.empty()) {
        text += "; " + run.remark;
        break;
      }
    text += "\n";
  }
  return text;
}

Json toJson(const std::vector<MethodOutcome>& methods, const ComparisonNotes& notes) {
  Json json;
  json["log"] = notes.log;
  json["contents"] = {{"image", notes.contents.image},
                      {"depth", notes.contents.depth},
                      {"odometry", notes.contents.odometry},
                      {"ground_truth", notes.contents.truth}};
  json["failure_rule"] = failureRule();
  json["timing"] = timing(notes);
  json["jobs"] = notes.jobs;
  json["methods"] = Json::array();
  for (const MethodOutcome& outcome : methods) {
    Json method = {{"key", outcome.method.key},         {"label", outcome.method.label},
                   {"how", outcome.method.how},         {"arguments", outcome.method.arguments},
                   {"missing", outcome.method.missing}, {"verdict", verdict(outcome)},
                   {"failed_runs", outcome.failures()}};
    method["runs"] = Json::array();
    for (const RunOutcome& run : outcome.runs)
      method["runs"].push_back(
          {{"failure", run.failure}, {"remark", run.remark}, {"figures", run.figures}});
    Json medians = Json::object();
    for (const RunOutcome& run : outcome.runs)
      for (const auto& [name, value] : run.figures)
        medians[name] = quantile(outcome.values(name), 0.5);
    method["median"] = medians;
    json["methods"].push_back(method);
  }
  return json;
}

}  // namespace colonnade
