// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/options.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// The camera of the robot and how it is mounted. Depth and colour share it.
struct CameraOptions {
  static constexpr const char* kSection = "camera";
  int width_px = 320;
  int height_px = 240;
  double field_of_view =
      radians(58.0);        ///< horizontal; depth camera of the Kinect (its manual: 57)
  double forward_m = 0.10;  ///< optical centre from the robot's origin
  double left_m = 0.0;
  double height_m = 0.90;
  double pitch = radians(12.0);  ///< downwards
  double roll = 0.0;             ///< clockwise as the camera sees it: the right side sinks
  double rate_hz = 10.0;
  double drop_fraction = 0.0;   ///< of the frames that never reach the log; never the first one
  double stamp_jitter_s = 0.0;  ///< sigma of the instant of exposure about k / rate
  int jpeg_quality = 90;
  int supersampling = 0;  ///< rendered pixels per pixel and axis

  void visit(OptionVisitor& v) {
    v.integer("width_px", width_px, {32, 1920}, "image width");
    v.integer("height_px", height_px, {24, 1440}, "image height");
    v.angle("field_of_view_deg", field_of_view, {20, 120}, "horizontal field of view");
    v.number("forward_m", forward_m, {-2, 2}, "optical centre ahead of the robot's origin");
    v.number("left_m", left_m, {-2, 2}, "optical centre left of the robot's origin");
    v.number("height_m", height_m, {0.05, 3}, "optical centre above the floor");
    v.angle("pitch_deg", pitch, {-45, 60}, "downwards");
    v.angle("roll_deg", roll, {-45, 45}, "the right side of the camera sinks");
    v.number("rate_hz", rate_hz, {0.5, 60}, "frames per second");
    v.number("drop_fraction", drop_fraction, {0, 0.9}, "of the frames, lost before the log");
    v.number("stamp_jitter_s", stamp_jitter_s, {0, 0.5}, "sigma, cut off at 0.4 frame intervals");
    v.integer("jpeg_quality", jpeg_quality, {10, 100}, "of the colour images in the log");
    v.integer("supersampling", supersampling, {0, 5},
              "rendered pixels per pixel and axis; 0 = 3 up to 400 pixels wide, else 2");
  }

  /// Square pixels, the principal point in the middle of the image.
  PinholeCamera pinhole() const;
  Eigen::Isometry3d T_robot_camera() const;
  int renderedPerPixel() const;  ///< `supersampling`, with 0 resolved
};

/// A second camera without depth, logged as CObservationImage labelled MONO together with the
/// RGB-D frame nearest to its own schedule, at that frame's stamp.
struct MonoOptions {
  static constexpr const char* kSection = "mono";
  bool enabled = false;
  int width_px = 640;
  int height_px = 480;
  double field_of_view = radians(75.0);  ///< horizontal
  double forward_m = 0.15;               ///< optical centre from the robot's origin
  double left_m = 0.0;
  double height_m = 1.10;
  double yaw = 0.0;    ///< to the left
  double pitch = 0.0;  ///< downwards
  double roll = 0.0;   ///< the right side sinks
  double rate_hz = 5.0;

  void visit(OptionVisitor& v) {
    v.flag("enabled", enabled, "1: a second, plain camera");
    v.integer("width_px", width_px, {32, 1920}, "image width");
    v.integer("height_px", height_px, {24, 1440}, "image height");
    v.angle("field_of_view_deg", field_of_view, {20, 120}, "horizontal field of view");
    v.number("forward_m", forward_m, {-2, 2}, "optical centre ahead of the robot's origin");
    v.number("left_m", left_m, {-2, 2}, "optical centre left of the robot's origin");
    v.number("height_m", height_m, {0.05, 3}, "optical centre above the floor");
    v.angle("yaw_deg", yaw, {-180, 180}, "to the left");
    v.angle("pitch_deg", pitch, {-45, 60}, "downwards");
    v.angle("roll_deg", roll, {-45, 45}, "the right side of the camera sinks");
    v.number("rate_hz", rate_hz, {0.1, 60}, "images per second, at most those of the camera");
  }

