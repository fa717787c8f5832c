// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera_views.hpp"
#include "colonnade/frames/rawlog_source.hpp"

namespace colonnade {

/// Makes the images of a frame from what the log holds: overrides of the options, undistortion,
/// depth in metres, registration of depth to the colour camera. Maps and tables are kept from frame
/// to frame as long as the calibration stays the same.
class FrameBuilder {
 public:
  explicit FrameBuilder(const SourceOptions& options);
  ~FrameBuilder();

  /// Fills images, camera and T_robot_camera. False with `problem` set when the calibration does
  /// not fit the image. Throws Error(kUsage) when there is no calibration at all.
  bool build(const std::optional<ImageView>& image, const std::optional<RangeImageView>& depth,
             Frame& frame, std::string* problem);

  /// What was decided against the word of the log.
  const std::vector<std::string>& notes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colonnade
