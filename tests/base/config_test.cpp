// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/base/config.hpp"

#include <gtest/gtest.h>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/error.hpp"

namespace colonnade {
namespace {

struct Options {
  static constexpr const char* kSection = "Pillars";
  double width_m = 0.5;
  double tilt = radians(8.0);
  int count = 3;
  bool enabled = true;
  std::string mode = "fast";
  void visit(OptionVisitor& v) {
    v.number("width_m", width_m, {0.1, 2.0}, "width");
    v.angle("tilt_deg", tilt, {0, 45}, "tilt");
    v.integer("count", count, {1, 9}, "how many");
    v.flag("enabled", enabled, "on or off");
    v.choice("mode", mode, {"fast", "exact"}, "how");
  }
};

std::string mistake(const std::string& text) {
  try {
    Config config = Config::fromText(text, "robot.ini");
    Options options;
    config.read(options);
    config.requireAllKnown();
  } catch (const Error& error) {
    EXPECT_EQ(ExitCode::kUsage, error.code());
    return error.what();
  }
  return "";
}

TEST(Config, ReadsEveryTypeAndConvertsDegrees) {
  Config config = Config::fromText(
      "// a comment\n[Pillars]\nwidth_m = 0.75 ; metres\ntilt_deg=10\ncount = 4\nenabled = false\n"
      "mode = exact # slow\n",
      "robot.ini");
  config.set("Pillars.count=5");
  Options options;
  config.read(options);
  config.requireAllKnown();
  EXPECT_DOUBLE_EQ(0.75, options.width_m);
  EXPECT_DOUBLE_EQ(radians(10.0), options.tilt);
  EXPECT_EQ(5, options.count);
  EXPECT_FALSE(options.enabled);
  EXPECT_EQ("exact", options.mode);
}

TEST(Config, MistakesNameFileLineKeyAndRemedy) {
  EXPECT_EQ("robot.ini:2: no key Pillars.widht_m; did you mean Pillars.width_m?",
            mistake("[Pillars]\nwidht_m = 1\n"));
  EXPECT_EQ("robot.ini:2: no section [Pilars]; did you mean [Pillars]?",
            mistake("[Pilars]\nwidth_m = 1\n"));
  EXPECT_EQ("robot.ini:2: Pillars.width_m = 7 is outside 0.1 .. 2",
            mistake("[Pillars]\nwidth_m = 7\n"));
  EXPECT_EQ("robot.ini:2: Pillars.width_m = wide is not a number",
            mistake("[Pillars]\nwidth_m = wide\n"));
  EXPECT_EQ("robot.ini:2: Pillars.width_m = nan is not a number",
            mistake("[Pillars]\nwidth_m = nan\n"));
  EXPECT_EQ("robot.ini:2: Pillars.count = 2.5 is not a whole number",
            mistake("[Pillars]\ncount = 2.5\n"));
  EXPECT_EQ("robot.ini:2: Pillars.mode = slow is none of fast, exact",
            mistake("[Pillars]\nmode = slow\n"));
  EXPECT_EQ("robot.ini:3: Pillars.count stands already at robot.ini:2",
            mistake("[Pillars]\ncount = 2\ncount = 3\n"));
  EXPECT_EQ("robot.ini:1: expected \"key = value\", found \"width\"", mistake("width\n"));
}

TEST(Config, WhatIsWrittenReadsBackTheSame) {
  Options options;
  options.tilt = radians(12.3);
  options.width_m = 0.1 + 0.2;
  ConfigWriter writer;
  writer.add(options);
  Config config = Config::fromText(writer.text(), "config.ini");
  Options again;
  config.read(again);
  config.requireAllKnown();
  EXPECT_EQ(options.width_m, again.width_m);
  EXPECT_NEAR(options.tilt, again.tilt, 1e-12);
  ConfigWriter rewriter;
  rewriter.add(again);
  EXPECT_EQ(writer.text(), rewriter.text());
}

}  // namespace
}  // namespace colonnade
