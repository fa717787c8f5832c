// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "accelerator_times.hpp"

#include <algorithm>
#include <ctime>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <set>

#include "colonnade/accelerator/accelerator.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/edges/accelerator_registers.hpp"
#include "colonnade/edges/edge_line_backend.hpp"
#include "colonnade/edges/fixed_lines.hpp"
#include "measured.hpp"

namespace colonnade {
namespace {

constexpr int kRepetitions = 15;

double medianMilliseconds(const std::function<void()>& work) {
  std::vector<double> times;
  work();
  for (int i = 0; i < kRepetitions; ++i) times.push_back(processorMilliseconds(work));
  return quantile(times, 0.5);
}

/// Counts the clocks of the device and notes in which one its streams end.
class Stopwatch : public AcceleratorTransport {
 public:
  explicit Stopwatch(std::unique_ptr<AcceleratorTransport> device) : device_(std::move(device)) {}

  std::uint32_t readRegister(std::uint32_t offset) override {
    return device_->readRegister(offset);
  }
  void writeRegister(std::uint32_t offset, std::uint32_t value) override {
    device_->writeRegister(offset, value);
  }
  void sendFrame(const cv::Mat& gray) override { device_->sendFrame(gray); }
  bool allSent() const override { return device_->allSent(); }
  void advance(int clocks) override {
    for (int i = 0; i < clocks; ++i) {
      device_->advance(1);
      ++clock_;
      if (auto edges = device_->takeEdges()) {
        edges_.push_back(std::move(*edges));
        edges_ends.push_back(clock_);
      }
      if (auto packet = device_->takePacket()) {
        packets_.push_back(std::move(*packet));
        packet_ends.push_back(clock_);
      }
    }
  }
  std::optional<std::vector<std::uint8_t>> takeEdges() override { return front(edges_); }
  std::optional<std::vector<std::uint32_t>> takePacket() override { return front(packets_); }
  void reset() override { device_->reset(); }

  std::vector<std::uint32_t> edges_ends;
  std::vector<std::uint32_t> packet_ends;

 private:
  template <class Item>
  static std::optional<Item> front(std::vector<Item>& items) {
    if (items.empty()) return std::nullopt;
    Item item = std::move(items.front());
    items.erase(items.begin());
    return item;
  }
  std::unique_ptr<AcceleratorTransport> device_;
  std::uint32_t clock_ = 0;
  std::vector<std::vector<std::uint8_t>> edges_;
  std::vector<std::vector<std::uint32_t>> packets_;
};

}  // namespace

cv::Mat drawnCorridor() {
  cv::Mat image(480, 640, CV_8UC1, cv::Scalar(150));
  const auto fill = [&](std::vector<cv::Point> corners, double gray) {
    cv::fillConvexPoly(image, corners, cv::Scalar(gray), cv::LINE_AA);
  };
  fill({{0, 0}, {640, 0}, {390, 170}, {250, 170}}, 205);
  fill({{0, 480}, {640, 480}, {390, 300}, {250, 300}}, 85);
  fill({{0, 0}, {250, 170}, {250, 300}, {0, 480}}, 130);
  fill({{640, 0}, {390, 170}, {390, 300}, {640, 480}}, 165);
  for (const int u : {40, 140, 205}) {  // pillars on both sides, smaller with distance
    const int width = (250 - u) / 6 + 4;
    const int foot = 480 - u * 180 / 250;
    const int head = u * 170 / 250;
    fill({{u, head}, {u + width, head}, {u + width, foot}, {u, foot}}, 60);
    fill({{640 - u, head}, {640 - u - width, head}, {640 - u - width, foot}, {640 - u, foot}}, 225);
  }
  fill({{300, 215}, {340, 215}, {340, 300}, {300, 300}}, 100);  // a door at the end
  cv::RNG random(1);
  cv::Mat noise(image.size(), CV_16SC1);
  random.fill(noise, cv::RNG::NORMAL, 0.0, 3.0);
  cv::add(image, noise, image, cv::noArray(), CV_8U);
  return image;
}

double processorMilliseconds(const std::function<void()>& work) {
  const std::clock_t start = std::clock();
  work();
  return 1000.0 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

void BareOpenCv::canny(const cv::Mat& gray) {
  const EdgeOptions options;
  cv::GaussianBlur(gray, smooth_, {}, options.smoothing_sigma_px, 0.0, cv::BORDER_REPLICATE);
  cv::Canny(smooth_, edges_, options.canny_low, options.canny_high, 3, false);
}

void BareOpenCv::hough() {
  const int votes = std::max(1, edges_.rows * EdgeOptions{}.vertical_votes_percent / 100);
  cv::HoughLines(edges_, lines_, 1.0, CV_PI / 180.0, votes);
}

SoftwareTimes softwareTimes(const cv::Mat& gray) {
  SoftwareTimes times;
  times.size = gray.size();
  BareOpenCv bare;
  times.opencv_canny_ms = medianMilliseconds([&] { bare.canny(gray); });
  times.opencv_hough_ms = medianMilliseconds([&] { bare.hough(); });
  const EdgeOptions options;
  const auto reference = makeEdgeLineBackend("opencv", options);
  times.opencv_ms = medianMilliseconds([&] { reference->extract(gray); });
  const auto fixed = makeEdgeLineBackend("fixed", options);
  times.fixed_ms = medianMilliseconds([&] { fixed->extract(gray); });
  return times;
}

HardwareTimes hardwareTimes(const AcceleratorModel& model, const cv::Mat& gray) {
  HardwareTimes times;
  times.model = model;
  const auto parameters = runParameters(model.shape, {}, {}, gray.cols, gray.rows);
  const FixedResult expected = FixedStage(model.shape).process(gray, parameters);
  times.lines = expected.lines.size();

  auto stopwatch = std::make_unique<Stopwatch>(makeModelTransport(model));
  Stopwatch& watch = *stopwatch;
  Accelerator accelerator(std::move(stopwatch), model.shape);
  accelerator.configure(parameters);
  accelerator.submit(gray);
  const AcceleratorResult result = accelerator.wait();
  if (const std::string difference = differenceFrom(expected, result); !difference.empty())
    throw Error("accelerator: the model's answer is not that of fixed: " + difference + "; " +
                result.detail);
  std::set<int> steps;  // of the scan: angles side by side, a bin in each
  for (const FixedLine& line : expected.lines) steps.insert(line.rho);
  times.waiting_lines = expected.lines.size() - steps.size();
  times.clocks = result.clocks;
  times.tail_clocks = watch.readRegister(registers::kTailCycles);
  times.canny_clocks = times.clocks - (watch.packet_ends[0] - watch.edges_ends[0]);

  // Frames without a gap, and no register access between, which would take clocks of its own.
  constexpr std::size_t kFrames = 4;
  for (std::size_t i = 1; i < kFrames; ++i) watch.sendFrame(gray);
  for (int i = 0; watch.packet_ends.size() < kFrames; ++i) {
    if (i > 100 * gray.rows) throw Error("accelerator: the model hangs");
    watch.advance(gray.cols);
  }
  times.sustained_clocks = watch.packet_ends[kFrames - 1] - watch.packet_ends[kFrames - 2];
  return times;
}

}  // namespace colonnade
