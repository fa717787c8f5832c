// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/frames/image_source.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "colonnade/base/error.hpp"
#include "frame_builder.hpp"

namespace colonnade {

ImageSource::ImageSource(const std::filesystem::path& path, const SourceOptions& options) {
  if (options.fx_px <= 0.0 || options.height_m <= 0.0 || options.tilt != "given")
    throw Error(path.string() +
                    ": a picture tells nothing of its camera; give --set Camera.fx_px=, fy_px, "
                    "cx_px, cy_px, height_m, tilt=given, pitch_deg and roll_deg",
                ExitCode::kUsage);
  ImageView view;
  if (std::filesystem::is_regular_file(path)) view.pixels = cv::imread(path.string());
  if (view.pixels.empty()) throw Error(path.string() + ": no picture that can be read");
  view.T_robot_camera.linear() = opticalAxes();
  frame_.emplace();
  std::string problem;
  if (!FrameBuilder(options).build(view, std::nullopt, *frame_, &problem))
    throw Error(path.string() + ": " + problem);
}

std::optional<Frame> ImageSource::next() {
  if (frame_) {
    damage_.entries_read = 1;
  } else {
    damage_.ending = LogEnding::kEnd;
  }
  return std::exchange(frame_, std::nullopt);
}

bool ImageSource::isImage(const std::filesystem::path& path) {
  constexpr std::array kExtensions{".png", ".jpg",  ".jpeg", ".bmp",
                                   ".tif", ".tiff", ".ppm",  ".pgm"};
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

}  // namespace colonnade
