// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>

#include "colonnade/accelerator/accelerator.hpp"
#include "colonnade/edges/fixed_lines.hpp"

namespace colonnade {

/// The image stage on a device. Every frame is computed on the CPU too and compared: where the
/// device hangs, complains or differs, the CPU's result is the answer, so the outcome is that of
/// `fixed` in any case, and notes() says what happened.
class RtlBackend : public EdgeLineBackend {
 public:
  using Connect = std::function<std::unique_ptr<AcceleratorTransport>(const cv::Size&)>;
  /// connect: called once for each image size, may return nullptr: such frames are left to the CPU.
  RtlBackend(const EdgeOptions& options, Connect connect);

  /// Frames and clocks, then each kind of fault with its number of frames and a first example.
  std::vector<std::string> notes() const override;

 private:
  struct Device {
    std::unique_ptr<Accelerator> accelerator;  // nullptr: no device for this size
    std::vector<std::uint32_t> clocks;         // of each frame
  };
  EdgeLines process(const cv::Mat& gray, const EdgeView& view) override;
  Device& deviceFor(const cv::Size& size);

  EdgeOptions options_;
  Connect connect_;
  FixedStage stage_;
  std::map<std::pair<int, int>, Device> devices_;
  struct Fault {
    int frames = 0;
    std::string first;
  };
  std::map<std::string, Fault> faults_;
  int frame_ = 0;
};

/// Every backend of this program: those of `edges` and `rtl`, the Verilated model.
std::unique_ptr<EdgeLineBackend> makeImageStage(const std::string& name,
                                                const EdgeOptions& options);

}  // namespace colonnade
