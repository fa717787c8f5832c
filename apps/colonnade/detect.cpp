// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/config.hpp"
#include "colonnade/base/log_path.hpp"
#include "colonnade/detectors/detection_csv.hpp"
#include "colonnade/detectors/draw_detections.hpp"
#include "colonnade/detectors/shade.hpp"
#include "colonnade/frames/image_source.hpp"
#include "detect_score.hpp"
#include "detect_stages.hpp"
#include "detect_tally.hpp"
#include "detect_tracking.hpp"
#include "detect_video.hpp"
#include "interrupt.hpp"
#include "known_pillar.hpp"
#include "path_map.hpp"
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
  fs::path video;
  fs::path path_map;
  DetectScoreRequest score;
  std::optional<std::uint64_t> errors;  ///< seed of what is put wrong before detection
  bool track = false;
  EdgeTrackingOptions tracking;
  std::vector<int> shade_area;  ///< x, y, width, height
};

std::unique_ptr<FrameSource> openInput(const fs::path& input, const SourceOptions& options) {
  if (ImageSource::isImage(input)) return std::make_unique<ImageSource>(input, options);
  return std::make_unique<RawlogSource>(input, options);
}

std::string pictureName(std::size_t frame) {
  std::string number = std::to_string(frame);
  number.insert(0, number.size() < 5 ? 5 - number.size() : 0, '0');
  return "frame_" + number + ".jpg";
}

/// What `detect` makes of every frame, one file or number each.
class DetectRecorder {
 public:
  explicit DetectRecorder(const DetectArguments& arguments) : arguments_(arguments) {
    if (arguments.score.any()) score_.emplace(arguments.score, logStem(arguments.input).string());
    if (!arguments.video.empty()) video_.emplace(arguments.video);
    if (arguments.track) tracking_.emplace(arguments.tracking);
    if (arguments.path_map.empty()) return;
    Config config = Config::fromFile(arguments.path_map);
    PathMapOptions options;
    config.read(options);
    config.requireAllKnown();
    path_map_.emplace(options);
  }

  void writeTo(const fs::path& folder) { folder_ = folder; }

  void add(const Frame& frame, const DetectStages::Seen& seen, const Segmentation& segmentation) {
    tally_.add(seen);
    if (score_) score_->add(frame, seen.detections);
    if (tracking_) tracking_->add(frame, seen);
    if (path_map_) path_map_->add(frame, pillar_.find(frame, seen.detections));
    const bool wanted = arguments_.picture_every > 0 && frame.index % arguments_.picture_every == 0;
    if (!wanted && !video_) return;
    const cv::Mat picture = drawDetections(frame, seen.edges, seen.detections, &segmentation);
    if (wanted) cv::imwrite((folder_ / pictureName(frame.index)).string(), picture);
    if (video_) video_->add(frame.stamp_s, picture);
  }

  /// Writes what is complete only now.
  void close() {
    if (video_) video_->close();
    if (score_ && !score_->hasFrames())
      throw Error(arguments_.input.string() + ": no frame of it stands in " +
                  score_->table().string() + "; is that of another log?");
    if (path_map_) {
      path_map_->finish();
      path_map_->write(folder_);
    }
    if (tracking_) writeFileAtomically(folder_ / "tracks.csv", tracking_->table());
    auto json = tally_.json();
    if (score_) score_->addTo(json);
    writeFileAtomically(folder_ / "detect.json", json.dump(2) + "\n");
    std::printf("%s%s%sresults    %s\n", tally_.text().c_str(),
                tracking_ ? tracking_->text().c_str() : "", score_ ? score_->text().c_str() : "",
                folder_.c_str());
  }
  std::size_t frames() const { return tally_.frames; }

 private:
  const DetectArguments& arguments_;
  fs::path folder_;
  DetectTally tally_;
  std::optional<DetectScore> score_;
  std::optional<DetectVideo> video_;
  std::optional<DetectTracking> tracking_;
  std::optional<PathMap> path_map_;
  KnownPillar pillar_{0.0};
};

/// The shade of pillars from a rectangle (x, y, width, height) of the first picture.
ShadeOptions shadeOf(FrameSource& source, const std::vector<int>& area) {
  while (const auto frame = source.next())
    if (!frame->gray.empty())
      return learnShade(frame->colour, {area[0], area[1], area[2], area[3]});
  throw Error("there is no picture to learn a shade from");
}

