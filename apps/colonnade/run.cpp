// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <opencv2/core/utility.hpp>
#include <optional>
#include <utility>

#include "colonnade/accelerator/rtl_backend.hpp"
#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/maps/landmark_csv.hpp"
#include "colonnade/slam/range_bearing_session.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "results_folder.hpp"
#include "run_options.hpp"
#include "run_recorder.hpp"
#include "summary.hpp"
#include "verbs.hpp"

namespace colonnade {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAnywhere = "anywhere";

struct RunArguments {
  fs::path log;
  fs::path config;
  fs::path output;
  std::string backend = kDefaultBackend;
  fs::path ground_truth;
  std::vector<std::string> assignments;
  fs::path map;
  bool localize = false;
  std::string start;  ///< x,y in metres, heading in degrees; or anywhere
};

/// Truth in the world of the estimate, for the picture.
Trajectory inWorldOf(const TrajectoryScore& score, Trajectory truth) {
  const Eigen::Isometry3d T_estimate_truth = score.T_truth_estimate.inverse();
  for (StampedPose& pose : truth) pose.T_world_body = T_estimate_truth * pose.T_world_body;
  return truth;
}

/// A log from its first camera frame on: what cannot be mapped at all is refused before a results
/// folder exists.
class CameraFrames : public FrameSource {
 public:
  CameraFrames(FrameSource& source, const fs::path& log) : source_(source) {
    std::size_t without = 0;
    do {
      first_ = source_.next();
      without += first_ ? 1 : 0;
    } while (first_ && first_->gray.empty() && first_->depth_m.empty());
    if (first_) return;
    const Damage& damage = source_.damage();
    throw Error(log.string() + ": no camera images or depth in " +
                std::to_string(damage.entries_read) + " entries" +
                (without > 0 ? " (" + std::to_string(without) + " frames without either)" : "") +
                (damage.detail.empty() ? "" : "; " + damage.detail) + "; see: colonnade inspect " +
                log.string());
  }
  std::optional<Frame> next() override {
    return first_ ? std::exchange(first_, std::nullopt) : source_.next();
  }
  const Damage& damage() const override { return source_.damage(); }
  double progress() const override { return source_.progress(); }

