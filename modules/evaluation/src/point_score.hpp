// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/evaluation/landmark_score.hpp"
#include "landmark_assignment.hpp"

namespace colonnade {

/// The score of one kind of upright landmarks, but for the shares.
KindScore scorePoints(const LandmarkLists& lists, const LandmarkScoreOptions& options,
                      const std::optional<Anchor>& anchor);

}  // namespace colonnade
