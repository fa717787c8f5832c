// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "frame_builder.hpp"

#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>

#include "colonnade/base/error.hpp"
#include "depth_registration.hpp"
#include "edge_agreement.hpp"
#include "lens.hpp"

namespace colonnade {
namespace {

std::string sizeText(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

/// Fits the calibration to the size of the image, when the two have the same proportions.
bool fit(Calibration& calibration, const cv::Mat& pixels, std::string* problem) {
  auto& c = calibration.pinhole;
  if (c.width_px == pixels.cols && c.height_px == pixels.rows) return true;
  if (c.width_px <= 0 || c.height_px <= 0 ||
      static_cast<std::int64_t>(c.width_px) * pixels.rows !=
          static_cast<std::int64_t>(c.height_px) * pixels.cols) {
    *problem = "calibration for " + sizeText(c.width_px, c.height_px) +
               " does not fit the image of " + sizeText(pixels.cols, pixels.rows);
    return false;
  }
  // Pixel centres have whole coordinates, so the image's corner is at -0.5.
  const double scale = static_cast<double>(pixels.cols) / c.width_px;
  c.fx_px *= scale;
  c.fy_px *= scale;
  c.cx_px = (c.cx_px + 0.5) * scale - 0.5;
  c.cy_px = (c.cy_px + 0.5) * scale - 0.5;
  c.width_px = pixels.cols;
  c.height_px = pixels.rows;
  return true;
}

/// MRPT's untouched TCamera has focal lengths of 0, older ones of 1.
bool isGiven(const Calibration& calibration) {
  return calibration.pinhole.fx_px > 1.0 && calibration.pinhole.fy_px > 1.0;
}

bool isSound(const PinholeCamera& c) {
  // A focal length under a tenth or over 30 widths is no camera a robot carries.
  const double width = c.width_px;
  return std::isfinite(c.fx_px) && std::isfinite(c.fy_px) && std::isfinite(c.cx_px) &&
         std::isfinite(c.cy_px) && c.fx_px > 0.1 * width && c.fx_px < 30 * width &&
         c.fy_px > 0.1 * width && c.fy_px < 30 * width && std::abs(c.cx_px) < 4 * width &&
         std::abs(c.cy_px) < 4 * width;
}

bool coincide(const PinholeCamera& a, const PinholeCamera& b, const Eigen::Isometry3d& T_a_b) {
  constexpr double kPixels = 0.02, kMetres = 1e-4, kRadians = 1e-4;
  return a.width_px == b.width_px && a.height_px == b.height_px &&
         std::abs(a.fx_px - b.fx_px) < kPixels && std::abs(a.fy_px - b.fy_px) < kPixels &&
         std::abs(a.cx_px - b.cx_px) < kPixels && std::abs(a.cy_px - b.cy_px) < kPixels &&
         T_a_b.translation().norm() < kMetres &&
         std::abs(Eigen::AngleAxisd(T_a_b.linear()).angle()) < kRadians;
}

}  // namespace

struct FrameBuilder::Impl {
  explicit Impl(const SourceOptions& source_options) : options(source_options) {
    const bool any =
        options.fx_px > 0 || options.fy_px > 0 || options.cx_px > 0 || options.cy_px > 0;
    overridden = options.fx_px > 0 && options.fy_px > 0 && options.cx_px > 0 && options.cy_px > 0;
    if (any && !overridden)
      throw Error("Camera.fx_px, fy_px, cx_px and cy_px belong together: give all four",
                  ExitCode::kUsage);
    if (options.tilt != "given" && (options.pitch != 0.0 || options.roll != 0.0))
      throw Error("Camera.pitch_deg and roll_deg count only with --set Camera.tilt=given",
                  ExitCode::kUsage);
  }

  /// The calibration to use, or false when it does not fit.
  bool calibrate(Calibration& calibration, const cv::Mat& pixels, std::string* problem) const {
    if (overridden) {
      calibration = Calibration{};
      calibration.pinhole = {pixels.cols,   pixels.rows,   options.fx_px,
                             options.fy_px, options.cx_px, options.cy_px};
      return true;
    }
    if (!isGiven(calibration))
      throw Error(
          "the log does not calibrate its camera; give --set Camera.fx_px=... Camera.fy_px=... "
          "Camera.cx_px=... Camera.cy_px=... (pixels)",
          ExitCode::kUsage);
    if (!fit(calibration, pixels, problem)) return false;
    if (isSound(calibration.pinhole)) return true;
    *problem = "absurd camera calibration";
    return false;
  }

  /// Height and tilt of the options in place of the log's.
  Eigen::Isometry3d mounted(Eigen::Isometry3d T_robot_camera) const {
    if (options.height_m > 0.0) T_robot_camera.translation().z() = options.height_m;
    if (options.tilt == "given") {
      const Eigen::Vector3d forward = T_robot_camera.linear().col(2);
      const double yaw = std::atan2(forward.y(), forward.x());
      T_robot_camera.linear() = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(options.pitch, Eigen::Vector3d::UnitY()) *
                                 Eigen::AngleAxisd(options.roll, Eigen::Vector3d::UnitX()))
                                    .toRotationMatrix() *
                                opticalAxes();
    }
    return T_robot_camera;
  }

