// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "colonnade/base/memory.hpp"
#include "verbs.hpp"

namespace {

struct Verb {
  const char* name;
  const char* what;
  colonnade::Action (*add)(CLI::App&);
};

constexpr Verb kVerbs[] = {
    {"inspect", "What is in a log: sensors, rates, sizes, calibration, gaps, damage",
     colonnade::addInspect},
    {"import", "Other formats to rawlog", colonnade::addImport},
    {"simulate", "A world to a rawlog with ground truth", colonnade::addSimulate},
    {"run", "The main job: a rawlog to a landmark map and a trajectory", colonnade::addRun},
    {"detect", "What the detectors see, frame by frame: overlays and a table",
     colonnade::addDetect},
    {"calibrate", "Distance and lateral shift from the image of a pillar of known width",
     colonnade::addCalibrate},
    {"evaluate", "A trajectory against ground truth", colonnade::addEvaluate},
    {"campaign", "Worlds x seeds x configurations in parallel, and one table",
     colonnade::addCampaign},
    {"textbook", "The EKF-SLAM experiment of textbooks: rounds of a cloister, errors plotted",
     colonnade::addTextbook},
    {"baseline", "The same log through one of MRPT's own methods", colonnade::addBaseline},
    {"compare", "The same log through Colonnade and MRPT's own methods, one table",
     colonnade::addCompare},
    {"accelerator", "The image stage as hardware: resources, clocks and times beside the thesis'",
     colonnade::addAccelerator},
};

/// One line on stderr, so that scripts and people see the same.
int fail(const std::string& message, colonnade::ExitCode code) {
  std::fprintf(stderr, "colonnade: %s\n", message.c_str());
  return static_cast<int>(code);
}

}  // namespace

int main(int argc, char** argv) {
  using colonnade::ExitCode;
  colonnade::keepFreedMemory();
  CLI::App app{"Colonnade: landmark SLAM for indoor robots on MRPT", "colonnade"};
  app.require_subcommand(1);
  app.set_version_flag("--version", COLONNADE_VERSION);
  colonnade::Action action;
  for (const Verb& verb : kVerbs) {
    CLI::App* subcommand = app.add_subcommand(verb.name, verb.what);
    const auto act = verb.add(*subcommand);
    subcommand->final_callback([&action, act] { action = act; });
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    return fail(std::string(error.what()) + " (see colonnade --help)", ExitCode::kUsage);
  }
  try {
    return static_cast<int>(action());
  } catch (const colonnade::Error& error) {
    return fail(error.what(), error.code());
  } catch (const std::exception& error) {
    return fail(std::string("failed: ") + error.what(), ExitCode::kFailed);
  }
}
