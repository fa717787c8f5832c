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
  kBadFrame,   ///< a frame of another size came in; see `detail`
  kLateWrite,  ///< somebody wrote a parameter while a frame came in
  kBadPacket,  ///< what came out does not belong to the frame, contradicts itself or lacks a frame
};

/// What became of one frame.
struct AcceleratorResult {
  std::uint16_t frame_id = 0;
  AcceleratorFault fault = AcceleratorFault::kNone;
  std::string detail;        ///< of the fault, one line
  FixedResult found;         ///< of no meaning after a fault
  std::uint32_t clocks = 0;  ///< from the first pixel to the last word of the line packet
};

/// What is wrong with a result, by name; empty if it is that of `fixed`.
std::string differenceFrom(const FixedResult& expected, const AcceleratorResult& result);

/// WIDTHxHEIGHT, as options and messages name sizes.
std::string sizeName(const cv::Size& size);

/// The host's side of a device: configure, submit, then poll or wait; two frames may be on their
/// way.
class Accelerator {
 public:
  /// Resets the device and reads what it is. Throws Error when it is no accelerator, of another version, or built
  /// for other angles or passes than `shape`.
  Accelerator(std::unique_ptr<AcceleratorTransport> transport, FixedShape shape);
  ~Accelerator();

  cv::Size size() const { return size_; }
  /// For the frames submitted from now on. submit() then waits until the device has taken the
  /// former ones, since registers count for the frame that begins next.
  void configure(const FixedParameters& parameters);
  bool canSubmit() const { return on_the_way_ < 2; }
  /// gray: CV_8UC1 of size(). Throws Error otherwise, or with two frames on their way. Returns the
  /// frame's id.
  std::uint16_t submit(const cv::Mat& gray);
  /// The oldest frame's result, or nothing yet; lets the device work for a moment. After clocks
  /// enough for several frames without a result, a hang. A fault resets the device: a frame behind
  /// is lost too and has a result that says so.
  std::optional<AcceleratorResult> poll();
  /// poll() until there is a result. Throws Error when no frame is on its way.
  AcceleratorResult wait();
  /// For a caller who found a result wrong: resets the device; frames on their way are lost and have
  /// results that say so.
  void reset();

 private:
  bool letDeviceTakeAll();
  void start();
  /// What came out of the oldest frame, if all of it has.
  std::optional<AcceleratorResult> take();
  /// STATUS, which it clears.
  std::uint32_t takeStatus();
  AcceleratorResult hang(const std::string& where);
  AcceleratorResult interpret(const std::vector<std::uint8_t>& edges,
                              const std::vector<std::uint32_t>& packet);

  std::unique_ptr<AcceleratorTransport> transport_;
  FixedShape shape_;
  cv::Size size_;
  int patience_ = 0;  // clocks
  int waited_ = 0;    // clocks since the last result or the last frame submitted alone
  int on_the_way_ = 0;
  int lost_ = 0;  // frames whose loss is still to be told
  std::uint16_t next_id_ = 0;
  std::uint16_t oldest_id_ = 0;
  std::uint16_t sent_ = 0;  // frames since the reset, as FRAMES counts them
  FixedParameters parameters_;
  bool configured_ = false;
  std::optional<std::vector<std::uint8_t>> edges_;
  std::optional<std::vector<std::uint32_t>> packet_;
};

}  // namespace colonnade
