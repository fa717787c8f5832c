// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
//
// One step of RangeBearingSlam beside one of MRPT's CRangeBearingKFSLAM2D on the same data:
//   range_bearing_speed [--full] [--hidden] [--ours] [--localize] [--hypotheses] STEPS N...
// --localize: in the map of the births, saved, loaded and left as it is; nothing of MRPT's.
// --full: no landmark ever rests. --hidden: the readings of the steps measured bear no identity.
// --ours: nothing of MRPT beside it; --hidden means that too.
// --hypotheses: readings without identity by several histories side by side, not by joint
// compatibility.
// Fixed density (one landmark on 6 square metres). The map is born before the robot starts, forty
// landmarks a step; then each step has eight readings with identity. Processor time, so that other
// programs do not count.
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/slam/CRangeBearingKFSLAM2D.h>
#include <mrpt/system/COutputLogger.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <random>
#include <string_view>
#include <vector>

#include "colonnade/base/memory.hpp"
#include "colonnade/slam/range_bearing_slam.hpp"

namespace {

using colonnade::Pose2;
using colonnade::radians;
using mrpt::slam::CRangeBearingKFSLAM2D;

constexpr double kRangeSigma_m = 0.05;
constexpr double kBearingSigma = radians(0.3);
constexpr double kWay_m = 0.2;
constexpr double kWaySigma_m = 0.01;
constexpr double kTurnSigma = radians(0.3);
constexpr double kArea_m2 = 6.0;  ///< for each landmark
constexpr std::size_t kReadings = 8;
constexpr std::size_t kBirths = 40;
/// Larger maps take MRPT's naive filter minutes for each step.
constexpr int kLargestForMrpt = 400;

double processorTime_ms() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

struct Step {
  mrpt::obs::CActionCollection::Ptr action;
  mrpt::obs::CSensoryFrame::Ptr frame;
};

/// A robot that circles half-way between the middle and the rim of a square field.
class Field {
 public:
  Field(int landmarks, bool hidden)
      : hidden_(hidden),
        side_m_(std::sqrt(kArea_m2 * landmarks)),
        turn_(kWay_m / (0.25 * side_m_)) {
    // The circle starts at the origin, to the left.
    std::uniform_real_distribution<double> place(-0.5 * side_m_, 0.5 * side_m_);
    for (int i = 0; i < landmarks; ++i)
      landmarks_.emplace_back(place(random_), 0.25 * side_m_ + place(random_));
  }

  Step next() {
    const std::size_t known = std::min(landmarks_.size(), kBirths * steps_++);
    const bool ready = known == landmarks_.size();
    const Pose2 way = ready ? Pose2{kWay_m, 0.0, turn_} : Pose2{};
    T_world_robot_ = T_world_robot_ * way;
    mrpt::obs::CActionRobotMovement2D movement;
    movement.estimationMethod = mrpt::obs::CActionRobotMovement2D::emScan2DMatching;
    movement.poseChange = mrpt::poses::CPosePDFGaussian::Create(
        mrpt::poses::CPose2D(way.x + noise(kWaySigma_m), way.y + noise(kWaySigma_m),
                             way.phi + noise(kTurnSigma)),
        [] {
          mrpt::math::CMatrixDouble33 Q;
          Q(0, 0) = Q(1, 1) = kWaySigma_m * kWaySigma_m;
          Q(2, 2) = kTurnSigma * kTurnSigma;
          return Q;
        }());
    Step step{mrpt::obs::CActionCollection::Create(), mrpt::obs::CSensoryFrame::Create()};
    step.action->insert(movement);
    step.frame->insert(ready ? look(0, kReadings, hidden_) : look(known, kBirths, false));
    return step;
  }

 private:
  double noise(double sigma) { return std::normal_distribution<double>(0.0, sigma)(random_); }

  /// `count` readings, of the landmarks nearest to the robot behind the first `skipped` of them.
  mrpt::obs::CObservationBearingRange::Ptr look(std::size_t skipped, std::size_t count,
                                                bool hidden) {
    count = std::min(count, landmarks_.size() - skipped);
    std::vector<std::pair<double, std::size_t>> nearest;
    for (std::size_t i = 0; i < landmarks_.size(); ++i)
      nearest.emplace_back((landmarks_[i] - T_world_robot_.translation()).squaredNorm(), i);
    std::partial_sort(nearest.begin(),
                      nearest.begin() + static_cast<std::ptrdiff_t>(skipped + count),
                      nearest.end());
    auto scan = mrpt::obs::CObservationBearingRange::Create();
    scan->sensor_std_range = static_cast<float>(kRangeSigma_m);
    scan->sensor_std_yaw = static_cast<float>(kBearingSigma);
    scan->maxSensorDistance = 1e4F;
    const Pose2 T_robot_world = T_world_robot_.inverse();
    for (std::size_t k = 0; k < count; ++k) {
      const Eigen::Vector2d p = transform(T_robot_world, landmarks_[nearest[skipped + k].second]);
      mrpt::obs::CObservationBearingRange::TMeasurement reading;
      reading.range = static_cast<float>(std::max(0.01, p.norm() + noise(kRangeSigma_m)));
      reading.yaw = static_cast<float>(std::atan2(p.y(), p.x()) + noise(kBearingSigma));
      reading.pitch = 0.0F;
      reading.landmarkID = hidden ? mrpt::obs::INVALID_LANDMARK_ID
                                  : static_cast<std::int32_t>(nearest[skipped + k].second);
      scan->sensedData.push_back(reading);
    }
    return scan;
  }

