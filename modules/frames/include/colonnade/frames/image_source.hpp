// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "colonnade/frames/rawlog_source.hpp"

namespace colonnade {

/// One picture as a log of one frame without depth. Calibration, height and tilt come from the
/// options (section Camera), all of them, since a picture tells none.
class ImageSource : public FrameSource {
 public:
  /// Throws Error: the file cannot be read as a picture, or (kUsage) the options miss something.
  ImageSource(const std::filesystem::path& path, const SourceOptions& options);

  std::optional<Frame> next() override;
  const Damage& damage() const override { return damage_; }
  double progress() const override { return frame_ ? 0.0 : 1.0; }

  /// By the extension of its name.
  static bool isImage(const std::filesystem::path& path);

 private:
  std::optional<Frame> frame_;
  Damage damage_;
};

}  // namespace colonnade
