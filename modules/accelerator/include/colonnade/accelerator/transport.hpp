// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

namespace colonnade {

/// The only way to a device: its registers and its three streams. The Verilated model is one;
/// memory mapped registers with DMA channels (UIO, XRT) are another. Nothing waits except by
/// advance().
class AcceleratorTransport {
 public:
  virtual ~AcceleratorTransport() = default;

  /// Byte offsets as in hdl/REGISTERS.md.
  virtual std::uint32_t readRegister(std::uint32_t offset) = 0;
  virtual void writeRegister(std::uint32_t offset, std::uint32_t value) = 0;

  /// Queues an image (CV_8UC1 of the device's size) for the video input.
  virtual void sendFrame(const cv::Mat& gray) = 0;
  /// Whether the device has taken everything queued.
  virtual bool allSent() const = 0;
  /// Lets the device work for this many of its clocks (a real one: for about that long).
  virtual void advance(int clocks) = 0;

  /// The next whole edge map, a byte for each pixel in raster order, or nothing yet.
  virtual std::optional<std::vector<std::uint8_t>> takeEdges() = 0;
  /// The next whole line packet, or nothing yet.
  virtual std::optional<std::vector<std::uint32_t>> takePacket() = 0;

  /// Resets the device and forgets all that is on its way.
  virtual void reset() = 0;
};

}  // namespace colonnade