  bool hidden_;
  std::mt19937_64 random_{7};
  double side_m_;
  double turn_;
  std::vector<Eigen::Vector2d> landmarks_;
  Pose2 T_world_robot_;
  std::size_t steps_ = 0;
};

struct Times {
  std::vector<double> ms;
  double mean() const {
    double sum = 0.0;
    for (const double t : ms) sum += t;
    return sum / static_cast<double>(ms.size());
  }
  double worst() const { return *std::max_element(ms.begin(), ms.end()); }
};

template <class Filter>
void measure(Filter& filter, Step& step, Times* times) {
  const double start = processorTime_ms();
  filter.processActionObservation(step.action, step.frame);
  if (times) times->ms.push_back(processorTime_ms() - start);
}

void print(int landmarks, const char* name, const Times& times, double ours_ms) {
  std::printf("%9d  %-16s %10.3f %10.3f %8.1f\n", landmarks, name, times.mean(), times.worst(),
              times.mean() / ours_ms);
  std::fflush(stdout);
}

struct Flags {
  bool full = false;
  bool hidden = false;
  bool ours = false;
  bool localize = false;
  bool hypotheses = false;
};

/// Goes on in the map so far, which stays as it is.
void localizeIn(colonnade::RangeBearingSlam& slam) {
  const auto map = std::filesystem::temp_directory_path() /
                   ("range_bearing_speed_" + std::to_string(getpid()) + ".colonnade");
  slam.saveMap(map);
  colonnade::MapStart start;
  start.localize = true;
  slam.loadMap(map, start);
  std::filesystem::remove(map);
}

void run(int landmarks, int steps, const Flags& flags) {
  colonnade::RangeBearingSlam ours;
  if (flags.full) ours.options.filter.active_landmarks = 0;
  if (flags.hypotheses)
    ours.options.data_assoc_method = colonnade::RangeBearingSlam::assocHypotheses;
  ours.options.std_sensor_range = kRangeSigma_m;
  ours.options.std_sensor_yaw = kBearingSigma;
  ours.reset();
  const bool with_mrpt =
      landmarks <= kLargestForMrpt && !flags.ours && !flags.hidden && !flags.localize;
  CRangeBearingKFSLAM2D naive, davison;
  for (auto* mrpt : {&naive, &davison}) {
    mrpt->setMinLoggingLevel(mrpt::system::LVL_ERROR);
    mrpt->KF_options.verbosity_level = mrpt::system::LVL_ERROR;
    mrpt->options.std_sensor_range = static_cast<float>(kRangeSigma_m);
    mrpt->options.std_sensor_yaw = static_cast<float>(kBearingSigma);
  }
  naive.KF_options.method = mrpt::bayes::kfEKFNaive;
  davison.KF_options.method = mrpt::bayes::kfEKFAlaDavison;
  Field field(landmarks, flags.hidden);
  Times ours_times, naive_times, davison_times;
  const int births = (landmarks + static_cast<int>(kBirths) - 1) / static_cast<int>(kBirths);
  // What the last births leave to be done is done in the step after them.
  for (int i = 0; i <= births + steps; ++i) {
    Step step = field.next();
    measure(ours, step, i <= births ? nullptr : &ours_times);
    if (flags.localize && i + 1 == births) localizeIn(ours);
    if (!with_mrpt) continue;
    measure(naive, step, i <= births ? nullptr : &naive_times);
    measure(davison, step, i <= births ? nullptr : &davison_times);
  }
  print(landmarks, "Colonnade", ours_times, ours_times.mean());
  if (!with_mrpt) return;
  print(landmarks, "kfEKFNaive", naive_times, ours_times.mean());
  print(landmarks, "kfEKFAlaDavison", davison_times, ours_times.mean());
}

}  // namespace

int main(int argc, char** argv) {
  colonnade::keepFreedMemory();
  Flags flags;
  bool unknown = false;
  for (; argc > 1 && std::string_view(argv[1]).starts_with("--"); ++argv, --argc) {
    const std::string_view flag(argv[1]);
    flags.full |= flag == "--full";
    flags.hidden |= flag == "--hidden";
    flags.ours |= flag == "--ours";
    flags.localize |= flag == "--localize";
    flags.hypotheses |= flag == "--hypotheses";
    unknown |= flag != "--full" && flag != "--hidden" && flag != "--ours" && flag != "--localize" &&
               flag != "--hypotheses";
  }
  if (argc < 3 || unknown) {
    std::fprintf(stderr,
                 "range_bearing_speed [--full] [--hidden] [--ours] [--localize] [--hypotheses] "
                 "STEPS N...\n");
    return 2;
  }
  std::printf("landmarks  filter              mean ms   worst ms    ratio\n");
  for (int i = 2; i < argc; ++i) run(std::atoi(argv[i]), std::atoi(argv[1]), flags);
}
