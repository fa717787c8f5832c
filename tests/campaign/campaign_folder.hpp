// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "colonnade/base/error.hpp"
#include "colonnade/campaign/campaign_file.hpp"
#include "temporary_folder.hpp"

namespace colonnade::testing {

/// A folder of its own for each test, with a tiny world in it.
class CampaignFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    write("hall.world", R"(room hall -1 -1  4 -1  4 1  -1 1  hallway=0
pilaster wall=hall.1 at_m=2.6
camera width_px=160 height_px=120 rate_hz=5
start 0 0 heading_deg=0
drive 1.6 0 speed_m_per_s=0.8
)");
  }

  void write(const std::filesystem::path& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }
  std::string content(const std::filesystem::path& name) const {
    std::ostringstream text;
    text << std::ifstream(folder_ / name, std::ios::binary).rdbuf();
    return text.str();
  }
  Campaign parse(const std::string& text) const {
    return parseCampaign(text, folder_ / "x.campaign");
  }
  /// What the parser says, without the folder's name.
  std::string complaintAbout(const std::string& text) const {
    try {
      parse(text);
    } catch (const Error& error) {
      EXPECT_EQ(ExitCode::kUsage, error.code());
      const std::string message = error.what();
      const std::string before = folder_.string() + "/";
      return message.starts_with(before) ? message.substr(before.size()) : message;
    }
    return "no complaint";
  }

  const TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path();
};

}  // namespace colonnade::testing