  PinholeCamera pinhole() const;
  Eigen::Isometry3d T_robot_camera() const;
};

/// A structured-light depth sensor, by default the first Kinect.
///   axial noise    Nguyen, Izadi and Lovell, "Modeling Kinect sensor noise for improved 3D
///                  reconstruction and tracking", 2012: sigma = a + b (z - 0.4 m)^2 metres in all,
///                  the rounding of disparity and of millimetres included; the same paper adds
///                  c / sqrt(z) * (theta / (pi/2 - theta))^2 for the angle of incidence theta
///   lateral noise  the same paper: sigma = d + e * theta / (pi/2 - theta) pixels of a 640 pixel
///                  wide image, by which outlines fray
///   disparity      Konolige and Mihelich, "Technical description of Kinect calibration": steps of
///                  1/8 pixel, 7.5 cm from projector to camera, which also makes the shadows
///   range          Khoshelham and Oude Elberink, "Accuracy and resolution of Kinect depth data",
///                  2012: 0.5 m to 5 m; a little more is let through here, as drivers do
/// Correlation, grazing angles and losses are plausible choices, not published figures.
struct DepthOptions {
  static constexpr const char* kSection = "depth";
  bool enabled = true;
  double range_min_m = 0.5;
  double range_max_m = 6.0;
  double noise_floor_m = 0.0012;         ///< a
  double noise_growth_per_m = 0.0019;    ///< b
  double noise_grazing_m = 0.0;          ///< c, metres times sqrt(m); the paper has 0.0001
  double noise_correlation_px = 0.8;     ///< sigma of the blur of the disparity noise
  double lateral_px = 0.8;               ///< d
  double lateral_grazing_px = 0.035;     ///< e
  double baseline_m = 0.075;             ///< projector to the right of the camera
  double disparity_steps_per_px = 8.0;   ///< per pixel of a 640 pixel wide sensor; 0 = no rounding
  double grazing_start = radians(80.0);  ///< angle of incidence from which returns are lost
  double grazing_end = radians(87.0);    ///< and at which all are
  double edge_loss_fraction = 0.5;       ///< of the pixels at a jump of depth
  double loss_fraction = 0.002;          ///< single pixels lost anywhere

  void visit(OptionVisitor& v) {
    v.flag("enabled", enabled, "0: no depth images");
    v.number("range_min_m", range_min_m, {0.05, 5}, "nearest depth");
    v.number("range_max_m", range_max_m, {0.5, 30}, "farthest depth");
    v.number("noise_floor_m", noise_floor_m, {0, 0.1}, "sigma at 0.4 m");
    v.number("noise_growth_per_m", noise_growth_per_m, {0, 0.1}, "growth with (z - 0.4 m)^2");
    v.number("noise_grazing_m", noise_grazing_m, {0, 0.01}, "growth with the angle of incidence");
    v.number("noise_correlation_px", noise_correlation_px, {0, 5}, "blur of the noise");
    v.number("lateral_px", lateral_px, {0, 5}, "sigma of outlines, pixels of 640");
    v.number("lateral_grazing_px", lateral_grazing_px, {0, 1}, "its growth with the incidence");
    v.number("baseline_m", baseline_m, {0, 0.5}, "projector to camera; 0 = no shadows");
    v.number("disparity_steps_per_px", disparity_steps_per_px, {0, 64}, "0 = no rounding");
    v.angle("grazing_start_deg", grazing_start, {0, 90}, "incidence at which losses begin");
    v.angle("grazing_end_deg", grazing_end, {0, 90}, "incidence at which all is lost");
    v.number("edge_loss_fraction", edge_loss_fraction, {0, 1}, "lost at jumps of depth");
    v.number("loss_fraction", loss_fraction, {0, 1}, "single pixels lost");
  }
};

