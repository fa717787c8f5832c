// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// The image stage of each backend on a frame of the corridor recording (COLONNADE_DATA).
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "colonnade/edges/edge_line_backend.hpp"

namespace {

void extract(benchmark::State& state, const char* name) {
  cv::setNumThreads(1);
  const char* folder = std::getenv("COLONNADE_DATA");
  const std::string file =
      std::string(folder ? folder : "../shared/data") + "/corridor_xtion/rgb/0000000005.400000.jpg";
  cv::Mat image = cv::imread(file, cv::IMREAD_GRAYSCALE);
  if (image.empty()) {
    state.SkipWithError(("cannot read " + file + "; set COLONNADE_DATA").c_str());
    return;
  }
  const int width = static_cast<int>(state.range(0));
  cv::resize(image, image, {width, width * 3 / 4}, 0, 0, cv::INTER_AREA);
  const auto backend = colonnade::makeEdgeLineBackend(name, {});
  for (auto _ : state) benchmark::DoNotOptimize(backend->extract(image));
}

BENCHMARK_CAPTURE(extract, opencv, "opencv")->Arg(320)->Arg(640)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(extract, fixed, "fixed")->Arg(320)->Arg(640)->Unit(benchmark::kMillisecond);

}  // namespace
