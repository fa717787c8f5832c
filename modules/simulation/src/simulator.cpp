// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/simulator.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <thread>

#include "capture_times.hpp"
#include "colonnade/base/log_path.hpp"
#include "colonnade/base/trajectory.hpp"
#include "colonnade/maps/landmark_csv.hpp"
#include "colonnade/simulation/drive.hpp"
#include "colonnade/simulation/floor_plan.hpp"
#include "hand_over.hpp"
#include "recorder.hpp"

namespace colonnade {
namespace {

/// The frames of a drive, drawn one after the other.
class Drive {
 public:
  Drive(const World& world, const Building& building, std::uint64_t seed)
      : world_(world),
        times_(captureTimes(world.camera, driveDuration(world.route), seed)),
        poses_(posesAt(world.route, times_)),
        renderer_(world, building) {}

  std::size_t size() const { return times_.size(); }

  TrueFrame next() {
    const auto i = next_++;
    const auto before = i > 0 ? i - 1 : 0;
    driven_m_ += (poses_[i].translation() - poses_[before].translation()).norm();
    TrueFrame frame{.index = i,
                    .time_s = times_[i],
                    .interval_s = times_[i] - times_[before],
                    .driven_m = driven_m_,
                    .T_world_robot = poses_[i],
                    .T_previous_robot = poses_[before].inverse() * poses_[i]};
    const Eigen::Isometry3d T_world_robot = poses_[i].toIsometry3();
    frame.view = renderer_.render(T_world_robot * world_.camera.T_robot_camera(), times_[i]);
    if (monoIsDue(i)) {
      frame.mono = renderer_.renderMono(T_world_robot * world_.mono.T_robot_camera(), times_[i]);
    }
    return frame;
  }

 private:
  /// The second camera's k-th image belongs to the frame nearest to k / rate_hz.
  bool monoIsDue(std::size_t i) const {
    if (!world_.mono.enabled) return false;
    if (i == 0) return true;
    const auto planned = [&](double time_s) { return std::floor(time_s * world_.mono.rate_hz); };
    const double half_s = 0.5 / world_.camera.rate_hz;
    return planned(times_[i] + half_s) > planned(times_[i - 1] + half_s);
  }

  const World& world_;
  std::vector<double> times_;
  std::vector<Pose2> poses_;
  Renderer renderer_;
  std::size_t next_ = 0;
  double driven_m_ = 0.0;
};

/// Draws in this thread, measures and writes in another.
void recordPipelined(Drive& drive, const std::function<void(TrueFrame)>& record) {
  HandOver<TrueFrame> frames(2);
  std::exception_ptr failure;
  std::thread recorder([&] {
    try {
      while (auto frame = frames.take()) record(std::move(*frame));
    } catch (...) {
      failure = std::current_exception();
      frames.close();
    }
  });
  try {
    for (std::size_t i = 0; i < drive.size() && frames.give(drive.next()); ++i) continue;
  } catch (...) {
    frames.close();
    recorder.join();
    throw;
  }
  frames.close();
  recorder.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

SimulationSummary simulate(const World& world, const std::filesystem::path& log,
                           const SimulationOptions& options) {
  const Building building = buildBuilding(world);
  const FloorPlan plan = drawFloorPlan(building, world.route.start.translation());
  Drive drive(world, building, options.seed);
  Recorder recorder(world, building, log, options.seed, options.gz_level);

  SimulationSummary summary;
  Trajectory trajectory;
  const auto record = [&](const TrueFrame& frame) {
    recorder.add(frame);
    trajectory.push_back({Recorder::stampOf(frame), frame.T_world_robot.toIsometry3()});
    summary.path_length_m = frame.driven_m;
    ++summary.frames;
    if (options.progress) options.progress(summary.frames, drive.size());
  };
  if (options.pipeline) {
    recordPipelined(drive, record);
  } else {
    for (std::size_t i = 0; i < drive.size(); ++i) record(drive.next());
  }
  recorder.finish();

  const std::string stem = logStem(log).string();
  const auto& landmarks = recorder.truth().landmarks();
  writeTum(stem + "_ground_truth.tum", trajectory);
  writeLandmarksCsv(stem + "_landmarks.csv", landmarks);
  writeFloorPlan(stem + "_floor", plan);

  summary.duration_s = trajectory.back().stamp_s - trajectory.front().stamp_s;
  summary.landmarks = landmarks.size();
  summary.landmarks_seen = static_cast<std::size_t>(
      std::count_if(landmarks.begin(), landmarks.end(),
                    [](const LandmarkRecord& landmark) { return landmark.observations > 0; }));
  summary.log_bytes = std::filesystem::file_size(log);
  return summary;
}

}  // namespace colonnade
