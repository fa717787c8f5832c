// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>

#include "colonnade/accelerator/rtl_backend.hpp"
#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/log_path.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/detectors/detection_csv.hpp"
#include "colonnade/detectors/draw_detections.hpp"
#include "colonnade/detectors/edge_view_of.hpp"
#include "colonnade/evaluation/detection_score.hpp"
#include "colonnade/frames/image_source.hpp"
#include "interrupt.hpp"
#include "measured.hpp"
#include "progress.hpp"
#include "results_folder.hpp"
#include "run_options.hpp"
#include "verbs.hpp"

namespace colonnade {
namespace {

namespace fs = std::filesystem;

struct DetectArguments {
  fs::path input;
  fs::path output;
  fs::path config;
  std::string backend = kDefaultBackend;
  std::vector<std::string> assignments;
  std::size_t picture_every = 1;
  bool score = false;
};

std::unique_ptr<FrameSource> openInput(const fs::path& input, const SourceOptions& options) {
  if (ImageSource::isImage(input)) return std::make_unique<ImageSource>(input, options);
  return std::make_unique<RawlogSource>(input, options);
}

/// What the detectors saw over all frames, for detect.json and the closing lines.
struct Tally {
  std::size_t frames = 0;
  std::map<std::string, std::size_t> accepted;
  std::map<std::string, std::size_t> refused;
  std::vector<double> edges_ms;
  std::vector<double> detectors_ms;

