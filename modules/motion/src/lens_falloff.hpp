// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

namespace colonnade {

/// The falloff of a lens (see FalloffEquation), learnt from how the brightness of what is followed
/// changes on its way across the picture: a scalar Kalman filter over the frames. Shade that goes
/// with the lens draws an alignment towards no motion at all wherever little else tells the way
/// (Bergmann et al. 2018, "Online photometric calibration of auto exposure video for realtime
/// visual odometry and SLAM", learn it likewise, with more terms).
class LensFalloff {
 public:
  double value() const { return value_; }

  /// `step` from the present value, of this inverse variance.
  void update(double step, double information) {
    information_ = std::min(information_ + information, kMostInformation);
    value_ = std::clamp(value_ + information / information_ * step, 0.0, kMost);
  }

 private:
  static constexpr double kPriorSigma = 0.5;
  /// Light in buildings is not regular enough to be surer, and what came first is forgotten.
  static constexpr double kMostInformation = 1.0 / (0.02 * 0.02);
  static constexpr double kMost = 2.0;

  double value_ = 0.0;
  double information_ = 1.0 / (kPriorSigma * kPriorSigma);
};

}  // namespace colonnade
