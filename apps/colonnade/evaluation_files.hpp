// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace colonnade {

/// What is compared with what; an empty path is not compared.
struct EvaluationFiles {
  std::filesystem::path trajectory;        ///< or a results folder of `run`
  std::filesystem::path final_trajectory;  ///< of a results folder
  std::filesystem::path covariance;
  std::filesystem::path landmarks;
  std::filesystem::path floor;
  std::filesystem::path ground_truth;  ///< TUM; or the log, or another truth file beside it
  std::filesystem::path truth_landmarks;
  std::filesystem::path truth_floor;
  std::vector<std::string> not_scored;  ///< what a results folder or its truth does not have
};

/// Completes what the user named: a results folder stands for the files in it, and a log or a truth
/// file of the simulator for the truth beside it. Throws Error when a trajectory is missing or when
/// one half of a comparison was named and the other is nowhere.
EvaluationFiles complete(EvaluationFiles named);

}  // namespace colonnade
