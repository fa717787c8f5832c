// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/options.hpp"
#include "colonnade/frames/frame_source.hpp"

namespace colonnade {

/// What a log does not say, or says wrongly, about its camera.
struct SourceOptions {
  static constexpr const char* kSection = "Camera";
  double fx_px = 0.0;  ///< 0: from the log; the four belong together
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  double height_m = 0.0;  ///< of the optical centre above the floor; 0: from the log
  std::string tilt = "log";
  double pitch = 0.0;  ///< used with tilt = given; positive looks down
  double roll = 0.0;   ///< used with tilt = given; positive: the right side of the camera is lower
  std::string depth_alignment = "auto";
  std::string sensor_label;  ///< the camera to use where a log has several; empty: the first one

  void visit(OptionVisitor& v) {
    v.number("fx_px", fx_px, {0, 1e5}, "focal length; 0 = from the log (give all four or none)");
    v.number("fy_px", fy_px, {0, 1e5}, "focal length; 0 = from the log");
    v.number("cx_px", cx_px, {0, 1e5}, "principal point; 0 = from the log");
    v.number("cy_px", cy_px, {0, 1e5}, "principal point; 0 = from the log");
    v.number("height_m", height_m, {0, 10}, "of the camera above the floor; 0 = from the log");
    v.choice("tilt", tilt, {"log", "given"}, "where pitch and roll of the camera come from");
    v.angle("pitch_deg", pitch, {-80, 80}, "with tilt = given: positive looks down");
    v.angle("roll_deg", roll, {-80, 80}, "with tilt = given: positive lowers the right side");
    v.choice("depth_alignment", depth_alignment, {"auto", "log", "pixels"},
             "depth to colour: by the log's calibration, pixel by pixel (registered by the camera "
             "itself), or whichever puts depth jumps on image edges");
  }
};

/// Frames from an MRPT rawlog, plain or gz, in either format (action and sensory-frame pairs, or a
/// list of observations). Streams: memory does not depend on the length of the log.
///
/// Colour and depth come from CObservation3DRangeScan, or from CObservationImage (colour) and a
/// CObservation3DRangeScan without intensity (depth) whose stamps differ by at most 0.02 s. Lens
/// distortion is removed; depth is registered to the colour camera where the two do not coincide.
/// Some drivers log depth the camera has registered already together with the calibration of the
/// raw sensors (MRPT's own example does): with depth_alignment = auto the first frames decide by
/// where depth jumps and image edges meet, and notes() tells. Odometry comes from
/// CActionRobotMovement2D/3D (summed up) or CObservationOdometry (interpolated at the stamp of the
/// frame; gaps over 1 s are not bridged). CObservationBearingRange fills `Frame::range_bearing`.
/// Everything else is counted in `Damage::ignored`.
class RawlogSource : public FrameSource {
 public:
  /// Throws Error when `path` is no readable rawlog or the options contradict each other.
  explicit RawlogSource(const std::filesystem::path& path, const SourceOptions& options = {});
  ~RawlogSource() override;

  /// Throws Error(kUsage) at the first camera frame when neither log nor options calibrate it.
  std::optional<Frame> next() override;
  const Damage& damage() const override;
  double progress() const override;
  /// What the source decided against the word of the log, one line each.
  const std::vector<std::string>& notes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colonnade
