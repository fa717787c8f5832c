// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a frame takes as a range-bearing drive goes on:
//   long_drives FRAMES SMOOTH_EVERY [LANDMARKS]
// Without LANDMARKS fifteen posts in an arena, seen now and then; otherwise so many on a plain, one
// on six square metres, of which each frame reads the eight nearest. Identities known. Wall-clock
// time.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "arena_of_posts.hpp"
#include "colonnade/base/memory.hpp"
#include "colonnade/evaluation/trajectory_score.hpp"
#include "colonnade/slam/range_bearing_session.hpp"

namespace {

using namespace colonnade;

/// Posts anywhere on a plain, of which the nearest are seen.
class Plain : public testing::WanderingRobot {
 public:
  Plain(std::size_t posts, std::size_t frames)
      : WanderingRobot(1, frames, {0.2, 0.05, radians(0.3)}),
        side_m_(std::sqrt(kArea_m2 * static_cast<double>(posts))) {
    for (std::size_t i = 0; i < posts; ++i) posts_.emplace_back(somewhere());
    T_world_robot_ = {0.5 * side_m_, 0.5 * side_m_, 0.0};
    goal_ = somewhere();
  }

 private:
  static constexpr double kArea_m2 = 6.0;
  static constexpr std::size_t kReadings = 8;

  Eigen::Vector2d somewhere() {
    const double x = uniform(0.0, side_m_);
    return {x, uniform(0.0, side_m_)};
  }

  void look(std::vector<RangeBearing>& readings) override {
    std::vector<std::pair<double, std::size_t>> nearest;
    for (std::size_t i = 0; i < posts_.size(); ++i)
      nearest.emplace_back((posts_[i] - T_world_robot_.translation()).norm(), i);
    const auto end =
        nearest.begin() + static_cast<std::ptrdiff_t>(std::min(kReadings, nearest.size()));
    std::partial_sort(nearest.begin(), end, nearest.end());
    for (auto post = nearest.begin(); post != end; ++post)
      read(post->second, posts_[post->second], readings);
  }

  void drive() override {
    if ((goal_ - T_world_robot_.translation()).norm() < 0.5) goal_ = somewhere();
    const double direction = directionOf(goal_);
    const double way = std::abs(direction) > 0.8 ? 0.02 : 0.2;
    const double turn = std::clamp(direction, -0.2, 0.2);
    move(way, turn,
         {0.02 * std::sqrt(way), 0.01 * std::sqrt(way),
          std::sqrt(1e-4 * way + 2.7e-3 * std::abs(turn) + 1e-6)});
  }

  double side_m_;
  std::vector<Eigen::Vector2d> posts_;
  Eigen::Vector2d goal_;
};

template <class Source>
void run(Source source, std::size_t frames, int smooth_every) {
  RangeBearingOptions options;
  options.smooth_every = smooth_every;
  RangeBearingSession session(options, {}, {});
  std::vector<StampedCovariance> covariances;
  std::vector<double> ms;
  std::printf("  frames     mean ms    worst ms\n");
  const auto print = [](std::size_t frame, std::vector<double>::iterator first,
                        std::vector<double>::iterator last) {
    double sum = 0.0;
    for (auto t = first; t != last; ++t) sum += *t;
    std::printf("%8zu  %10.3f  %10.1f\n", frame, sum / static_cast<double>(last - first),
                *std::max_element(first, last));
    std::fflush(stdout);
  };
  const std::size_t part = std::max<std::size_t>(1, frames / 5);
  session.run(source, [&](const Frame& frame, const StepReport& report, const auto& so_far) {
    ms.push_back(report.times_ms.filter);
    covariances.push_back({frame.stamp_s, so_far.now().covariance, so_far.now().T_world_origin});
    if (ms.size() % part == 0)
      print(ms.size(), ms.end() - static_cast<std::ptrdiff_t>(part), ms.end());
    return true;
  });
  const auto score = evaluateTrajectory(session.trajectory(), source.truth, {}, covariances);
  std::printf("ATE %.4f m, NEES / 3 %.2f, frames of more than 66 ms: %td\n", score.ate_rmse_m,
              score.nees_mean.value_or(0.0),
              std::count_if(ms.begin(), ms.end(), [](double t) { return t > 66.0; }));
}

}  // namespace

int main(int argc, char** argv) {
  keepFreedMemory();
  if (argc < 3) {
    std::fprintf(stderr, "long_drives FRAMES SMOOTH_EVERY [LANDMARKS]\n");
    return 2;
  }
  const std::size_t frames = std::strtoul(argv[1], nullptr, 10);
  const int every = std::atoi(argv[2]);
  if (argc > 3)
    run(Plain(std::strtoul(argv[3], nullptr, 10), frames), frames, every);
  else
    run(testing::ArenaOfPosts(1, frames), frames, every);
}
