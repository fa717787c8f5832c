// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace colonnade {

/// What a log offers to methods, by its first frames.
struct LogContents {
  bool image = false;
  bool depth = false;
  bool odometry = false;
  bool truth = false;
};

/// Reads the first frames. Throws Error when the log cannot be read or holds no camera frame.
LogContents contentsOf(const std::filesystem::path& log, const std::filesystem::path& config);

/// One line of the table: how to run it, or why it cannot be run.
struct ComparedMethod {
  std::string key;    ///< names its folders
  std::string label;  ///< names it to people
  /// The verb, its method and its settings; log, folder and truth are added.
  std::vector<std::string> arguments;
  int runs = 1;         ///< more than one where MRPT draws random numbers
  std::string how;      ///< one line for people
  std::string missing;  ///< what the log lacks; then it is not run
};

/// Colonnade, its motion alone, MRPT's methods and, if asked for, Colonnade without one part each
/// and with each of the other edge backends. Throws Error (kUsage) for an unknown backend.
std::vector<ComparedMethod> comparedMethods(const LogContents& contents, int random_runs,
                                            bool ablations, const std::string& backend);

}  // namespace colonnade
