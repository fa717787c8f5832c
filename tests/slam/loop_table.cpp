// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// Drives many seeds of a world at the level of detections and prints what drift and loop closing
// come to:  loop_table WORLD SEEDS [--no-depth] [--visual] [-v] [world:AMENDMENT]
//     [move:AT_S,X,Y,RADIUS,BY_X,BY_Y] [Section.key=value ...]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "colonnade/base/config.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/simulation/world_file.hpp"
#include "colonnade/slam/mapper.hpp"
#include "plan_drive.hpp"

namespace {

using namespace colonnade;

struct Outcome {
  double length_m = 0.0;
  double drift_m = 0.0;  ///< of the last pose, or of that before the first closing
  double heading_max = 0.0;
  double end_m = 0.0;
  double final_rms_m = 0.0;  ///< of trajectory_final, without alignment: both start at the origin
  double online_rms_m = 0.0;
  double nees = 0.0;
  int closings = 0;
  int wrong = 0;
};

double distance(const Pose2& a, const Pose2& b) {
  return (a.translation() - b.translation()).norm();
}

/// Edges that move while nobody looks, as furniture does: the world a robot comes back to.
struct Move {
  double at_s = 1e9;
  Eigen::Vector2d p_world = Eigen::Vector2d::Zero();
  double radius_m = 0.0;
  Eigen::Vector2d by_m = Eigen::Vector2d::Zero();
};

Outcome drive(const World& world, std::uint64_t seed, const testing::PlanSensor& sensor,
              const MapperOptions& options, const Move& move, bool verbose) {
  testing::PlanDrive plan(world, seed, sensor);
  Mapper mapper(options);
  Outcome o;
  std::vector<Pose2> truth;
  double nees = 0.0, online2 = 0.0;
  int nees_count = 0;
  bool closed = false;
  bool moved = false;
  while (const auto seen = plan.next()) {
    if (!moved && seen->stamp_s >= move.at_s) {
      plan.moveEdgesNear(move.p_world, move.radius_m, move.by_m);
      moved = true;
    }
    if (!truth.empty()) o.length_m += distance(truth.back(), plan.truth());
    truth.push_back(plan.truth());
    const double before =
        distance(mapper.filter().pose(), truth.size() > 1 ? truth[truth.size() - 2] : plan.truth());
    const auto report = mapper.step(*seen);
    const Pose2 pose = mapper.filter().pose();
    Eigen::Vector3d e = pose.vector() - plan.truth().vector();
    e(2) = wrapAngle(e(2));
    o.heading_max = std::max(o.heading_max, std::abs(e(2)));
    online2 += e.head<2>().squaredNorm();
    if (truth.size() > 20) {
      nees += e.dot(mapper.filter().poseCovariance().ldlt().solve(e)) / 3.0;
      ++nees_count;
    }
    for (const Event& event : report.events) {
      if (event.what.starts_with("loop")) {
        if (!closed) o.drift_m = before;
        closed = true;
        if (e.head<2>().norm() > std::max(0.15, before)) ++o.wrong;
      }
      if (verbose && (event.what.starts_with("loop") || event.what == "axis" ||
                      event.what == "hallway" || event.what == "corner" || event.what == "gone"))
        std::printf("    %7.1f s %s: %s\n", event.stamp_s, event.what.c_str(),
                    event.reason.c_str());
    }
    if (verbose && (seen->index % 100 == 0 ||
                    (mapper.lastSearch().best.places >= 3 && seen->index % 5 == 0))) {
      const auto& c = mapper.lastSearch();
      std::printf(
          "    %7.1f s way %.1f error %.3f sigma %.3f heading %.2f  search: %d places, %d floor, "
          "share %.2f, %s\n",
          seen->stamp_s, o.length_m, e.head<2>().norm(),
          std::sqrt(mapper.filter().poseCovariance().topLeftCorner<2, 2>().trace()), degrees(e(2)),
          c.best.places, c.best.floor_edges, c.best.share, c.refusal.c_str());
    }
  }
  const Pose2 end = mapper.filter().pose();
  o.end_m = distance(end, truth.back());
  if (!closed) o.drift_m = o.end_m;
  o.closings = mapper.loopClosings();
  o.nees = nees / nees_count;
  o.online_rms_m = std::sqrt(online2 / static_cast<double>(truth.size()));
  const auto final = mapper.trajectory();
  double final2 = 0.0;
  for (std::size_t i = 0; i < final.size(); ++i)
    final2 += std::pow(distance(final[i].T_world_robot, truth[i]), 2);
  o.final_rms_m = std::sqrt(final2 / static_cast<double>(final.size()));
  return o;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 3) {
    std::fprintf(stderr,
                 "loop_table WORLD SEEDS [--no-depth] [--visual] [-v] [world:AMENDMENT] "
                 "[move:AT_S,X,Y,RADIUS,BY_X,BY_Y] [Section.key=value ...]\n");
    return 2;
  }
  testing::PlanSensor sensor;
  Config config;
  bool verbose = false;
  Move move;
  std::vector<std::string> amendments;
  for (int i = 3; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--no-depth")
      sensor.depth = false;
    else if (word == "--visual")
      sensor.visual_share = 0.03;
    else if (word == "-v")
      verbose = true;
    else if (word.starts_with("move:")) {
      if (std::sscanf(word.c_str(), "move:%lf,%lf,%lf,%lf,%lf,%lf", &move.at_s, &move.p_world.x(),
                      &move.p_world.y(), &move.radius_m, &move.by_m.x(), &move.by_m.y()) != 6)
        throw Error("move:AT_S,X,Y,RADIUS,BY_X,BY_Y");
    } else if (word.starts_with("world:"))
      amendments.push_back(word.substr(6));
    else
      config.set(word);
  }
  MapperOptions options;
  options.each([&](auto& section) { config.read(section); });
  config.requireAllKnown();
  const World world = loadWorld(argv[1], amendments).world;
  const int seeds = std::atoi(argv[2]);
  std::printf(
      "seed  length  drift m   %%    end m   %%   final rms  online rms  heading max  nees  "
      "closings wrong\n");
  int closed = 0, wrong = 0, good_drift = 0, good_heading = 0, good_end = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Outcome o =
        drive(world, static_cast<std::uint64_t>(seed), sensor, options, move, verbose);
    std::printf("%4d %7.1f %7.3f %5.2f %7.3f %5.2f %9.3f %11.3f %11.2f %7.2f %6d %6d\n", seed,
                o.length_m, o.drift_m, 100.0 * o.drift_m / o.length_m, o.end_m,
                100.0 * o.end_m / o.length_m, o.final_rms_m, o.online_rms_m, degrees(o.heading_max),
                o.nees, o.closings, o.wrong);
    std::fflush(stdout);
    closed += o.closings > 0 ? 1 : 0;
    wrong += o.wrong;
    good_drift += o.drift_m <= 0.003 * o.length_m ? 1 : 0;
    good_end += o.end_m <= 0.001 * o.length_m ? 1 : 0;
    good_heading += degrees(o.heading_max) <= 0.5 ? 1 : 0;
  }
  std::printf(
      "closed %d of %d, wrong %d; drift <= 0.3 %%: %d, end <= 0.1 %%: %d, heading <= 0.5 degrees: "
      "%d\n",
      closed, seeds, wrong, good_drift, good_end, good_heading);
  return 0;
} catch (const colonnade::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
