// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "colonnade/jobs/job_runner.hpp"

namespace colonnade::testing {

/// A folder of its own for each test, and shell scripts as jobs.
class JobTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = std::filesystem::temp_directory_path() / "colonnade_jobs_XXXXXX";
    ASSERT_NE(nullptr, ::mkdtemp(name.data()));
    folder_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

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

  std::filesystem::path folder_;
};

}  // namespace colonnade::testing
