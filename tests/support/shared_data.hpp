// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace colonnade::testing {

/// The repository under test.
inline std::filesystem::path sourceFolder() { return COLONNADE_SOURCE; }

/// The built program, for tests that run it as a user does.
inline std::filesystem::path program() { return COLONNADE_PROGRAM; }

/// A real recording below COLONNADE_DATA (default: ../shared/data beside the repository), or
/// nothing.
inline std::optional<std::filesystem::path> recording(const std::string& name) {
  const char* folder = std::getenv("COLONNADE_DATA");
  const auto path =
      (folder && *folder ? std::filesystem::path(folder) : sourceFolder() / "../shared/data") /
      name;
  if (!std::filesystem::exists(path)) return std::nullopt;
  return path;
}

}  // namespace colonnade::testing

/// Fetches a recording into `variable`, or skips the test saying which one is absent.
#define COLONNADE_REQUIRE_RECORDING(variable, name)                                                \
  const auto variable##_found = colonnade::testing::recording(name);                               \
  if (!variable##_found) GTEST_SKIP() << "recording " << name << " not found; set COLONNADE_DATA"; \
  const std::filesystem::path variable = *variable##_found
