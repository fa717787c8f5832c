// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colour_sampling.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "nearest_pixel.hpp"

namespace colonnade {
namespace {

constexpr int kSteps = 24;
constexpr std::array<int, 3> kDistances_px{3, 4, 5};

template <int kChannels>
BesideColours average(const cv::Mat& image, const RefinedLine& line, double begin, double end) {
  std::array<std::array<int, kChannels>, 2> sums{};
  std::array<int, 2> counts{};
  const int across_end = line.steep ? image.cols : image.rows;
  const int along_end = line.steep ? image.rows : image.cols;
  const auto pixel = static_cast<std::ptrdiff_t>(image.elemSize());
  const auto row = static_cast<std::ptrdiff_t>(image.step[0]);
  const std::ptrdiff_t across_step = line.steep ? pixel : row;
  const std::ptrdiff_t along_step = line.steep ? row : pixel;
  for (int i = 0; i <= kSteps; ++i) {
    const double place = begin + (end - begin) * i / kSteps;
    const int s = roundToInt(place), t = roundToInt(line.across(place));
    if (s < 0 || s >= along_end) continue;
    const std::uint8_t* const line_of_pixels = image.data + s * along_step;
    for (std::size_t side = 0; side < 2; ++side) {
      for (const int distance_px : kDistances_px) {
        const int beside = side == 0 ? t - distance_px : t + distance_px;
        if (beside < 0 || beside >= across_end) continue;
        const std::uint8_t* const p = line_of_pixels + beside * across_step;
        for (std::size_t c = 0; c < kChannels; ++c) sums[side][c] += p[c];
        ++counts[side];
      }
    }
  }
  const auto mean = [&](std::size_t side) -> Eigen::Vector3f {
    Eigen::Vector3f sum;
    for (std::size_t c = 0; c < 3; ++c)
      sum[static_cast<Eigen::Index>(c)] = static_cast<float>(sums[side][c % kChannels]);
    return sum / static_cast<float>(std::max(counts[side], 1));
  };
  return {mean(0), mean(1)};
}

}  // namespace

BesideColours coloursBeside(const Frame& frame, const RefinedLine& line, double begin, double end) {
  const bool colour = frame.colour.type() == CV_8UC3 && !frame.colour.empty();
  return colour ? average<3>(frame.colour, line, begin, end)
                : average<1>(frame.gray, line, begin, end);
}

}  // namespace colonnade
