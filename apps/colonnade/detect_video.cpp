// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "detect_video.hpp"

#include <algorithm>
#include <opencv2/videoio.hpp>
#include <utility>
#include <vector>

#include "colonnade/base/error.hpp"

namespace colonnade {
namespace {

constexpr std::size_t kForRate = 10;  ///< pictures held back until the rate is known
constexpr double kDefaultRate_hz = 10.0;

}  // namespace

struct DetectVideo::Impl {
  std::filesystem::path file, part;
  std::vector<std::pair<double, cv::Mat>> held;
  cv::VideoWriter writer;

  double rate() const {
    const double span_s = held.back().first - held.front().first;
    if (held.size() < 2 || !(span_s > 0.0)) return kDefaultRate_hz;
    return std::clamp(static_cast<double>(held.size() - 1) / span_s, 1.0, 60.0);
  }
  void start() {
    const bool open = writer.open(part.string(), cv::CAP_OPENCV_MJPEG,
                                  cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), rate(),
                                  held.front().second.size());
    if (!open) throw Error(file.string() + ": cannot be written");
    for (const auto& [stamp_s, picture] : held) writer.write(picture);
    held.clear();
  }
};

DetectVideo::DetectVideo(const std::filesystem::path& file) : impl_(std::make_unique<Impl>()) {
  if (file.extension() != ".avi")
    throw Error(file.string() + ": films are written as .avi (Motion-JPEG)", ExitCode::kUsage);
  if (std::filesystem::exists(file))
    throw Error(file.string() + ": exists already; nothing is overwritten", ExitCode::kUsage);
  impl_->file = file;
  impl_->part = file;
  impl_->part.replace_extension(".part.avi");
}
DetectVideo::~DetectVideo() = default;

void DetectVideo::add(double stamp_s, const cv::Mat& picture) {
  if (impl_->writer.isOpened()) {
    impl_->writer.write(picture);
    return;
  }
  impl_->held.emplace_back(stamp_s, picture.clone());
  if (impl_->held.size() >= kForRate) impl_->start();
}

void DetectVideo::close() {
  if (!impl_->writer.isOpened() && impl_->held.empty()) return;
  if (!impl_->writer.isOpened()) impl_->start();
  impl_->writer.release();
  std::filesystem::rename(impl_->part, impl_->file);
}

}  // namespace colonnade
