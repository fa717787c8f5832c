// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/slam/bearing_initialization.hpp"

namespace colonnade {

LandmarkId PoseClones::take(EkfSlam& filter) {
  if (!present_) present_ = filter.addPoseClone();
  ++users_[*present_];
  return *present_;
}

void PoseClones::giveBack(LandmarkId clone, EkfSlam& filter) {
  if (--users_.at(clone) > 0) return;
  users_.erase(clone);
  if (present_ == clone) present_.reset();
  filter.remove(clone);
}

}  // namespace colonnade
