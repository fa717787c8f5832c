// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colour_sampling.hpp"

#include <cmath>
#include <cstdint>

namespace colonnade {

Eigen::Vector3f meanColourBeside(const Frame& frame, const RefinedLine& line, double begin,
                                 double end, int side) {
  const bool colour = frame.colour.type() == CV_8UC3 && !frame.colour.empty();
  const cv::Mat& image = colour ? frame.colour : frame.gray;
  constexpr int kSteps = 24;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  int count = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double s = begin + (end - begin) * i / kSteps;
    for (const int distance_px : {3, 4, 5}) {
      Eigen::Vector2d p = line.at(s);
      p[line.steep ? 0 : 1] += side * distance_px;
      const auto u = static_cast<int>(std::lround(p.x()));
      const auto v = static_cast<int>(std::lround(p.y()));
      if (u < 0 || v < 0 || u >= image.cols || v >= image.rows) continue;
      if (colour) {
        const auto& pixel = image.at<cv::Vec3b>(v, u);
        sum += Eigen::Vector3f(pixel[0], pixel[1], pixel[2]);
      } else {
        sum += Eigen::Vector3f::Constant(image.at<std::uint8_t>(v, u));
      }
      ++count;
    }
  }
  return count > 0 ? Eigen::Vector3f(sum / static_cast<float>(count)) : sum;
}

}  // namespace colonnade
