// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "colonnade/edges/edge_view.hpp"
#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// How a frame's camera looks at the floor, for the image stage.
inline EdgeView edgeViewOf(const Frame& frame) {
  const PinholeCamera& camera = frame.camera;
  return {camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px, frame.T_robot_camera.linear()};
}

}  // namespace colonnade
