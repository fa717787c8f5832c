// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>

namespace colonnade {

/// Pictures into a Motion-JPEG film in AVI, which every player opens and OpenCV writes by itself.
/// It plays at the mean rate of its first ten pictures. The file has its name only once it is
/// complete.
class DetectVideo {
 public:
  /// Throws Error (kUsage) unless the name ends in .avi; the file must not exist.
  explicit DetectVideo(const std::filesystem::path& file);
  ~DetectVideo();

  /// Pictures of one size, CV_8UC3. Throws Error when the file cannot be written.
  void add(double stamp_s, const cv::Mat& picture);
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colonnade