  void add(const Detections& detections) {
    ++frames;
    for (const Detection& detection : detections) {
      const std::string kind = name(detection.kind());
      ++(detection.accepted() ? accepted[kind] : refused[kind + ": " + detection.refusal]);
    }
  }
  nlohmann::ordered_json json() const {
    return {
        {"frames", frames},
        {"accepted", accepted},
        {"refused", refused},
        {"timing_ms", {{"edges", timingJson(edges_ms)}, {"detectors", timingJson(detectors_ms)}}}};
  }
  std::string text() const {
    std::string text = "frames     " + std::to_string(frames) + "\n";
    for (const auto& [kind, count] : accepted)
      text += kind + std::string(kind.size() < 11 ? 11 - kind.size() : 1, ' ') +
              std::to_string(count) + " accepted\n";
    for (const auto& [reason, count] : refused)
      text += "refused    " + std::to_string(count) + " " + reason + "\n";
    return text + "time       " + formatFixed(quantile(edges_ms, 0.5), 1) + " ms edges, " +
           formatFixed(quantile(detectors_ms, 0.5), 1) + " ms detectors (median of a frame)\n";
  }
};

std::vector<ImageLine> acceptedLines(const Frame& frame, const Detections& detections) {
  std::vector<ImageLine> lines;
  for (const Detection& d : detections) {
    if (!d.accepted()) continue;
    const bool ranged = d.measurement.hasRange();
    const auto inside = clipped(
        {d.kind(), d.a_px, d.b_px, ranged ? std::optional(d.measurement.z(1)) : std::nullopt},
        frame.camera.width_px, frame.camera.height_px);
    if (inside) lines.push_back(*inside);
  }
  return lines;
}

std::string pictureName(std::size_t frame) {
  std::string number = std::to_string(frame);
  number.insert(0, number.size() < 5 ? 5 - number.size() : 0, '0');
  return "frame_" + number + ".jpg";
}

ExitCode detect(const DetectArguments& arguments) {
  cv::setNumThreads(1);
  const RunOptions options = readRunOptions(arguments.config, arguments.assignments);
  const SessionOptions& stages = options.session;
  const auto source = openInput(arguments.input, options.source);
  const auto backend = makeImageStage(arguments.backend, stages.edges);
  MountingEstimator mounting(stages.motion, std::make_shared<CameraTracker>(stages.motion));
  DetectorBank detectors(stages.detectors);

  TrueImageLines truth;
  if (arguments.score) truth = readColumnsCsv(logStem(arguments.input).string() + "_columns.csv");

  const fs::path folder = makeResultsFolder(arguments.output, arguments.input);
  DetectionScore score;
  std::size_t frames_in_table = 0;
  Tally tally;
  Progress progress;
  const InterruptGuard interrupt;
  writeFileAtomically(folder / "detections.csv", [&](const fs::path& path) {
    std::FILE* const table = std::fopen(path.c_str(), "w");
    if (!table) throw Error(path.string() + ": cannot be written");
    std::fputs(detectionCsvHeader().c_str(), table);
    while (auto frame = interrupt.requested() ? std::nullopt : source->next()) {
      if (frame->gray.empty() && frame->depth_m.empty()) continue;
      mounting.refine(*frame);
      const auto start = std::chrono::steady_clock::now();
      const EdgeLines edges = backend->extract(frame->gray, edgeViewOf(*frame));
      const auto middle = std::chrono::steady_clock::now();
      const Detections detections = detectors.detect(*frame, edges);
      const auto end = std::chrono::steady_clock::now();
      using Milliseconds = std::chrono::duration<double, std::milli>;
      tally.edges_ms.push_back(Milliseconds(middle - start).count());
      tally.detectors_ms.push_back(Milliseconds(end - middle).count());
      tally.add(detections);
      if (arguments.score) {
        // A frame that shows nothing true has no row: whatever is detected in it is false.
        const auto there = truth.find(microseconds(frame->stamp_s));
        frames_in_table += there != truth.end() ? 1 : 0;
        score.add(acceptedLines(*frame, detections),
                  there != truth.end() ? there->second : std::vector<TrueImageLine>());
      }
      std::fputs(detectionCsvRows(*frame, detections).c_str(), table);
      if (arguments.picture_every > 0 && frame->index % arguments.picture_every == 0)
        cv::imwrite((folder / pictureName(frame->index)).string(),
                    drawDetections(*frame, edges, detections));
      progress.show(source->progress(), tally.frames, "detecting");
    }
    if (std::fclose(table) != 0) throw Error(path.string() + ": cannot be written to the end");
  });
  progress.finish();
  if (arguments.score && frames_in_table == 0)
    throw Error(arguments.input.string() + ": no frame of it stands in " +
                logStem(arguments.input).string() + "_columns.csv; is that of another log?");
  auto json = tally.json();
  if (arguments.score) json["score"] = toJson(score);
  writeFileAtomically(folder / "detect.json", json.dump(2) + "\n");
  std::printf("%s%sresults    %s\n", tally.text().c_str(),
              arguments.score ? toText(score).c_str() : "", folder.c_str());
  const Damage& damage = source->damage();
  if (!damage.detail.empty())
    std::fprintf(stderr, "%s: %s\n", arguments.input.c_str(), damage.detail.c_str());
  if (interrupt.requested()) return ExitCode::kInterrupted;
  if (tally.frames == 0)
    throw Error(arguments.input.string() + ": no camera images or depth; see: colonnade inspect " +
                arguments.input.string());
  return damage.any() ? ExitCode::kLossy : ExitCode::kDone;
}

}  // namespace

Action addDetect(CLI::App& verb) {
  const auto arguments = std::make_shared<DetectArguments>();
  verb.add_option("LOG_OR_IMAGE", arguments->input, "rawlog, or one picture")->required();
  verb.add_option("-o,--output", arguments->output, "new folder; default: stem + _results");
  verb.add_option("-c,--config", arguments->config, "INI file, such as config.ini of a run");
  verb.add_option("--backend", arguments->backend, "image stage: fixed, opencv, rtl")
      ->capture_default_str();
  verb.add_option("--set", arguments->assignments, "Section.key=value, wins over the file")
      ->allow_extra_args(false);
  verb.add_option("--picture-every", arguments->picture_every, "frames; 0: no pictures")
      ->check(notNegative())
      ->capture_default_str();
  verb.add_flag("--score", arguments->score,
                "against STEM_columns.csv, which simulate writes beside its log");
  verb.footer(
      "Examples:\n"
      "  colonnade detect corridor.rawlog -o seen\n"
      "  colonnade detect door.png -o seen --set Camera.fx_px=525 --set Camera.fy_px=525 \\\n"
      "    --set Camera.cx_px=319.5 --set Camera.cy_px=239.5 --set Camera.height_m=1.1 \\\n"
      "    --set Camera.tilt=given --set Camera.pitch_deg=5");
  return [arguments] { return detect(*arguments); };
}

}  // namespace colonnade
