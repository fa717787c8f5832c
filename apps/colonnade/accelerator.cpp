// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "accelerator_report.hpp"
#include "accelerator_run.hpp"
#include "colonnade/base/atomic_file.hpp"
#include "results_folder.hpp"
#include "verbs.hpp"

namespace colonnade {
namespace {

namespace fs = std::filesystem;

struct ReportArguments {
  bool json = false;
  fs::path output;
  fs::path image;
};

ExitCode report(const ReportArguments& arguments) {
  cv::setNumThreads(1);
  cv::Mat picture = drawnCorridor();
  if (!arguments.image.empty()) {
    picture = cv::imread(arguments.image.string(), cv::IMREAD_GRAYSCALE);
    if (picture.empty())
      throw Error(arguments.image.string() + ": cannot be read as a picture", ExitCode::kUsage);
  }
  const auto scaled = [&](const cv::Size& size) {
    cv::Mat result;
    cv::resize(picture, result, size, 0, 0, cv::INTER_AREA);
    return result;
  };
  std::vector<SoftwareTimes> software;
  for (const cv::Size& size : {cv::Size(120, 120), cv::Size(320, 240), cv::Size(640, 480)})
    software.push_back(softwareTimes(scaled(size)));
  std::vector<HardwareTimes> hardware;
  for (const AcceleratorModel& model : acceleratorModels())
    hardware.push_back(hardwareTimes(model, scaled(model.size)));
  const auto figures = acceleratorFigures(
      software, hardware, arguments.image.empty() ? "a drawn corridor" : arguments.image.string());
  const std::string json = figures.dump(2) + "\n";
  const std::string tables = acceleratorTables(figures);
  if (!arguments.output.empty()) {
    const fs::path folder = makeResultsFolder(arguments.output, "accelerator");
    writeFileAtomically(folder / "accelerator.json", json);
    writeFileAtomically(folder / "accelerator.md", tables);
  }
  std::fputs(arguments.json ? json.c_str() : tables.c_str(), stdout);
  return ExitCode::kDone;
}

Action addReport(CLI::App& verb) {
  const auto arguments = std::make_shared<ReportArguments>();
  verb.add_flag("--json", arguments->json, "every figure of the tables as JSON");
  verb.add_option("-o,--output", arguments->output,
                  "new folder for accelerator.json and accelerator.md");
  verb.add_option("--image", arguments->image, "picture to time; default: a drawn corridor");
  verb.footer(
      "Resources and clock rates are those hdl/measure.py has measured for this RTL; times are\n"
      "measured now. Examples:\n"
      "  colonnade accelerator report\n"
      "  colonnade accelerator report --image corridor.jpg --json");
  return [arguments] { return report(*arguments); };
}

Action addAcceleratorRun(CLI::App& verb) {
  const auto arguments = std::make_shared<AcceleratorRunArguments>();
  verb.add_option("LOG", arguments->log, "rawlog, plain or gz")->required();
  verb.add_option("--clock-mhz", arguments->clock_mhz, "of the board")
      ->check(CLI::Range(0.001, 10000.0))
      ->capture_default_str();
  verb.add_option("--max-frames", arguments->max_frames, "0: all")
      ->check(notNegative())
      ->capture_default_str();
  verb.add_option("--every", arguments->every, "take every n-th frame")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000000}))
      ->capture_default_str();
  verb.add_option("--size", arguments->size,
                  "scale frames to the size of a model, such as 320x240");
  verb.footer(
      "Each frame also goes through `fixed`; the first that differs ends the run with exit code "
      "1.\n"
      "Examples:\n"
      "  colonnade accelerator run rawlogs/corridor.rawlog --clock-mhz 100\n"
      "  colonnade accelerator run xtion.rawlog --size 320x240");
  return [arguments] { return acceleratorRun(*arguments); };
}

}  // namespace

Action addAccelerator(CLI::App& verb) {
  verb.require_subcommand(1);
  auto* const tables =
      verb.add_subcommand("report", "The thesis' tables of resources and times beside ours");
  auto* const log = verb.add_subcommand(
      "run", "A log's frames through the simulated RTL: clocks, and what a board would take");
  return [log, print_report = addReport(*tables), run_log = addAcceleratorRun(*log)] {
    return log->parsed() ? run_log() : print_report();
  };
}

}  // namespace colonnade
