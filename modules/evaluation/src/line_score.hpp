// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/evaluation/landmark_score.hpp"
#include "landmark_assignment.hpp"

namespace colonnade {

/// The score of floor edges, but for the shares, and of the walls they belong to.
KindScore scoreLines(const LandmarkLists& lists, const LandmarkScoreOptions& options,
                     const std::optional<Anchor>& anchor, WallScore& walls);

}  // namespace colonnade
