// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
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
  /// Calls take(t) for every bit of a step that is set.
  template <class Take>
  void each(int s, Take&& take) const {
    const std::size_t first = static_cast<std::size_t>(s) * stride_;
    for (std::size_t i = 0; i < stride_; i += sizeof(std::uint64_t)) {
      std::uint64_t word;
      std::memcpy(&word, &bytes_[first + i], sizeof word);
      const std::size_t left = 8 * (stride_ - i);  // the next step follows
      if (left < 64) word &= (std::uint64_t{1} << left) - 1;
      for (; word != 0; word &= word - 1) take(static_cast<int>(8 * i) + std::countr_zero(word));
    }
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
struct BitsOfBoth {
  EdgeBits steep;  ///< the steps are rows
  EdgeBits flat;   ///< the steps are columns
};
BitsOfBoth bitsOfBoth(const cv::Mat& edges);
/// Those of steep lines in one row; the bits there must be zero before.
void setSteepBits(const std::uint8_t* edges, int columns, int row, EdgeBits& bits);

}  // namespace colonnade