/// A colour camera: lens blur, vignetting, shot and read noise, and an exposure that wanders and,
/// if asked, follows the light. A level of light L becomes the gray level g L, with a noise of
/// sigma^2 = (g read)^2 + g shot^2 (g L): gain amplifies it, so dusk is noisier than day.
/// All figures are choices that look like a cheap camera, not published ones.
struct ColourOptions {
  static constexpr const char* kSection = "colour";
  double blur_px = 0.5;
  double vignetting = 0.25;           ///< light lost in the corners
  double read_noise = 1.5;            ///< sigma in gray levels at black
  double shot_noise = 0.12;           ///< sigma per square root of gray level
  double chroma_noise = 0.5;          ///< share of the noise that differs between colours
  double exposure_noise = 0.01;       ///< relative sigma of the wandering gain
  double exposure_noise_s = 1.0;      ///< after which it has forgotten itself; 0 = every frame
  bool auto_exposure = false;         ///< else the gain is 1 but for the wandering
  double exposure_target = 110.0;     ///< mean gray level that auto-exposure seeks
  double exposure_lag_s = 0.4;        ///< time constant of its reaction
  double exposure_gain_limit = 16.0;  ///< largest gain, and one over the smallest

  void visit(OptionVisitor& v) {
    v.number("blur_px", blur_px, {0, 10}, "sigma of the lens blur");
    v.number("vignetting", vignetting, {0, 1}, "light lost in the corners");
    v.number("read_noise", read_noise, {0, 50}, "sigma at black, gray levels");
    v.number("shot_noise", shot_noise, {0, 5}, "sigma per square root of gray level");
    v.number("chroma_noise", chroma_noise, {0, 1}, "share that differs between colours");
    v.number("exposure_noise", exposure_noise, {0, 0.5}, "relative sigma of the gain");
    v.number("exposure_noise_s", exposure_noise_s, {0, 100}, "correlation time; 0 = none");
    v.flag("auto_exposure", auto_exposure, "1: the gain follows the light");
    v.number("exposure_target", exposure_target, {1, 250}, "mean gray level sought");
    v.number("exposure_lag_s", exposure_lag_s, {0, 30}, "time constant of auto-exposure");
    v.number("exposure_gain_limit", exposure_gain_limit, {1, 100}, "largest gain");
  }
};

/// Wheel odometry. Systematic errors stay the same over a run: distances are read (1 + scale) times
/// too long, headings turn by turn_bias per metre and turns are read (1 + turn_scale) times. Random
/// errors are random walks: sigma grows with the square root of the distance (or of the angle).
struct OdometryOptions {
  static constexpr const char* kSection = "odometry";
  double scale = 0.025;
  double turn_bias_per_m = radians(0.7);
  double turn_scale = 0.01;
  double forward_noise_m = 0.010;            ///< per sqrt(m)
  double sideways_noise_m = 0.004;           ///< per sqrt(m)
  double turn_noise_per_m = radians(0.4);    ///< per sqrt(m)
  double turn_noise_per_rad = radians(1.0);  ///< per sqrt(rad)
  /// The log states a covariance that also covers the systematic errors, as if they were drawn
  /// anew after each such distance.
  double stated_correlation_m = 1.0;

  void visit(OptionVisitor& v) {
    v.number("scale", scale, {-0.3, 0.3}, "distances read too long, relative");
    v.angle("turn_bias_deg_per_m", turn_bias_per_m, {-20, 20}, "heading drift, degrees per metre");
    v.number("turn_scale", turn_scale, {-0.3, 0.3}, "turns read too wide, relative");
    v.number("forward_noise_m", forward_noise_m, {0, 1}, "sigma per square root of a metre");
    v.number("sideways_noise_m", sideways_noise_m, {0, 1}, "sigma per square root of a metre");
    v.angle("turn_noise_deg_per_m", turn_noise_per_m, {0, 20}, "sigma per square root of a metre");
    v.angle("turn_noise_deg_per_rad", turn_noise_per_rad, {0, 20},
            "sigma per square root of a radian");
    v.number("stated_correlation_m", stated_correlation_m, {0, 100}, "of systematic errors");
  }
};

}  // namespace colonnade
