// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace colonnade {

/// A bit for each pixel of an image, those of one step along a walk side by side: the steps are
/// rows for walks along steep lines, columns for flat ones.
class StepBits {
 public:
  StepBits() = default;
  StepBits(int steps, int width)
      : stride_(static_cast<std::size_t>(width + 7) / 8),
        bytes_(static_cast<std::size_t>(steps) * stride_ + sizeof(std::uint64_t), 0) {}

  /// Those of step s from t on, as many as fit, t in the lowest bit; 57 of them hold.
  std::uint64_t from(int s, int t) const {
    std::uint64_t word;
    std::memcpy(&word, &bytes_[byteOf(s, t)], sizeof word);
    return word >> (t % 8);
  }
  bool test(int s, int t) const { return (bytes_[byteOf(s, t)] >> (t % 8) & 1) != 0; }
  void set(int s, int t) {
    auto& byte = bytes_[byteOf(s, t)];
    byte = static_cast<std::uint8_t>(byte | 1U << (t % 8));
  }
  void reset(int s, int t) {
    auto& byte = bytes_[byteOf(s, t)];
    byte = static_cast<std::uint8_t>(byte & ~(1U << (t % 8)));
  }
  /// The bytes of a step: t = 0 in the lowest bit of the first.
  std::uint8_t* step(int s) { return &bytes_[static_cast<std::size_t>(s) * stride_]; }
  const std::uint8_t* step(int s) const { return &bytes_[static_cast<std::size_t>(s) * stride_]; }

 private:
  std::size_t byteOf(int s, int t) const {
    return static_cast<std::size_t>(s) * stride_ + static_cast<std::size_t>(t) / 8;
  }
  std::size_t stride_ = 0;  ///< bytes
  std::vector<std::uint8_t> bytes_;
};

/// The pixels of an edge map (as EdgeLines::edges) whose gradient points along +1 and -1 across
/// steep or flat lines.
struct EdgeBits {
  StepBits rising, falling;
};
EdgeBits edgeBits(const cv::Mat& edges, bool steep);

}  // namespace colonnade
