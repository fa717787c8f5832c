// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "colonnade/accelerator/transport.hpp"
#include "colonnade/edges/fixed_stage.hpp"

namespace colonnade {

enum class AcceleratorFault {
  kNone,
  kHang,       ///< nothing came out in time; the device was reset
  kBadFrame,   ///< the device mended a broken frame; see `detail`
  kLateWrite,  ///< somebody wrote a parameter while a frame came in
  kBadPacket,  ///< what came out does not belong to the frame or contradicts itself
};

/// What became of one frame.
struct AcceleratorResult {
  std::uint16_t frame_id = 0;
  AcceleratorFault fault = AcceleratorFault::kNone;
  std::string detail;        ///< of the fault, one line
  FixedResult found;         ///< empty after a fault
  std::uint32_t clocks = 0;  ///< from the first pixel to the last word of the line packet
};

/// The host's side of a device: configure, submit, then poll or wait; two frames may be on their
/// way.
class Accelerator {
 public:
  /// Reads what the device is. Throws Error when it is no accelerator, of another version, or built
  /// for other angles or passes than `shape`.
  Accelerator(std::unique_ptr<AcceleratorTransport> transport, FixedShape shape);
  ~Accelerator();

  cv::Size size() const { return size_; }
  /// For the frames submitted from now on. Waits until the device has taken the former ones.
  void configure(const FixedParameters& parameters);
  bool canSubmit() const { return on_the_way_ < 2; }
  /// gray: CV_8UC1 of size(). Throws Error otherwise, or with two frames on their way. Returns the
  /// frame's id.
  std::uint16_t submit(const cv::Mat& gray);
  /// The oldest frame's result, or nothing yet. A fault resets the device: a frame behind is lost
  /// too and has a result that says so.
  std::optional<AcceleratorResult> poll();
  /// The oldest frame's result; after clocks enough for several frames without one, a hang.
  AcceleratorResult wait();

 private:
  bool letDeviceTakeAll();
  void start();
  /// Resets the device; the frames on their way are lost.
  void recover();
  AcceleratorResult hang(const std::string& where);
  AcceleratorResult interpret(const std::vector<std::uint8_t>& edges,
                              const std::vector<std::uint32_t>& packet);

  std::unique_ptr<AcceleratorTransport> transport_;
  FixedShape shape_;
  cv::Size size_;
  int patience_ = 0;  // clocks
  int on_the_way_ = 0;
  int lost_ = 0;  // frames whose loss is still to be told
  std::uint16_t next_id_ = 0;
  std::uint16_t oldest_id_ = 0;
  FixedParameters parameters_;
  bool configured_ = false;
  std::optional<std::vector<std::uint8_t>> edges_;
  std::optional<std::vector<std::uint32_t>> packet_;
};

}  // namespace colonnade
