// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "colonnade/jobs/job_runner.hpp"
#include "temporary_folder.hpp"

namespace colonnade::testing {

/// A folder of its own for each test, and shell scripts as jobs.
class JobTest : public ::testing::Test {
 protected:
  Job shell(const std::string& name, const std::string& script) const {
    Job job;
    job.name = name;
    job.program = "/bin/sh";
    job.arguments = {"-c", "cd \"$0\"; " + script, folder_.string()};
    job.log = folder_ / (name + ".log");
    return job;
  }
  std::string contentOf(const std::filesystem::path& path) const {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }

  const TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path();
};

}  // namespace colonnade::testing
