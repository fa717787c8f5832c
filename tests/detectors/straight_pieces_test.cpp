// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "straight_pieces.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "synthetic_scene.hpp"

namespace colonnade::testing {
namespace {

std::vector<StraightPiece> levelPieces(const Scene& scene, std::uint32_t seed) {
  const Frame frame =
      withNoise(render(scene, {0.9, 0.0, 0.0, 0.0, {0.0, 0.0}}, 320, 240), 2.0, seed);
  const DepthCells cells = makeDepthCells(frame);
  return straightPieces(cells, cells.rows / 2, {});
}

TEST(StraightPieces, AWallIsOnePieceHoweverAslant) {
  for (const double aslant_m : {0.0, 1.0, 2.0}) {
    const auto pieces =
        levelPieces({{{{3.0 - aslant_m, -2.0}, {3.0 + aslant_m, 2.5}, 120.0}}, {}}, 1);
    ASSERT_EQ(pieces.size(), 1U) << aslant_m;
    EXPECT_GT(pieces[0].length_m, 2.0);
    EXPECT_NEAR(pieces[0].line.at(40), 3.0 - aslant_m / 9.0, 0.08);
  }
}

TEST(StraightPieces, CornersAndJumpsCut) {
  const Face left{{2.0, 1.5}, {3.5, 0.3}, 120.0}, right{{3.5, 0.3}, {3.0, -2.5}, 150.0};
  EXPECT_EQ(levelPieces({{left, right}, {}}, 2).size(), 2U);
  const Face wall{{4.0, 3.0}, {4.0, -3.0}, 120.0}, person{{2.5, 0.2}, {2.5, -0.25}, 60.0};
  const auto pieces = levelPieces({{wall, person}, {}}, 3);
  ASSERT_EQ(pieces.size(), 3U);
  EXPECT_NEAR(pieces[1].length_m, 0.45, 0.08);
}

}  // namespace
}  // namespace colonnade::testing