ExitCode detect(const DetectArguments& arguments) {
  cv::setNumThreads(1);
  RunOptions options = readRunOptions(arguments.config, arguments.assignments);
  if (!arguments.shade_area.empty())
    options.session.detectors.shade =
        shadeOf(*openInput(arguments.input, options.source), arguments.shade_area);
  const auto source = openInput(arguments.input, options.source);
  DetectStages stages(options.session, arguments.backend);
  std::optional<MountingErrors> errors;
  if (arguments.errors) errors.emplace(options.session.detectors.geometry, *arguments.errors);
  const auto putWrong = [&errors](Frame& frame) {
    if (errors) errors->apply(frame);
  };
  DetectRecorder recorder(arguments);
  const fs::path folder = makeResultsFolder(arguments.output, arguments.input);
  recorder.writeTo(folder);
  if (!arguments.shade_area.empty())
    writeFileAtomically(folder / "config.ini", effectiveConfig(options));
  Progress progress;
  const InterruptGuard interrupt;
  writeFileAtomically(folder / "detections.csv", [&](const fs::path& path) {
    std::FILE* const table = std::fopen(path.c_str(), "w");
    if (!table) throw Error(path.string() + ": cannot be written");
    std::fputs(detectionCsvHeader().c_str(), table);
    while (auto frame = interrupt.requested() ? std::nullopt : source->next()) {
      if (frame->gray.empty() && frame->depth_m.empty()) continue;
      const DetectStages::Seen seen = stages.see(*frame, putWrong);
      std::fputs(detectionCsvRows(*frame, seen.detections).c_str(), table);
      recorder.add(*frame, seen, stages.detectors().segmentation());
      progress.show(source->progress(), recorder.frames(), "detecting");
    }
    if (std::fclose(table) != 0) throw Error(path.string() + ": cannot be written to the end");
  });
  progress.finish();
  recorder.close();
  const Damage& damage = source->damage();
  if (!damage.detail.empty())
    std::fprintf(stderr, "%s: %s\n", arguments.input.c_str(), damage.detail.c_str());
  if (interrupt.requested()) return ExitCode::kInterrupted;
  if (recorder.frames() == 0)
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
  verb.add_option("--video", arguments->video, "all overlays as a Motion-JPEG film, FILE.avi");
  verb.add_option("--path-map", arguments->path_map,
                  "INI of calibrate -o: the camera's path before that pillar, map and table");
  verb.add_flag("--score", arguments->score.score,
                "against STEM_columns.csv, which simulate writes beside its log");
  verb.add_option("--labels", arguments->score.labels,
                  "score against this table instead: columns of STEM_columns.csv");
  verb.add_option(
      "--errors", arguments->errors,
      "seed: put mounting and depth of each frame wrong as [Geometry] says they may be");
  verb.add_option("--thesis-thresholds", arguments->score.thesis_thresholds,
                  "mm per pixel: count good and bad landmarks of the 2012 thesis' rule, e.g. "
                  "0,100,1000")
      ->delimiter(',');
  verb.add_option("--thesis-rows", arguments->score.thesis.rows, "rows that rule looks at")
      ->check(CLI::Range(1, 2000))
      ->capture_default_str();
  verb.add_option("--thesis-colour", arguments->score.thesis.colour_share,
                  "its weight of colour in full light")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  verb.add_flag("--track", arguments->track,
                "follow pillar edges from frame to frame; writes tracks.csv");
  verb.add_option("--learning-frames", arguments->tracking.learning_frames,
                  "of the learning-checking cycle, at 0.5 m/s or slower")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb.add_option("--checking-frames", arguments->tracking.checking_frames, "the same")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb.add_option(
          "--learn-shade", arguments->shade_area,
          "only pillars of the shade in this rectangle of the first picture: X,Y,W,H; config.ini "
          "keeps it for later runs")
      ->delimiter(',')
      ->expected(4);
  verb.footer(
      "Examples:\n"
      "  colonnade detect corridor.rawlog -o seen\n"
      "  colonnade detect corridor.rawlog -o seen --picture-every 0 --video seen.avi\n"
      "  colonnade detect hall.rawlog -o seen --learn-shade 300,100,40,200 --track\n"
      "  colonnade detect door.png -o seen --set Camera.fx_px=525 --set Camera.fy_px=525 \\\n"
      "    --set Camera.cx_px=319.5 --set Camera.cy_px=239.5 --set Camera.height_m=1.1 \\\n"
      "    --set Camera.tilt=given --set Camera.pitch_deg=5");
  return [arguments] { return detect(*arguments); };
}

}  // namespace colonnade
