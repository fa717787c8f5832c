// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Core>
#include <algorithm>
#include <fstream>
#include <set>

#include "colonnade/base/text.hpp"
#include "program.hpp"

namespace colonnade {
namespace {

using testing::contentOf;

class Walkers : public testing::ProgramTest {
 protected:
  /// The landmarks a run confirmed.
  std::set<std::string> confirmed(const std::string& results) const {
    std::istringstream events(contentOf(folder_ / results / "events.csv"));
    std::set<std::string> ids;
    for (std::string line; std::getline(events, line);)
      if (const auto cells = fields(line, ','); cells.size() > 3 && cells[2] == "confirmation")
        ids.insert(cells[3]);
    return ids;
  }
  /// Places of the upright landmarks of a landmarks file; of all, or of some.
  static std::vector<Eigen::Vector2d> uprights(const std::filesystem::path& path,
                                               const std::set<std::string>* ids = nullptr) {
    std::istringstream table(contentOf(path));
    std::string line;
    std::getline(table, line);
    const auto names = fields(line, ',');
    const auto column = [&](const std::string& name) {
      return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    };
    std::vector<Eigen::Vector2d> places;
    while (std::getline(table, line)) {
      const auto cells = fields(line, ',');
      if (cells[column("kind")] == "floor_edge") continue;
      if (ids && !ids->contains(cells[column("id")])) continue;
      places.emplace_back(std::stod(cells[column("x")]), std::stod(cells[column("y")]));
    }
    return places;
  }
  static double nearest(const std::vector<Eigen::Vector2d>& places, const Eigen::Vector2d& p) {
    double least = 1e9;
    for (const auto& place : places) least = std::min(least, (place - p).norm());
    return least;
  }
};

TEST_F(Walkers, LeaveNoLandmarkBehind) {
  // One person crosses in front of the robot, one comes near and goes away beside a pillar.
  const Eigen::Vector2d cross_a(2.7, -2.0), cross_b(2.7, 2.0);
  const Eigen::Vector2d along_a(3.4, 1.0), along_b(6.6, 0.2);
  const auto text = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return formatDouble(a.x()) + " " + formatDouble(a.y()) + " " + formatDouble(b.x()) + " " +
           formatDouble(b.y());
  };
  std::ofstream(folder_ / "walk.world")
      << "material plaster colour=204,200,186 grain=3 blotches=5\n"
         "material stone pattern=plaster colour=150,146,138 grain=5 blotches=7\n"
         "floor material=plaster\n"
         "wall south -1.5 -2.4 7.5 -2.4\nwall east 7.5 -2.4 7.5 2.4\n"
         "wall north 7.5 2.4 -1.5 2.4\nwall west -1.5 2.4 -1.5 -2.4\n"
         "pillar 4.6 1.7 size_m=0.4,0.4 material=stone\n"
         "pillar 4.4 -1.3 size_m=0.35,0.35 material=stone\n"
      << "walker " << text(cross_a, cross_b) << " speed_m_per_s=0.9 clothes=150,60,54\n"
      << "walker " << text(along_a, along_b) << " speed_m_per_s=0.8 clothes=70,96,84\n"
      << "lamp 0 0\nlamp 3 0\nlamp 6 0\n"
         "camera width_px=320 height_px=240 field_of_view_deg=58 height_m=0.9 pitch_deg=8 "
         "rate_hz=10\n"
         "start 0 0 heading_deg=0\nwait 3\ndrive 1.0 0 speed_m_per_s=0.25\nwait 2\n";
  ASSERT_EQ(0, colonnade("simulate walk.world -o walk.rawlog").exit_code);
  const auto truth = uprights(folder_ / "walk_landmarks.csv");
  const auto falselyMapped = [&](const std::string& results) {
    int count = 0;
    const auto ids = confirmed(results);
    for (const Eigen::Vector2d& p : uprights(folder_ / results / "landmarks.csv", &ids)) {
      const auto fromWay = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        const double share = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
        return (p - a - share * (b - a)).norm();
      };
      const bool on_way = std::min(fromWay(cross_a, cross_b), fromWay(along_a, along_b)) < 0.6;
      count += on_way && nearest(truth, p) > 0.4 ? 1 : 0;
    }
    return count;
  };
  ASSERT_EQ(0, colonnade("run walk.rawlog -o with").exit_code);
  EXPECT_EQ(0, falselyMapped("with"));
  EXPECT_GE(uprights(folder_ / "with/landmarks.csv").size(), 3U);
  const auto refused = summary("with")["refused"];
  EXPECT_GT(refused.value("moving", 0), 25) << refused.dump();
}

}  // namespace
}  // namespace colonnade
