// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <exception>
#include <vector>

#include "verbs.hpp"

int main(int argc, char** argv) {
  using namespace colonnade;
  CLI::App app{"Landmark SLAM for indoor robots on MRPT"};
  app.require_subcommand(1);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    app.exit(error);
    return static_cast<int>(ExitCode::kUsage);
  }
  return 0;
}
