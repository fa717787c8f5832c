// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation_files.hpp"

#include <optional>

#include "colonnade/base/error.hpp"
#include "colonnade/base/log_path.hpp"

namespace colonnade {
namespace {

namespace fs = std::filesystem;

/// STEM of a log or of a file beside one; nothing for other names.
std::optional<fs::path> stemOf(const fs::path& file) {
  const std::string name = file.filename().string();
  for (const std::string ending : {".rawlog", ".rawlog.gz"})
    if (name.size() > ending.size() && name.ends_with(ending)) return logStem(file);
  for (const std::string ending :
       {"_ground_truth.tum", "_landmarks.csv", "_floor.yaml", "_floor.png", "_columns.csv"})
    if (name.size() > ending.size() && name.ends_with(ending))
      return file.parent_path() / name.substr(0, name.size() - ending.size());
  return std::nullopt;
}

/// One half of a comparison: as named, else where it should stand.
struct Half {
  fs::path& path;
  fs::path expected;  ///< empty: it has no place of its own
  bool named = !path.empty();

  bool find() const {
    if (path.empty() && fs::is_regular_file(expected)) path = expected;
    return !path.empty();
  }
  std::string missing() const {
    return expected.empty() ? "no truth for it beside the ground truth"
                            : expected.string() + " is missing";
  }
};

/// Both halves or none; says what a results folder cannot tell.
void pairUp(const std::string& what, const std::string& option, Half estimate, Half truth,
            std::vector<std::string>& not_scored) {
  if (estimate.path.empty() && estimate.expected.empty() && !truth.named) return;
  const bool has_estimate = estimate.find();
  const bool has_truth = truth.find();
  if (has_estimate && has_truth) return;
  if (truth.named && estimate.expected.empty())
    throw Error(
        "--truth-" + option + " needs a results folder or --" + option + " to compare it with",
        ExitCode::kUsage);
  if (estimate.named)
    throw Error("--" + option + " needs --truth-" + option + " (" + truth.missing() + ")",
                ExitCode::kUsage);
  not_scored.push_back(what + " (" + (has_estimate ? truth : estimate).missing() + ")");
  estimate.path.clear();
  truth.path.clear();
}

}  // namespace

EvaluationFiles complete(EvaluationFiles files) {
  const bool is_results = fs::is_directory(files.trajectory);
  const fs::path folder = is_results ? files.trajectory : fs::path();
  const auto inFolder = [&](const char* name) { return is_results ? folder / name : fs::path(); };
  if (is_results) {
    files.trajectory = folder / "trajectory.tum";
    if (!fs::is_regular_file(files.trajectory))
      throw Error(folder.string() + ": holds no trajectory.tum; is it a results folder of run?");
    if (fs::is_regular_file(folder / "trajectory_final.tum"))
      files.final_trajectory = folder / "trajectory_final.tum";
    if (!Half{files.covariance, folder / "trajectory_covariance.csv"}.find())
      files.not_scored.push_back("NEES (" + (folder / "trajectory_covariance.csv").string() +
                                 " is missing)");
  }
  const auto stem = stemOf(files.ground_truth);
  const auto beside = [&](const char* ending) {
    return stem ? fs::path(stem->string() + ending) : fs::path();
  };
  if (stem) {
    if (!fs::is_regular_file(beside("_ground_truth.tum")))
      throw Error(files.ground_truth.string() + ": no true trajectory beside it; " +
                  beside("_ground_truth.tum").string() + " is missing");
    files.ground_truth = beside("_ground_truth.tum");
  }
  pairUp("landmarks", "landmarks", {files.landmarks, inFolder("landmarks.csv")},
         {files.truth_landmarks, beside("_landmarks.csv")}, files.not_scored);
  pairUp("free floor", "floor", {files.floor, inFolder("map.yaml")},
         {files.truth_floor, beside("_floor.yaml")}, files.not_scored);
  return files;
}

}  // namespace colonnade
