// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/detectors/detection_csv.hpp"

#include <algorithm>
#include <cmath>

#include "colonnade/base/angle.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

std::string row(const Frame& frame, std::size_t index, const Detection& detection) {
  const Measurement& m = detection.measurement;
  const bool measured = m.z.size() > 0;
  const bool ranged = measured && m.hasRange();
  std::string refusal = detection.refusal;
  std::replace(refusal.begin(), refusal.end(), ',', ';');
  std::vector<std::string> cells{formatFixed(frame.stamp_s, 6), std::to_string(frame.index),
                                 std::to_string(index), name(detection.kind()), refusal};
  for (const Eigen::Vector2d& p : {detection.a_px, detection.b_px})
    for (const double pixel : {p.x(), p.y()}) cells.push_back(formatFixed(pixel, 2));
  cells.push_back(measured ? formatFixed(degrees(m.z(0)), 4) : "");
  cells.push_back(ranged ? formatFixed(m.z(1), 4) : "");
  cells.push_back(measured ? formatFixed(degrees(std::sqrt(m.R(0, 0))), 4) : "");
  cells.push_back(ranged ? formatFixed(std::sqrt(m.R(1, 1)), 4) : "");
  cells.push_back(std::to_string(detection.appearance.gradient_sign));
  cells.push_back(detection.partner ? std::to_string(*detection.partner) : "");
  cells.push_back(detection.width_m > 0.0 ? formatFixed(detection.width_m, 4) : "");
  cells.emplace_back(detection.on_surface ? "1" : "");
  return joined(cells, ",") + "\n";
}

}  // namespace

std::string detectionCsvHeader() {
  return "stamp,frame,detection,kind,refusal,u0,v0,u1,v1,angle_deg,distance_m,sigma_deg,sigma_m,"
         "gradient_sign,partner,width_m,on_surface\n";
}

std::string detectionCsvRows(const Frame& frame, const Detections& detections) {
  std::string rows;
  for (std::size_t i = 0; i < detections.size(); ++i) rows += row(frame, i, detections[i]);
  return rows;
}

}  // namespace colonnade
