// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <fstream>

#include "colonnade/base/text.hpp"
#include "program.hpp"

namespace colonnade {
namespace {

using testing::contentOf;

class Calibrate : public testing::ProgramTest {
 protected:
  nlohmann::json fits(const std::string& arguments) const {
    const auto outcome = colonnade("calibrate " + arguments + " --json");
    EXPECT_EQ(0, outcome.exit_code) << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
};

TEST_F(Calibrate, ReproducesTheThesis) {
  const auto json = fits("--worked-case");
  EXPECT_EQ("in", json["unit"]);
  EXPECT_NEAR(-0.0774, json["linear"]["slope_per_px"].get<double>(), 5e-5);
  EXPECT_NEAR(24.93, json["linear"]["offset"].get<double>(), 5e-3);
  EXPECT_NEAR(120.8, json["exponential"]["at_zero_px"].get<double>(), 0.05);
  EXPECT_NEAR(0.0089, json["exponential"]["decades_per_unit"].get<double>(), 5e-5);
  EXPECT_NEAR(2031.7, json["pinhole"]["px_times_unit"].get<double>(), 0.05);
  EXPECT_NEAR(1.24, json["pinhole"]["rms_px"].get<double>(), 5e-3);
  EXPECT_DOUBLE_EQ(151.8, json["as_printed"]["at_zero_px"].get<double>());
  EXPECT_GT(json["as_printed"]["rms_px"], json["exponential"]["rms_px"]);
  const std::string text = colonnade("calibrate --worked-case").out;
  EXPECT_NE(std::string::npos, text.find("-0.0774"));
  EXPECT_NE(std::string::npos, text.find("24.93"));
}

TEST_F(Calibrate, FindsTheCameraThatMadeATable) {
  // focal length 500 px, centre 320, a pillar 0.4 m wide at several places.
  std::string table = "left_rho_px,distance_m,lateral_m,delta_rho_px\n";
  for (const double d : {1.0, 1.5, 2.0, 3.0})
    for (const double s : {-0.3, 0.1, 0.4})
      table += formatDouble(320.0 - 500.0 * s / d) + "," + formatDouble(d) + "," + formatDouble(s) +
               "," + formatDouble(500.0 * 0.4 / d) + "\n";
  write("places.csv", table + "\n# a comment\n,5,,40\n");
  const auto json = fits("places.csv --width 0.4 -o camera.ini");
  EXPECT_NEAR(500.0, json["pinhole"]["focal_px"].get<double>(), 1e-6);
  EXPECT_NEAR(500.0, json["pinhole_lateral"]["focal_px"].get<double>(), 1e-6);
  EXPECT_NEAR(320.0, json["pinhole_lateral"]["centre_px"].get<double>(), 1e-6);
  EXPECT_NE(std::string::npos, contentOf(folder_ / "camera.ini").find("[PathMap]"));
}

TEST_F(Calibrate, NamesWhatIsWrongWithItsInput) {
  write("column.csv", "distance_m,colour\n1,2\n");
  write("number.csv", "distance_m,delta_rho_px\n1,200\n2,x\n");
  write("zero.csv", "distance_m,delta_rho_px\n1,200\n0,100\n");
  write("cells.csv", "distance_m,delta_rho_px\n1,200,3\n");
  write("few.csv", "distance_m,delta_rho_px\n1,200\n");
  write("empty.csv", "");
  const std::pair<const char*, const char*> cases[] = {
      {"column.csv", "column.csv:1"}, {"number.csv", "number.csv:3"}, {"zero.csv", "positive"},
      {"cells.csv", "cells.csv:2"},   {"few.csv", "too few"},         {"empty.csv", "empty"},
      {"nothing.csv", "nothing.csv"}};
  for (const auto& [file, word] : cases) {
    const auto outcome = colonnade(std::string("calibrate ") + file);
    EXPECT_EQ(1, outcome.exit_code) << file;
    EXPECT_EQ(1, outcome.errorLines()) << outcome.err;
    EXPECT_NE(std::string::npos, outcome.err.find(word)) << outcome.err;
  }
  EXPECT_EQ(2, colonnade("calibrate").exit_code);
  EXPECT_EQ(2, colonnade("calibrate few.csv --worked-case").exit_code);
  EXPECT_EQ(2, colonnade("calibrate " + corridor().string()).exit_code);  // no --width
}

/// A camera goes 0.6 m nearer to a pillar 0.4 m wide, then rests.
class PathBeforeAPillar : public Calibrate {
 protected:
  void simulate() const {
    write("pillar.world",
          "material plaster colour=204,200,186\nmaterial dark colour=70,66,60 pattern=plain\n"
          "wall south -1.5 -2.4 6 -2.4\nwall east 6 -2.4 6 2.4\nwall north 6 2.4 -1.5 2.4\n"
          "wall west -1.5 2.4 -1.5 -2.4\npillar 3.2 0.1 size_m=0.4,0.4 material=dark\n"
          "camera width_px=320 height_px=240 field_of_view_deg=58 height_m=0.9 rate_hz=10\n"
          "start 0 0 heading_deg=0\nwait 1\ndrive 0.6 0 speed_m_per_s=0.2\nwait 1\n");
    ASSERT_EQ(0, colonnade("simulate pillar.world -o pillar.rawlog").exit_code);
  }
};

TEST_F(PathBeforeAPillar, IsMeasuredWithACalibrationFromTheSameLog) {
  simulate();
  const auto json = fits("pillar.rawlog --width 0.4 -o camera.ini");
  const double focal_px = 160.0 / std::tan(29.0 * 3.14159265358979 / 180.0);
  EXPECT_NEAR(focal_px, json["pinhole"]["focal_px"].get<double>(), 0.04 * focal_px);
  write("map.ini", contentOf(folder_ / "camera.ini"));
  const auto outcome =
      colonnade("detect pillar.rawlog --path-map map.ini -o seen --picture-every 0");
  ASSERT_EQ(0, outcome.exit_code) << outcome.err;
  std::istringstream table(contentOf(folder_ / "seen/path_map.csv"));
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(table, line);) rows.push_back(fields(line, ','));
  ASSERT_GE(rows.size(), 3U);
  EXPECT_NEAR(0.6, std::stod(rows[1][3]) - std::stod(rows.back()[3]), 0.06);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "seen/path_map.png"));
  write("none.ini", "[PathMap]\nmodel = exponential\n");
  EXPECT_EQ(2, colonnade("detect pillar.rawlog --path-map none.ini -o not").exit_code);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "not"));
}

TEST_F(PathBeforeAPillar, BecomesAFilm) {
  simulate();
  ASSERT_EQ(0,
            colonnade("detect pillar.rawlog -o seen --picture-every 0 --video seen.avi").exit_code);
  const std::string film = contentOf(folder_ / "seen.avi");
  EXPECT_EQ("RIFF", film.substr(0, 4));
  EXPECT_GT(film.size(), 100000U);
  EXPECT_EQ(2, colonnade("detect pillar.rawlog -o again --video seen.avi").exit_code);
  EXPECT_EQ(2, colonnade("detect pillar.rawlog -o again --video seen.mp4").exit_code);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "again"));
}

}  // namespace
}  // namespace colonnade