 private:
  FrameSource& source_;
  std::optional<Frame> first_;
};

/// Whether a log holds readings of landmarks and no camera frame. A camera log is known by its
/// first frame or two.
bool isRangeBearingLog(const fs::path& log, const SourceOptions& options) {
  RawlogSource source(log, options);
  bool readings = false;
  while (const auto frame = source.next()) {
    if (!frame->gray.empty() || !frame->depth_m.empty()) return false;
    readings = readings || frame->range_bearing.has_value();
  }
  return readings;
}

/// What summary.json says beside the figures of every run.
void describe(const Session& session, nlohmann::ordered_json& json) {
  json["loop_closings"] = session.mapper().loopClosings();
  json["hallways"] = session.mapper().hallways().size();
}
void describe(const RangeBearingSession& session, nlohmann::ordered_json& json) {
  const IdentityScore score = session.identityScore();
  json["association"] = {{"readings_with_identity", score.readings},
                         {"associated", score.associated},
                         {"right", score.right},
                         {"right_share", score.rightShare()}};
  if (const auto sensor = session.sensor()) {
    const SensorErrors::Vector errors = sensor->errors.vector();
    const SensorErrors::Vector beforehand = session.options().sensor_sigmas.vector();
    for (int i = 0; i < SensorErrors::kSize; ++i)
      json["sensor"][SensorErrors::kNames[static_cast<std::size_t>(i)]] = {
          {"estimate", errors(i)},
          {"sigma", std::sqrt(sensor->covariance(i, i))},
          {"sigma_beforehand", beforehand(i)}};
  }
  if (const auto& smoothed = session.smoothed()) {
    auto merged = nlohmann::ordered_json::array();
    for (const auto& [landmark, into] : smoothed->merged)
      merged.push_back({{"id", number(landmark)}, {"into", number(into)}});
    json["smoothing"] = {{"converged", smoothed->how.converged},
                         {"steps", smoothed->how.steps},
                         {"readings_left_out", smoothed->how.unused},
                         {"landmarks_merged", merged},
                         {"cost", smoothed->how.cost},
                         {"surprise", smoothed->surprise},
                         {"explained_backwards", smoothed->explained_backwards}};
    if (smoothed->cost_of_identities)
      json["smoothing"]["cost_of_identities"] = *smoothed->cost_of_identities;
  }
}

/// Poses as they are known at the end, where a session keeps them.
Trajectory finalTrajectory(const Session& session) {
  Trajectory trajectory;
  for (const auto& [stamp_s, T_world_robot] : session.mapper().trajectory())
    trajectory.push_back({stamp_s, T_world_robot.toIsometry3()});
  return trajectory;
}
Trajectory finalTrajectory(const RangeBearingSession& session) {
  return session.smoothed() ? session.smoothed()->trajectory : session.trajectory();
}

/// What a later run needs to go on from this map.
SavedMap savedMap(const Session& session) { return session.mapper().savedMap(); }
SavedMap savedMap(const RangeBearingSession& session) { return session.savedMap(); }

/// The score, or why there is none: a wrong truth must not cost the map.
std::optional<TrajectoryScore> scoreAgainst(const Trajectory& truth, const Trajectory& estimate,
                                            const std::vector<StampedCovariance>& covariances,
                                            std::string& why_not) {
  if (truth.empty()) return std::nullopt;
  try {
    return evaluateTrajectory(estimate, truth, {}, covariances);
  } catch (const Error& error) {
    why_not = error.what();
    return std::nullopt;
  }
}

/// What went wrong or was left out, a line each, and the exit code it amounts to.
ExitCode conclude(const RunArguments& arguments, const RunSummary& summary,
                  const std::vector<std::string>& notes, const std::string& not_scored,
                  const PlaceSearch* search) {
  const auto say = [&](const std::string& line) {
    std::fprintf(stderr, "%s: %s\n", arguments.log.c_str(), line.c_str());
  };
  for (const std::string& note : notes) say(note);
  for (const std::string& reason : summary.maps.left_out) say("left out: " + reason);
  if (!summary.damage.detail.empty()) say(summary.damage.detail);
  for (const auto& [reason, count] : summary.damage.skipped)
    say(std::to_string(count) + " skipped: " + reason);
  if (!not_scored.empty()) say("not scored: " + not_scored);
  if (search) {
    const FoundPlace& last = search->last();
    say("the place in " + arguments.map.string() + " was not found (" + last.refusal + ": " +
        std::to_string(last.fits) + " of " + std::to_string(last.of) + " places, evidence " +
        formatFixed(last.evidence, 1) + ", elsewhere " + formatFixed(last.elsewhere, 1) +
        "); the results are a map of its own");
  }
  if (summary.interrupted) {
    say("interrupted after " + std::to_string(summary.frames_processed) + " frames");
    return ExitCode::kInterrupted;
  }
  if (!not_scored.empty() || search) return ExitCode::kFailed;
  return summary.damage.any() ? ExitCode::kLossy : ExitCode::kDone;
}

std::vector<std::string> notesOf(const Session& session) { return session.imageStage().notes(); }
std::vector<std::string> notesOf(const RangeBearingSession& session) { return session.notes(); }

/// In the world of map().
Pose2 poseOf(const Session& session) { return session.filter().pose(); }
Pose2 poseOf(const RangeBearingSession& session) { return session.now().T_world_robot; }
Eigen::Matrix3d poseCovarianceOf(const Session& session) {
  return session.filter().poseCovariance();
}
Eigen::Matrix3d poseCovarianceOf(const RangeBearingSession& session) {
  return session.now().covariance;
}

/// StampedCovariance::T_world_origin.
Pose2 worldOriginOf(const Session&) { return {}; }
Pose2 worldOriginOf(const RangeBearingSession& session) { return session.now().T_world_origin; }

struct RunInputs {
  const RunArguments& arguments;
  const RunOptions& options;
  const Trajectory& truth;
  RawlogSource& log;
};

std::ptrdiff_t landmarksIn(const EkfSlam& filter) {
  const auto& blocks = filter.state().blocks;
  return std::count_if(blocks.begin(), blocks.end(), [](const Block& b) { return b.isLandmark(); });
}

/// x,y,heading of --start.
Pose2 startOf(const std::string& text) {
  const auto parts = fields(text, ',');
  std::vector<double> numbers;
  for (const std::string& part : parts)
    if (const auto value = parseDouble(part); value && std::isfinite(*value))
      numbers.push_back(*value);
  if (parts.size() != 3 || numbers.size() != 3)
    throw Error("--start " + text + ": give x,y,heading (m, m, degrees), or " + kAnywhere,
                ExitCode::kUsage);
  return {numbers[0], numbers[1], radians(numbers[2])};
}

/// The map of a former run, if one is asked for, and where in it this one starts.
std::optional<Resumption> resumption(const RunArguments& arguments, const RunOptions& options) {
  if (arguments.map.empty()) {
    if (arguments.localize || !arguments.start.empty())
      throw Error("--localize and --start need --map FILE", ExitCode::kUsage);
    return std::nullopt;
  }
  Resumption from;
  from.map = MapFile::read(arguments.map);
  from.localize = arguments.localize;
  from.T_world_robot = from.map.T_world_start;
  if (arguments.start == kAnywhere)
    from.anywhere = options.places;
  else if (!arguments.start.empty())
    from.T_world_robot = startOf(arguments.start);
  from.covariance =
      MapStart::startCovariance(options.resume.start_sigma_m, options.resume.start_sigma_heading);
  return from;
}

void refuseOtherKind(const RunArguments& arguments, const std::optional<Resumption>& from,
                     SavedMap::Source of_log) {
  if (!from || from->map.source == of_log) return;
  throw Error(arguments.map.string() + ": made from " +
                  (of_log == SavedMap::Source::kReadings
                       ? "cameras, and the log holds landmark readings"
                       : "landmark readings, and the log holds camera frames") +
                  "; give a map of a log of its kind",
              ExitCode::kUsage);
}

/// A session over a source, into a results folder.
template <class AnySession>
ExitCode runSession(AnySession& session, FrameSource& source, const RunInputs& inputs) {
  const auto& [arguments, options, truth, log] = inputs;
  const fs::path folder = makeResultsFolder(arguments.output, arguments.log);
  writeFileAtomically(folder / "config.ini", effectiveConfig(options));
  MapRecorder maps(folder, options.maps, options.scans);
  RunRecorder recorder;
  Progress progress;
  const InterruptGuard interrupt;
  const auto start = std::chrono::steady_clock::now();

  session.run(source, [&](const Frame& frame, const StepReport& report, const AnySession& now) {
    recorder.add(frame, report, now.search() ? std::nullopt : std::optional(poseOf(now)),
                 poseCovarianceOf(now), worldOriginOf(now));
    maps.add(frame, poseOf(now), poseCovarianceOf(now), report.motion.T_previous_robot,
             report.motion.covariance);
    progress.show(source.progress(), recorder.frames(),
                  std::to_string(landmarksIn(now.filter())) + " landmarks");
    return !interrupt.requested();
  });
  progress.finish();

  RunSummary summary;
  summary.wall_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  summary.interrupted = interrupt.requested();
  summary.damage = source.damage();
  summary.frames_processed = recorder.frames();
  summary.frames = recorder.frames();
  for (const auto& [reason, count] : summary.damage.skipped) summary.frames += count;
  summary.landmarks = session.map();
  summary.axes = session.axisCount();
  std::string not_scored;
  if (!session.search())
    summary.score = scoreAgainst(truth, recorder.trajectory(), recorder.covariances(), not_scored);
  Trajectory final = finalTrajectory(session);
  if (final.empty()) final = recorder.trajectory();
  summary.final_score = scoreAgainst(truth, final, {}, not_scored);

  recorder.write(folder, final);
  writeFileAtomically(folder / "map.colonnade", MapFile::text(savedMap(session)));
  writeLandmarksCsv(folder / "landmarks.csv", summary.landmarks);
  MapContents contents;
  contents.title = arguments.log.filename().string();
  contents.landmarks = summary.landmarks;
  contents.trajectory = final;
  if (summary.final_score) contents.ground_truth = inWorldOf(*summary.final_score, truth);
  summary.maps = maps.finish(contents);
  auto json = toJson(summary, recorder, session.filter().health());
  describe(session, json);
  writeFileAtomically(folder / "summary.json",
                      json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  std::printf("%sresults    %s\n", toText(json).c_str(), folder.c_str());
  std::vector<std::string> notes = log.notes();
  for (const std::string& note : notesOf(session)) notes.push_back(note);
  return conclude(arguments, summary, notes, not_scored, session.search());
}

ExitCode run(const RunArguments& arguments) {
  cv::setNumThreads(1);  // one frame is too little work to share; results never depend on it
  const RunOptions options = readRunOptions(arguments.config, arguments.assignments);
  Trajectory truth;
  if (!arguments.ground_truth.empty()) {
    truth = readTum(arguments.ground_truth);
    if (truth.empty()) throw Error(arguments.ground_truth.string() + ": holds no pose");
  }
  const bool readings_only = isRangeBearingLog(arguments.log, options.source);
  RawlogSource log(arguments.log, options.source);
  const RunInputs inputs{arguments, options, truth, log};
  auto from = resumption(arguments, options);
  if (readings_only) {
    refuseOtherKind(arguments, from, SavedMap::Source::kReadings);
    RangeBearingSession session(options.range_bearing, options.session.filter,
                                options.session.motion, std::move(from));
    return runSession(session, log, inputs);
  }
  CameraFrames source(log, arguments.log);
  refuseOtherKind(arguments, from, SavedMap::Source::kCamera);
  Session session(options.session, makeImageStage(arguments.backend, options.session.edges),
                  std::move(from));
  return runSession(session, source, inputs);
}

}  // namespace

Action addRun(CLI::App& verb) {
  const auto arguments = std::make_shared<RunArguments>();
  verb.add_option("LOG", arguments->log, "rawlog, plain or gz")->required();
  verb.add_option("-c,--config", arguments->config,
                  "INI file; what it does not name stays default");
  verb.add_option("-o,--output", arguments->output, "new folder; default: LOG's stem + _results");
  verb.add_option("--backend", arguments->backend, "image stage: fixed, opencv, rtl")
      ->capture_default_str();
  verb.add_option("--ground-truth", arguments->ground_truth, "robot poses, TUM file: adds a score");
  verb.add_option("--set", arguments->assignments, "Section.key=value, wins over the file")
      ->allow_extra_args(false);
  verb.add_option("--map", arguments->map, "map.colonnade of a former run, to go on from");
  verb.add_flag("--localize", arguments->localize, "with --map: leave it as it is, find the pose");
  verb.add_option("--start", arguments->start,
                  "with --map: x,y,heading where the robot starts in it (m, m, degrees), or "
                  "anywhere: it is found");
  verb.footer(
      "Examples:\n"
      "  colonnade run rawlogs/corridor.rawlog\n"
      "  colonnade run monday.rawlog --map sunday_results/map.colonnade --localize\n"
      "  colonnade run monday.rawlog --map sunday_results/map.colonnade --start anywhere\n"
      "  colonnade run corridor.rawlog -o map --ground-truth corridor_ground_truth.tum\n"
      "  colonnade run corridor.rawlog --set Filter.invariant=false --set Axes.enabled=false\n"
      "  colonnade run robot3.rawlog --set RangeBearing.use_ids=false   (landmark readings)");
  return [arguments] { return run(*arguments); };
}

}  // namespace colonnade