  static cv::Mat metres(const RangeImageView& view, const Calibration& calibration,
                        Undistorter& lens) {
    cv::Mat depth;
    view.units.convertTo(depth, CV_32F, view.metres_per_unit);
    depth = lens.depth(depth, calibration);
    if (!view.along_axis) alongAxis(depth, calibration.pinhole);
    return depth;
  }

  /// Distance along the ray -> distance along the optical axis.
  static void alongAxis(cv::Mat& depth, const PinholeCamera& camera) {
    for (int v = 0; v < depth.rows; ++v) {
      auto* line = depth.ptr<float>(v);
      for (int u = 0; u < depth.cols; ++u)
        line[u] = static_cast<float>(line[u] / camera.ray(u, v).norm());
    }
  }

  void addImage(const ImageView& image, const Calibration& calibration, Frame& frame) {
    const cv::Mat pixels = image_lens.image(image.pixels, calibration);
    if (pixels.channels() == 3) {
      frame.colour = pixels;
      cv::cvtColor(pixels, frame.gray, cv::COLOR_BGR2GRAY);
    } else {
      frame.gray = pixels;
    }
    frame.camera = calibration.pinhole;
    frame.T_robot_camera = image.T_robot_camera;
  }

  /// Depth in metres on the pixels of the image.
  cv::Mat seenFromImage(const RangeImageView& depth, const ImageView& image,
                        const Calibration& colour, const Frame& frame) {
    const Eigen::Isometry3d T_camera_depth = image.T_robot_camera.inverse() * depth.T_robot_camera;
    const bool same_size = depth.units.size() == image.pixels.size();
    const auto by_log = [&] {
      return registration.registered(metres(depth, depth.calibration, depth_lens),
                                     depth.calibration.pinhole, frame.camera, T_camera_depth);
    };
    // Registered by the camera itself: depth has the pixels, and the lens, of the colour image.
    const auto by_pixels = [&] { return metres(depth, colour, image_lens); };
    if (coincide(frame.camera, depth.calibration.pinhole, T_camera_depth) &&
        depth.calibration.lens == colour.lens)
      return metres(depth, depth.calibration, depth_lens);
    if (options.depth_alignment == "pixels" && same_size) return by_pixels();
    if (options.depth_alignment == "log" || !same_size || alignment == Alignment::kLog)
      return by_log();
    if (alignment == Alignment::kPixels) return by_pixels();
    return decideAlignment(by_log(), by_pixels(), frame.gray);
  }

  /// Compares where depth jumps with where the picture has edges. Remembers the answer once the
  /// difference is clear; until then the log is believed.
  cv::Mat decideAlignment(const cv::Mat& by_log, const cv::Mat& by_pixels, const cv::Mat& gray) {
    constexpr int kLeastJumps = 500;
    constexpr double kClearly = 1.15;
    const auto log = edgeAgreement(by_log, gray), pixels = edgeAgreement(by_pixels, gray);
    if (log.jumps < kLeastJumps || pixels.jumps < kLeastJumps) return by_log;
    if (pixels.strength > kClearly * log.strength) {
      alignment = Alignment::kPixels;
      notes.push_back(
          "depth lies on the pixels of the colour image already, against the calibration in the "
          "log "
          "(--set Camera.depth_alignment=log to insist on the calibration)");
      return by_pixels;
    }
    if (log.strength > kClearly * pixels.strength) alignment = Alignment::kLog;
    return by_log;
  }

  enum class Alignment { kOpen, kLog, kPixels };

  SourceOptions options;
  bool overridden = false;
  Alignment alignment = Alignment::kOpen;
  std::vector<std::string> notes;
  Undistorter image_lens, depth_lens;
  DepthRegistration registration;
};

FrameBuilder::FrameBuilder(const SourceOptions& options) : impl_(std::make_unique<Impl>(options)) {}
FrameBuilder::~FrameBuilder() = default;

const std::vector<std::string>& FrameBuilder::notes() const { return impl_->notes; }

bool FrameBuilder::build(const std::optional<ImageView>& image,
                         const std::optional<RangeImageView>& depth, Frame& frame,
                         std::string* problem) {
  Impl& s = *impl_;
  if (!image && !depth) return true;
  Calibration colour;
  if (image) {
    colour = image->calibration;
    const bool borrow =
        !isGiven(colour) && depth && depth->T_robot_camera.isApprox(image->T_robot_camera, 1e-6);
    if (borrow) colour = depth->calibration;
    if (!s.calibrate(colour, image->pixels, problem)) return false;
    s.addImage(*image, colour, frame);
  }
  if (depth) {
    RangeImageView view = *depth;
    if (!isGiven(view.calibration) && image) view.calibration = colour;
    const bool calibrated = s.calibrate(view.calibration, view.units, problem);
    if (!calibrated && !image) return false;
    if (!image) {
      frame.depth_m = s.metres(view, view.calibration, s.depth_lens);
      frame.camera = view.calibration.pinhole;
      frame.T_robot_camera = view.T_robot_camera;
    } else if (calibrated) {
      frame.depth_m = s.seenFromImage(view, *image, colour, frame);
    }
  }
  frame.T_robot_camera = s.mounted(frame.T_robot_camera);
  return true;
}

}  // namespace colonnade
