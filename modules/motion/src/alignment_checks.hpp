// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/motion/motion.hpp"
#include "colonnade/motion/motion_options.hpp"
#include "rgbd_alignment.hpp"

// Whether an alignment can be believed.
namespace colonnade {

/// The current image shows what the reference shows, in the same places.
bool seesTheSame(const Alignment& alignment, const MotionOptions& options);

/// Seen the same, or, where there is no brightness to compare, enough of the same surfaces.
bool isSound(const Alignment& alignment, const MotionOptions& options);

/// Brightness in a picture full of it: before bare walls there is little.
bool isFullOfTexture(const Alignment& alignment);

/// Nobody moves like that in the time.
bool isPlausible(const Eigen::Isometry3d& T_previous_camera, double time_s,
                 const MotionOptions& options);

/// Far from what is expected: perhaps a wrong minimum.
bool isSurprising(const Eigen::Isometry3d& T_previous_camera, const MotionPrior& prior);

/// The reference is too far behind, or too little of it is still in view.
bool isWornOut(const Alignment& alignment, const MotionOptions& options);

/// What the alignment rests on.
MotionSource sourceOf(const Alignment& alignment);

}  // namespace colonnade
