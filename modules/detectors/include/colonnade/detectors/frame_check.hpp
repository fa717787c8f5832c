// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "colonnade/edges/edge_line_backend.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// Why a frame, or its image or its depth alone, shows nothing a landmark could come from; a
/// reason each, to be counted. Empty for a sound frame; a camera without depth lacks nothing.
struct FrameCheck {
  bool image_usable = false;
  bool depth_usable = false;
  std::vector<std::string> lacking;
};

/// Images other than 8-bit gray, under 16 pixels, without contrast (black, white, a lens cap) or
/// full of edges (noise); depth of another type or size than the image, or with next to no value
/// between 0.2 and 15 m.
FrameCheck checkFrame(const Frame& frame, const EdgeLines& edges);

}  // namespace colonnade
