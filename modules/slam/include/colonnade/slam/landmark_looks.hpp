// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>

#include "colonnade/detectors/detection.hpp"

namespace colonnade {

/// How a landmark has looked so far: its dark side, the colours beside it, its width.
class LandmarkLooks {
 public:
  void observe(const Detection& detection);
  /// A vertical edge keeps its dark side.
  bool sameDarkSide(const Detection& detection) const;
  /// Whether one side was the dark one most of the time; that of a thin line is now one, now the
  /// other.
  bool hasDarkSide() const { return 2 * std::abs(gradient_balance_) > sightings_; }

  /// Floor edges: whether it was a joint of the floor in most of its sightings.
  bool isJoint() const { return joint_balance_ > 0; }
  /// Whether a detection may be of it by that, as far as its sightings agree.
  bool agreesOnJoint(const Detection& detection) const {
    return 2 * std::abs(joint_balance_) <= sightings_ || isJoint() == detection.on_surface;
  }

  struct Difference {
    double distance2 = 0.0;
    int numbers = 0;  ///< degrees of freedom of distance2: what could be compared
  };
  /// Colours: of the side that changed less, since the background of an edge changes with the place
  /// it is seen from; root mean square over the channels, by colour_sigma gray levels. Width: where
  /// both are known, by width_sigma of it.
  Difference difference(const Detection& detection, double colour_sigma, double width_sigma) const;

  int sightings() const { return sightings_; }
  /// Whether both may be one by their dark side.
  bool sameDarkSide(const LandmarkLooks& other) const {
    return gradient_balance_ * other.gradient_balance_ >= 0;
  }
  /// The same landmark's looks from the other side: of a line on the floor.
  LandmarkLooks fromOtherSide() const;
  /// The larger difference of the mean colours on either side, in gray levels.
  double colourDistance(const LandmarkLooks& other) const;
  /// What was seen of another landmark was seen of this one.
  void merge(const LandmarkLooks& other);

 private:
  friend class MapFile;
  int sightings_ = 0;
  int gradient_balance_ = 0;  ///< sightings with the brighter side on the right minus the others
  int joint_balance_ = 0;     ///< sightings as a joint of the floor minus the others
  Eigen::Vector3f left_ = Eigen::Vector3f::Zero();
  Eigen::Vector3f right_ = Eigen::Vector3f::Zero();
  double width_m_ = 0.0;
};

}  // namespace colonnade
