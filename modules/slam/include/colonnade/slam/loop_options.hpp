// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/base/angle.hpp"
#include "colonnade/base/options.hpp"

namespace colonnade {

struct LoopOptions {
  static constexpr const char* kSection = "Loops";
  bool enabled = true;
  double sleep_after_m = 4.0;
  double sleep_sigma_m = 0.05;
  double sleep_sigma_alone_m = 0.12;
  double recent_m = 10.0;
  int min_observations = 5;
  double drift_share = 0.002;
  double drift_turn = radians(0.3);
  double twin_place_m = 0.03;
  double twin_direction = radians(0.6);
  double joint_probability = 0.99;
  int min_places = 5;
  double min_spread_m = 1.5;
  double min_share = 0.5;
  double ambiguity = 0.6;
  double distinct_m = 0.1;
  double colour_levels = 25.0;
  int confirmations = 2;
  double try_every_m = 0.25;
  double verify_m = 4.0;

  void visit(OptionVisitor& v) {
    v.flag(
        "enabled", enabled,
        "recognise places seen before; without, what the way made uncertain sleeps all the same");
    v.number("sleep_after_m", sleep_after_m, {0.5, 1000},
             "way since a landmark was last seen, after which it may fall asleep");
    v.number("sleep_sigma_m", sleep_sigma_m, {0.01, 10},
             "of its place relative to the robot, beyond which it does, with a neighbour near");
    v.number("sleep_sigma_alone_m", sleep_sigma_alone_m, {0.01, 10},
             "the same where no landmark like it stands within four times its sigma");
    v.number("recent_m", recent_m, {1, 1000},
             "way whose landmarks are compared with sleeping ones");
    v.integer("min_observations", min_observations, {1, 1000}, "of a landmark that is compared");
    v.number("drift_share", drift_share, {0, 0.1},
             "error of the way that the filter may not know of, sigma as share of the way");
    v.angle("drift_turn_deg", drift_turn, {0, 20}, "the same of the heading");
    v.number("twin_place_m", twin_place_m, {0.001, 1}, "sigma between two estimates of one place");
    v.angle("twin_direction_deg", twin_direction, {0.01, 10}, "the same of a wall's direction");
    v.number("joint_probability", joint_probability, {0.5, 0.999999},
             "share of right constellations the joint chi-square test lets through");
    v.integer("min_places", min_places, {2, 100}, "different places a constellation needs");
    v.number("min_spread_m", min_spread_m, {0, 50}, "from its first to its last place");
    v.number("min_share", min_share, {0, 1}, "of the recent places around it that must fit");
    v.number("ambiguity", ambiguity, {0, 1},
             "another constellation with this share of its places forbids it");
    v.number("distinct_m", distinct_m, {0.01, 10}, "between two constellations' displacements");
    v.number("colour_levels", colour_levels, {1, 255}, "largest median colour distance of twins");
    v.integer("confirmations", confirmations, {1, 20}, "in a row before a loop is closed");
    v.number("try_every_m", try_every_m, {0.05, 10}, "of the way a closing is looked for");
    v.number("verify_m", verify_m, {0, 100}, "of the way after it that can undo a closing");
  }
};

}  // namespace colonnade
