// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/landmark_looks.hpp"

#include <algorithm>
#include <utility>

namespace colonnade {
namespace {

/// The newest sighting counts at least this much: light changes along the way.
constexpr float kLeastGain = 0.1F;

double meanSquare(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return static_cast<double>((a - b).squaredNorm()) / 3.0;
}

}  // namespace

void LandmarkLooks::observe(const Detection& detection) {
  ++sightings_;
  gradient_balance_ += detection.appearance.gradient_sign;
  if (detection.kind() == LandmarkKind::kFloorEdge) joint_balance_ += detection.on_surface ? 1 : -1;
  const float gain = std::max(kLeastGain, 1.0F / static_cast<float>(sightings_));
  left_ += gain * (detection.appearance.left - left_);
  right_ += gain * (detection.appearance.right - right_);
  if (detection.width_m <= 0.0) return;
  width_m_ += width_m_ > 0.0 ? static_cast<double>(kLeastGain) * (detection.width_m - width_m_)
                             : detection.width_m;
}

bool LandmarkLooks::sameDarkSide(const Detection& detection) const {
  return gradient_balance_ * detection.appearance.gradient_sign >= 0;
}

LandmarkLooks LandmarkLooks::fromOtherSide() const {
  LandmarkLooks looks = *this;
  looks.gradient_balance_ = -gradient_balance_;
  std::swap(looks.left_, looks.right_);
  return looks;
}

double LandmarkLooks::colourDistance(const LandmarkLooks& other) const {
  return static_cast<double>(
      std::max((left_ - other.left_).norm(), (right_ - other.right_).norm()));
}

void LandmarkLooks::merge(const LandmarkLooks& other) {
  if (other.sightings_ == 0) return;
  const float share =
      static_cast<float>(other.sightings_) / static_cast<float>(sightings_ + other.sightings_);
  left_ += share * (other.left_ - left_);
  right_ += share * (other.right_ - right_);
  if (width_m_ <= 0.0) width_m_ = other.width_m_;
  sightings_ += other.sightings_;
  gradient_balance_ += other.gradient_balance_;
  joint_balance_ += other.joint_balance_;
}

LandmarkLooks::Difference LandmarkLooks::difference(const Detection& detection, double colour_sigma,
                                                    double width_sigma) const {
  Difference difference;
  if (sightings_ == 0) return difference;
  difference.numbers = 1;
  difference.distance2 = std::min(meanSquare(left_, detection.appearance.left),
                                  meanSquare(right_, detection.appearance.right)) /
                         (colour_sigma * colour_sigma);
  if (width_m_ > 0.0 && detection.width_m > 0.0) {
    const double off = (detection.width_m - width_m_) / (width_sigma * width_m_);
    difference.distance2 += off * off;
    ++difference.numbers;
  }
  return difference;
}

}  // namespace colonnade
