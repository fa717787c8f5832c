// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mrclam_drive.hpp"

#include <algorithm>
#include <cmath>

namespace colonnade {
namespace {

/// Turns that pause for less than this are one: the log flickers.
constexpr double kPause_s = 0.1;
/// Turns on the way that are slower than this (rad/s) start from wheels that turn already.
constexpr double kSlowTurn = 0.1;
/// The last command of a log.
constexpr double kLastCommand_s = 1.0;

/// A turn slows the robot down, but never turns it round.
double speedOf(const WheelSpeed& command, double turn_rate, const MrclamCalibration& c) {
  const double straight = c.speed_gain * command.speed_m_s;
  return std::copysign(std::max(0.0, std::abs(straight) - c.slowed_by_turn * std::abs(turn_rate)),
                       straight);
}

/// The turn rate meant by a record; 0 means straight ahead and is recorded as such.
double meantTurnRate(const WheelSpeed& command, const MrclamCalibration& c) {
  return command.turn_rate == 0.0 ? 0.0 : command.turn_rate - c.turn_offset;
}

double turnRateOnTheWay(double meant, const MrclamCalibration& c) {
  if (meant == 0.0) return 0.0;
  return std::abs(meant) < c.least_turn_below ? std::copysign(c.least_turn_rate, meant)
                                              : c.turn_gain * meant;
}

/// How far commands have run up for a turn.
class Breakaway {
 public:
  explicit Breakaway(double turn) : turn_(turn) {}

  /// How much of a command (rate, duration) passes before the robot begins to turn.
  double idle(double rate, double stamp_s, double duration_s) {
    if (rate * run_up_ < 0.0 || stamp_s - last_s_ > kPause_s) run_up_ = 0.0;
    last_s_ = stamp_s + duration_s;
    const double left_s = std::max(0.0, turn_ - std::abs(run_up_)) / std::abs(rate);
    const double idle_s = std::min(left_s, duration_s);
    run_up_ += rate * duration_s;
    return idle_s;
  }

 private:
  double turn_;
  double run_up_ = 0.0;  ///< rad, signed
  double last_s_ = -HUGE_VAL;
};

}  // namespace

std::vector<WheelSpeed> drivenSpeeds(const std::vector<WheelSpeed>& commands,
                                     const MrclamCalibration& calibration) {
  const double delay_s = calibration.drive_delay_s + calibration.camera_delay_s;
  Breakaway on_spot(calibration.breakaway_on_spot), on_the_way(calibration.breakaway_on_the_way);
  std::vector<WheelSpeed> driven;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const WheelSpeed& command = commands[i];
    const bool last = i + 1 == commands.size();
    const double duration_s = last ? kLastCommand_s : commands[i + 1].stamp_s - command.stamp_s;
    const double meant = meantTurnRate(command, calibration);
    const bool spot = command.speed_m_s == 0.0;
    const double speed_m_s = speedOf(command, meant, calibration);
    const double rate =
        spot ? calibration.turn_gain_on_spot * meant : turnRateOnTheWay(meant, calibration);
    double idle_s = 0.0;
    if (std::abs(meant) > (spot ? 0.0 : kSlowTurn))
      idle_s = (spot ? on_spot : on_the_way).idle(meant, command.stamp_s, duration_s);
    if (idle_s > 0.0) driven.push_back({command.stamp_s + delay_s, speed_m_s, 0.0});
    if (idle_s < duration_s || last)
      driven.push_back({command.stamp_s + delay_s + idle_s, speed_m_s, rate});
  }
  return driven;
}

}  // namespace colonnade
