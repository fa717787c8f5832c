// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "compare_methods.hpp"

#include "colonnade/accelerator/rtl_backend.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/frames/rawlog_source.hpp"
#include "run_options.hpp"

namespace colonnade {
namespace {

std::vector<std::string> with(std::vector<std::string> arguments,
                              const std::vector<std::string>& assignments) {
  for (const std::string& assignment : assignments) {
    arguments.push_back("--set");
    arguments.push_back(assignment);
  }
  return arguments;
}

ComparedMethod ablation(const std::string& key, const std::string& label,
                        const std::string& assignment) {
  return {key, "without " + label, with({"run"}, {assignment}), 1, assignment, ""};
}

/// Every method of this program that looks at edges, with another backend than the default.
void useBackend(std::vector<ComparedMethod>& methods, const std::string& backend) {
  for (ComparedMethod& method : methods) {
    if (method.arguments.front() != "run") continue;
    method.arguments.insert(method.arguments.end(), {"--backend", backend});
    method.how += ", --backend " + backend;
  }
}

void addAblations(std::vector<ComparedMethod>& methods) {
  methods.push_back(ablation("no-pillars", "pillars", "Pillars.enabled=false"));
  methods.push_back(ablation("no-floor-edges", "floor edges", "FloorEdges.enabled=false"));
  methods.push_back(ablation("no-depth-slopes", "depth slopes", "DepthSlopes.enabled=false"));
  methods.push_back(ablation("no-axes", "building axes", "Axes.enabled=false"));
  methods.push_back(ablation("plain-ekf", "invariant filter", "Filter.invariant=false"));
}

}  // namespace

LogContents contentsOf(const std::filesystem::path& log, const std::filesystem::path& config) {
  constexpr int kFrames = 10;
  RawlogSource source(log, readRunOptions(config, {}).source);
  LogContents contents;
  for (int i = 0; i < kFrames; ++i) {
    const auto frame = source.next();
    if (!frame) break;
    contents.image |= !frame->gray.empty();
    contents.depth |= !frame->depth_m.empty();
    contents.odometry |= frame->odometry.has_value();
  }
  if (!contents.image && !contents.depth)
    throw Error(log.string() +
                ": no camera images or depth in its first frames; see: colonnade "
                "inspect " +
                log.string());
  return contents;
}

std::vector<ComparedMethod> comparedMethods(const LogContents& contents, int random_runs,
                                            bool ablations, const std::string& backend) {
  makeImageStage(backend, {});  // refuses a name that no run would take
  const std::string no_depth = contents.depth ? "" : "no depth in the log";
  const std::string no_image = contents.image ? no_depth : "no image in the log";
  std::vector<ComparedMethod> methods;
  methods.push_back({"colonnade", "Colonnade", {"run"}, 1, "colonnade run, default settings", ""});
  methods.push_back({"motion-alone", "Colonnade's motion alone",
                     with({"run"}, {"Pillars.enabled=false", "FloorEdges.enabled=false",
                                    "DepthSlopes.enabled=false", "Axes.enabled=false"}),
                     1, "colonnade run without landmarks and axes", ""});
  methods.push_back({"kinect-3d-slam",
                     "MRPT kinect-3d-slam",
                     {"baseline", "kinect-3d-slam"},
                     random_runs,
                     "the program's method and thresholds; image and depth only",
                     no_image});
  methods.push_back({"kinect-3d-slam-tuned", "MRPT kinect-3d-slam, tuned",
                     with({"baseline", "kinect-3d-slam"},
                          {"KinectSlam.response_to_add=10", "KinectSlam.response_to_keep=5",
                           "KinectSlam.subpixel=true"}),
                     random_runs,
                     "the same with weaker corners (KLT response 10 and 5) followed between pixels",
                     no_image});
  methods.push_back({"difodo",
                     "MRPT CDifodo",
                     {"baseline", "difodo"},
                     1,
                     "numbers of DifOdometry-Datasets, slow pyramid; depth only",
                     no_depth});
  methods.push_back({"kf-slam",
                     "MRPT kf-slam",
                     {"baseline", "kf-slam"},
                     1,
                     "CRangeBearingKFSLAM2D on Colonnade's detections with range and its motion",
                     no_depth});
  methods.push_back({"dead-reckoning",
                     "Dead reckoning",
                     {"baseline", "dead-reckoning"},
                     1,
                     "the log's wheel odometry",
                     contents.odometry ? "" : "no wheel odometry in the log"});
  if (ablations) addAblations(methods);
  if (backend != kDefaultBackend) useBackend(methods, backend);
  for (const std::string other : {"fixed", "opencv", "rtl"}) {
    if (!ablations || other == backend) continue;
    methods.push_back({"backend-" + other,
                       "edges: " + other,
                       {"run", "--backend", other},
                       1,
                       "--backend " + other,
                       ""});
  }
  return methods;
}

}  // namespace colonnade
