// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "entry_reader.hpp"
#include "frame_builder.hpp"
#include "odometry_track.hpp"

namespace mrpt::obs {
class CActionCollection;
class CObservation;
class CObservationBearingRange;
class CSensoryFrame;
}  // namespace mrpt::obs

namespace colonnade {

/// Puts the objects of a log together to frames. In a list of observations, image and depth join
/// when their stamps differ by at most kTogether_s and odometry is interpolated, for which a few
/// frames wait; a sensory frame is one frame and its odometry is the sum of the actions before it.
class FrameAssembler {
 public:
  static constexpr double kTogether_s = 0.02;
  static constexpr double kLate_s = 0.1;          ///< how far stamps of a list may be out of order
  static constexpr std::size_t kMostWaiting = 8;  ///< frames held back for odometry

  FrameAssembler(const std::filesystem::path& log, const SourceOptions& options, Damage& damage);
  ~FrameAssembler();

  void add(const Entry& entry);
  /// No entry will follow: what waits may go.
  void finish() { finishing_ = true; }
  const std::vector<std::string>& notes() const { return builder_.notes(); }
  bool finished() const { return finishing_ && waiting_.empty(); }
  /// The next frame that needs to wait no longer.
  std::optional<Frame> take();

 private:
  struct Candidate {
    double stamp_s = 0.0;
    std::shared_ptr<mrpt::obs::CObservation3DRangeScan> scan;
    std::shared_ptr<mrpt::obs::CObservationImage> image;
    std::shared_ptr<mrpt::obs::CObservationBearingRange> landmarks;
    MotionSum motion;  ///< since the former sensory frame
    bool from_sensory_frame = false;
    std::size_t entry = 0;
  };

  void addActions(const mrpt::obs::CActionCollection& actions);
  void addSensoryFrame(const mrpt::obs::CSensoryFrame& frame);
  void addObservation(const std::shared_ptr<mrpt::obs::CObservation>& observation);
  /// Puts an observation into a candidate that lacks its kind. False: it is of no use for frames.
  bool place(const std::shared_ptr<mrpt::obs::CObservation>& observation, Candidate& candidate);
  bool isChosenCamera(const mrpt::obs::CObservation& observation);
  void insert(Candidate candidate);
  bool isReady(const Candidate& candidate) const;
  std::optional<Frame> build(Candidate& candidate);
  void skip(const std::string& reason) { ++damage_.skipped[reason]; }

  SourceOptions options_;
  Damage& damage_;
  std::filesystem::path images_folder_;
  FrameBuilder builder_;
  MotionSum motion_;            ///< of the actions since the last sensory frame
  MotionSum motion_delivered_;  ///< since the last frame that was delivered
  Pose2 T_odom_robot_;
  bool motion_seen_ = false;
  std::size_t newest_entry_ = 0;
  OdometryTrack track_;
  std::deque<Candidate> waiting_;            ///< in the order of their stamps
  std::optional<std::string> camera_label_;  ///< of the camera in use
  std::optional<std::string> depth_label_;
  double newest_s_ = -1e300;
  double last_delivered_s_ = -1e300;
  bool finishing_ = false;
};

}  // namespace colonnade
