// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/filter/smoother.hpp"

namespace colonnade {

/// Makes one of points of a settled drive that were founded twice: a robot that is off by more than
/// it knows takes a thing it has seen before for another one beside it. A point that
/// Drive::nameless allows becomes another within ten deviations of a reading where
/// - the two were hardly ever seen together, though, as often as the rarer one was seen with
///   others, two would have been, and
/// - with all sightings of one point the drive costs more than before by no more than a sighting
///   at the gate and what the noise of the rarer one's sightings costs (correspondence tests of
///   Thrun and Montemerlo, The GraphSLAM Algorithm, International Journal of Robotics Research
///   25(5-6), 2006, by the cost of the whole drive).
/// Two points of the prior are one from then on, which costs what the prior says against it. Of two
/// such points the rarer one goes. The nearest pairs are tried first, until
/// affordableSteps() are spent. See Smoothing::merged.
void mergeDuplicates(Drive& drive, double gate_probability, Smoothing& result);

}  // namespace colonnade
