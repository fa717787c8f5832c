// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "canny.hpp"

#include <algorithm>
#include <bit>

#include "hysteresis.hpp"
#include "row_kernels.hpp"

namespace colonnade::fixed {
namespace {

/// The last rows of a stage: row r stays until row r + Rows overwrites it.
template <typename T, int Rows>
class RowRing {
 public:
  explicit RowRing(int width) : stride_(width + 2 * kPad), data_(Rows * stride_) {}
  T* row(int r) { return data_.data() + (r % Rows) * stride_ + kPad; }

 private:
  std::ptrdiff_t stride_;
  std::vector<T> data_;
};

/// Everything up to suppression, row by row: each stage runs as many rows ahead as the next needs.
class Suppression {
 public:
  Suppression(const cv::Mat& gray, const FixedParameters& parameters)
      : gray_(gray),
        parameters_(parameters),
        width_(gray.cols),
        height_(gray.rows),
        sums_(static_cast<std::size_t>(width_ + 2 * kPad)),
        zeros_(static_cast<std::size_t>(width_ + 2 * kPad)),
        strong_(static_cast<std::size_t>(width_)),
        blurred_(width_),
        magnitude_(width_),
        sector_(width_) {}

  void run(cv::Mat& codes, std::vector<std::uint64_t>& candidates,
           std::vector<std::uint64_t>& strong, int words_per_row) {
    for (int row = 0; row < height_ + 3; ++row) {
      if (row < height_) blur(row);
      if (row >= 1 && row - 1 < height_) gradient(row - 1);
      if (row < 2 || row - 2 >= height_) continue;
      auto* code = codes.ptr<std::uint8_t>(row - 2);
      suppress(row - 2, code);
      packBits(code, width_, candidates.data() + (row - 2) * words_per_row);
      packBits(strong_.data(), width_, strong.data() + (row - 2) * words_per_row);
    }
  }

 private:
  void blur(int row) {
    const std::uint8_t* rows[5];
    for (int i = 0; i < 5; ++i) {
      rows[i] = gray_.ptr<std::uint8_t>(std::clamp(row + i - 2, 0, height_ - 1));
    }
    blurRow(rows, width_, sums_.data(), blurred_.row(row));
  }
  void gradient(int row) {
    gradientRow(blurred_.row(std::max(row - 1, 0)), blurred_.row(row),
                blurred_.row(std::min(row + 1, height_ - 1)), width_, magnitude_.row(row),
                sector_.row(row));
    magnitude_.row(row)[-1] = magnitude_.row(row)[width_] = 0;
  }
  void suppress(int row, std::uint8_t* code) {
    const std::uint16_t* nothing = zeros_.data() + kPad;
    suppressRow(row > 0 ? magnitude_.row(row - 1) : nothing, magnitude_.row(row),
                row + 1 < height_ ? magnitude_.row(row + 1) : nothing, sector_.row(row), width_,
                parameters_.low, parameters_.high, code, strong_.data());
  }

  const cv::Mat& gray_;
  const FixedParameters& parameters_;
  int width_;
  int height_;
  std::vector<std::uint16_t> sums_;
  std::vector<std::uint16_t> zeros_;
  std::vector<std::uint8_t> strong_;
  RowRing<std::uint8_t, 4> blurred_;
  RowRing<std::uint16_t, 4> magnitude_;
  RowRing<std::uint16_t, 4> sector_;
};

}  // namespace

CannyResult canny(const cv::Mat& gray, const FixedParameters& parameters, int hysteresis_passes) {
  const int words_per_row = (gray.cols + 63) / 64;
  const auto words = static_cast<std::size_t>(gray.rows) * static_cast<std::size_t>(words_per_row);
  std::vector<std::uint64_t> candidates(words);
  std::vector<std::uint64_t> strong(words);
  CannyResult result;
  result.edges.create(gray.size(), CV_8UC1);
  Suppression(gray, parameters).run(result.edges, candidates, strong, words_per_row);
  hysteresis(candidates.data(), strong.data(), gray.rows, words_per_row, hysteresis_passes);
  std::size_t pixels = 0;
  for (const std::uint64_t word : strong) pixels += static_cast<std::size_t>(std::popcount(word));
  for (auto& some : result.of_direction) some.reserve(pixels);
  for (int row = 0; row < gray.rows; ++row) {
    auto* code = result.edges.ptr<std::uint8_t>(row);
    for (int i = 0; i < words_per_row; ++i) {
      const std::size_t at = static_cast<std::size_t>(row * words_per_row + i);
      for (std::uint64_t weak = candidates[at] & ~strong[at]; weak != 0; weak &= weak - 1) {
        code[64 * i + std::countr_zero(weak)] = 0;
      }
      for (std::uint64_t rest = strong[at]; rest != 0; rest &= rest - 1) {
        const int column = 64 * i + std::countr_zero(rest);
        result.of_direction[(code[column] - 1) & 3].push_back(
            {static_cast<std::int16_t>(column - gray.cols / 2),
             static_cast<std::int16_t>(row - gray.rows / 2)});
      }
    }
  }
  return result;
}

}  // namespace colonnade::fixed
