// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "accelerator_run.hpp"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "accelerator_times.hpp"
#include "colonnade/accelerator/accelerator.hpp"
#include "colonnade/accelerator/model_transport.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/detectors/edge_view_of.hpp"
#include "colonnade/edges/fixed_lines.hpp"
#include "colonnade/frames/rawlog_source.hpp"
#include "interrupt.hpp"
#include "measured.hpp"
#include "progress.hpp"

namespace colonnade {
namespace {

std::string modelNames() {
  std::vector<std::string> names;
  for (const cv::Size& size : modelSizes()) names.push_back(sizeName(size));
  return joined(names, ", ");
}

/// Frames of one size against the model; refuses sizes that no model takes.
class Bench {
 public:
  explicit Bench(const AcceleratorRunArguments& arguments) : arguments_(arguments) {
    if (arguments.size.empty()) return;
    for (const cv::Size& size : modelSizes())
      if (sizeName(size) == arguments.size) scaled_to_ = size;
    if (scaled_to_.empty())
      throw Error(
          "--size " + arguments.size + ": there is no model of it; there are: " + modelNames(),
          ExitCode::kUsage);
  }

  void add(const Frame& frame) {
    cv::Mat gray = frame.gray;
    const bool scaled = !scaled_to_.empty() && gray.size() != scaled_to_;
    if (scaled) cv::resize(frame.gray, gray, scaled_to_, 0, 0, cv::INTER_AREA);
    if (!accelerator_) connect(gray.size());
    const auto parameters = runParameters(
        stage_.shape(), {}, scaled ? EdgeView{} : edgeViewOf(frame), gray.cols, gray.rows);
    accelerator_->configure(parameters);
    accelerator_->submit(gray);
    FixedResult expected;
    fixed_ms.push_back(processorMilliseconds([&] { expected = stage_.process(gray, parameters); }));
    opencv_ms.push_back(processorMilliseconds([&] {
      opencv_.canny(gray);
      opencv_.hough();
    }));
    const AcceleratorResult result = accelerator_->wait();
    const std::string difference = differenceFrom(expected, result);
    if (!difference.empty())
      throw Error(arguments_.log.string() + ": frame " + std::to_string(frame.index) +
                  ": the model's answer is not that of fixed: " + difference +
                  (result.detail.empty() ? "" : ": " + result.detail));
    clocks.push_back(result.clocks);
    lines.push_back(static_cast<double>(expected.lines.size()));
    size = gray.size();
  }

  cv::Size size;
  std::vector<double> clocks;
  std::vector<double> lines;
  std::vector<double> fixed_ms;
  std::vector<double> opencv_ms;

 private:
  void connect(const cv::Size& size_of_frames) {
    auto transport = makeModelTransport(size_of_frames);
    if (!transport)
      throw Error(arguments_.log.string() + ": no model for frames of " + sizeName(size_of_frames) +
                      "; scale them: --size " + sizeName(modelSizes().front()) +
                      " (there are: " + modelNames() + ")",
                  ExitCode::kUsage);
    accelerator_ = std::make_unique<Accelerator>(std::move(transport), stage_.shape());
  }

  const AcceleratorRunArguments& arguments_;
  cv::Size scaled_to_;
  std::unique_ptr<Accelerator> accelerator_;
  FixedStage stage_{runShape()};
  BareOpenCv opencv_;
};

std::string spread(const std::vector<double>& values, int decimals) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return formatFixed(quantile(values, 0.5), decimals) + " (" + formatFixed(*least, decimals) +
         " to " + formatFixed(*most, decimals) + ")";
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

ExitCode acceleratorRun(const AcceleratorRunArguments& arguments) {
  cv::setNumThreads(1);
  RawlogSource source(arguments.log, SourceOptions{});
  Bench bench(arguments);
  Progress progress;
  const InterruptGuard interrupt;
  std::size_t seen = 0;
  while (!interrupt.requested() &&
         (arguments.max_frames == 0 || bench.clocks.size() < arguments.max_frames)) {
    const auto frame = source.next();
    if (!frame) break;
    if (frame->gray.empty() || seen++ % arguments.every != 0) continue;
    bench.add(*frame);
    progress.show(source.progress(), bench.clocks.size(), "through the model");
  }
  progress.finish();
  if (bench.clocks.empty())
    throw Error(arguments.log.string() + ": no camera images; see: colonnade inspect " +
                arguments.log.string());
  const double clocks = quantile(bench.clocks, 0.5);
  const double board_ms = clocks / arguments.clock_mhz / 1000.0;
  std::printf(
      "frames     %zu of %s, edges and lines of each equal to fixed\n"
      "lines      %s a frame, median and range\n"
      "clocks     %s from first pixel to last line\n"
      "board      %s ms a frame at %s MHz, at least %s frames/s\n"
      "fixed      %s ms a frame on this processor, one thread\n"
      "OpenCV     %s ms a frame, Canny and HoughLines over all angles: %s times fixed on average\n",
      bench.clocks.size(), sizeName(bench.size).c_str(), spread(bench.lines, 0).c_str(),
      spread(bench.clocks, 0).c_str(), formatFixed(board_ms, 3).c_str(),
      formatDouble(arguments.clock_mhz, 6).c_str(), formatFixed(1000.0 / board_ms, 0).c_str(),
      spread(bench.fixed_ms, 3).c_str(), spread(bench.opencv_ms, 3).c_str(),
      formatFixed(sum(bench.opencv_ms) / sum(bench.fixed_ms), 1).c_str());
  if (interrupt.requested()) return ExitCode::kInterrupted;
  return source.damage().any() ? ExitCode::kLossy : ExitCode::kDone;
}

}  // namespace colonnade
