// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "colonnade/base/error.hpp"

namespace colonnade {

/// One verb of the program: it adds its options to a subcommand and returns what to do when the
/// subcommand is chosen. Errors leave as Error; main prints them as one line.
using Action = std::function<ExitCode()>;

/// For counts and seeds: CLI11 would read -1 as a huge unsigned number.
inline CLI::Validator notNegative() {
  return {[](std::string& text) {
            return text.starts_with('-') ? text + " is negative" : std::string();
          },
          "UINT"};
}

Action addRun(CLI::App& verb);
Action addDetect(CLI::App& verb);
Action addCalibrate(CLI::App& verb);
Action addInspect(CLI::App& verb);
Action addImport(CLI::App& verb);
Action addSimulate(CLI::App& verb);
Action addEvaluate(CLI::App& verb);
Action addCampaign(CLI::App& verb);
Action addTextbook(CLI::App& verb);
Action addBaseline(CLI::App& verb);
Action addCompare(CLI::App& verb);
Action addAccelerator(CLI::App& verb);

}  // namespace colonnade
