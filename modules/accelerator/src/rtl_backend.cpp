// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/accelerator/rtl_backend.hpp"

#include <algorithm>

#include "colonnade/accelerator/model_transport.hpp"
#include "colonnade/base/error.hpp"

namespace colonnade {
RtlBackend::RtlBackend(const EdgeOptions& options, Connect connect)
    : options_(options), connect_(std::move(connect)), stage_(runShape()) {}

RtlBackend::Device& RtlBackend::deviceFor(const cv::Size& size) {
  const auto [entry, is_new] = devices_.try_emplace({size.width, size.height});
  if (is_new) {
    if (auto transport = connect_(size)) {
      entry->second.accelerator =
          std::make_unique<Accelerator>(std::move(transport), stage_.shape());
    }
  }
  return entry->second;
}

EdgeLines RtlBackend::process(const cv::Mat& gray, const EdgeView& view) {
  const auto parameters = runParameters(stage_.shape(), options_, view, gray.cols, gray.rows);
  Device& device = deviceFor(gray.size());
  if (device.accelerator) {
    device.accelerator->configure(parameters);
    device.accelerator->submit(gray);
  }
  FixedResult expected = stage_.process(gray, parameters);
  if (device.accelerator) {
    const auto result = device.accelerator->wait();
    const std::string difference = differenceFrom(expected, result);
    if (difference.empty()) {
      device.clocks.push_back(result.clocks);
    } else {
      // Streams that have slipped would make every later frame differ.
      if (result.fault == AcceleratorFault::kNone) device.accelerator->reset();
      Fault& fault = faults_[difference];
      if (fault.frames++ == 0) {
        fault.first =
            "frame " + std::to_string(frame_) + (result.detail.empty() ? "" : ": " + result.detail);
      }
    }
  }
  ++frame_;
  return {std::move(expected.edges), toHoughLines(expected.lines, gray.cols, gray.rows, options_)};
}

std::vector<std::string> RtlBackend::notes() const {
  std::vector<std::string> notes;
  for (const auto& [size, device] : devices_) {
    const std::string name = sizeName({size.first, size.second});
    if (!device.accelerator) {
      std::string sizes;
      for (const auto& model : modelSizes()) sizes += " " + sizeName(model);
      notes.push_back("rtl: no model for " + name + ", left to the CPU; there are:" + sizes);
    } else if (!device.clocks.empty()) {
      auto clocks = device.clocks;
      std::nth_element(clocks.begin(),
                       clocks.begin() + static_cast<std::ptrdiff_t>(clocks.size() / 2),
                       clocks.end());
      notes.push_back("rtl: " + std::to_string(clocks.size()) + " frames of " + name +
                      " equal to fixed, " + std::to_string(clocks[clocks.size() / 2]) +
                      " clocks from first pixel to last line (median)");
    }
  }
  for (const auto& [what, fault] : faults_) {
    notes.push_back("rtl: " + what + " in " + std::to_string(fault.frames) +
                    " frames, answered by the CPU; first in " + fault.first);
  }
  return notes;
}

std::unique_ptr<EdgeLineBackend> makeImageStage(const std::string& name,
                                                const EdgeOptions& options) {
  if (name == "rtl")
    return std::make_unique<RtlBackend>(
        options, [](const cv::Size& size) { return makeModelTransport(size); });
  try {
    return makeEdgeLineBackend(name, options);
  } catch (const Error& error) {
    throw Error(std::string(error.what()) + ", rtl", error.code());
  }
}

}  // namespace colonnade
