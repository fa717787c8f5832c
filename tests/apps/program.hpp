// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "shared_data.hpp"
#include "temporary_folder.hpp"

namespace colonnade::testing {

struct Outcome {
  int exit_code = -1;
  std::string out;
  std::string err;
  /// Lines of stderr but for progress.
  int errorLines() const {
    std::istringstream lines(err);
    std::string line;
    int count = 0;
    while (std::getline(lines, line)) count += line.find("frames/s") == std::string::npos ? 1 : 0;
    return count;
  }
};

inline std::string contentOf(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// A folder of its own for each test, and the program run in it as a user runs it.
class ProgramTest : public ::testing::Test {
 protected:
  Outcome colonnade(const std::string& arguments) const {
    const auto out = folder_ / "stdout.txt";
    const auto err = folder_ / "stderr.txt";
    const std::string command = "cd '" + folder_.string() + "' && '" + program().string() + "' " +
                                arguments + " >'" + out.string() + "' 2>'" + err.string() +
                                "' </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), contentOf(out),
            contentOf(err)};
  }
  nlohmann::json summary(const std::string& results) const {
    return nlohmann::json::parse(contentOf(folder_ / results / "summary.json"));
  }
  std::filesystem::path corridor() const { return sourceFolder() / "rawlogs/corridor.rawlog"; }

  const TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path();
};

}  // namespace colonnade::testing
