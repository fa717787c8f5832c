// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "results_folder.hpp"

#include <string>

#include "colonnade/base/error.hpp"
#include "colonnade/base/log_path.hpp"

namespace colonnade {

std::filesystem::path makeResultsFolder(const std::filesystem::path& asked,
                                        const std::filesystem::path& log) {
  namespace fs = std::filesystem;
  fs::path folder = asked;
  if (!asked.empty()) {
    if (fs::exists(asked) && (!fs::is_directory(asked) || !fs::is_empty(asked)))
      throw Error(asked.string() + ": exists and is not an empty folder; give -o a new one",
                  ExitCode::kUsage);
  } else {
    const std::string stem = logStem(log).string() + "_results";
    folder = stem;
    for (int i = 2; fs::exists(folder); ++i) folder = stem + "-" + std::to_string(i);
  }
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error(folder.string() + ": cannot be created: " + error.message());
  return folder;
}

}  // namespace colonnade
