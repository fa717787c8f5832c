// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/floor_plan.hpp"

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {

FloorPlan drawFloorPlan(const Building& building, const Eigen::Vector2d& p_start,
                        double resolution_m) {
  constexpr int kFree = 254, kWall = 0, kUnknown = 205;
  FloorPlan plan;
  plan.resolution_m = resolution_m;
  plan.origin = building.low;
  const Eigen::Vector2d size = (building.high - building.low) / resolution_m;
  plan.cells = cv::Mat(static_cast<int>(std::ceil(size.y())), static_cast<int>(std::ceil(size.x())),
                       CV_8UC1, cv::Scalar(kUnknown));
  const auto cell = [&](const Eigen::Vector2d& p) {
    const Eigen::Vector2d q = (p - plan.origin) / resolution_m;
    return cv::Point(static_cast<int>(std::floor(q.x())),
                     plan.cells.rows - 1 - static_cast<int>(std::floor(q.y())));
  };
  for (const auto& line : building.outline) {
    cv::line(plan.cells, cell(line.a), cell(line.b), cv::Scalar(kWall), 1, cv::LINE_8);
  }
  const cv::Point start = cell(p_start);
  if (!cv::Rect({0, 0}, plan.cells.size()).contains(start) ||
      plan.cells.at<unsigned char>(start) == kWall) {
    throw Error("the robot starts inside a wall or outside the building; move 'start'",
                ExitCode::kUsage);
  }
  cv::floodFill(plan.cells, start, cv::Scalar(kFree), nullptr, cv::Scalar(), cv::Scalar(), 4);
  return plan;
}

void writeFloorPlan(const std::filesystem::path& stem, const FloorPlan& plan) {
  std::vector<unsigned char> png;
  cv::imencode(".png", plan.cells, png);
  const std::filesystem::path image = stem.string() + ".png";
  writeFileAtomically(image,
                      std::string_view(reinterpret_cast<const char*>(png.data()), png.size()));
  writeFileAtomically(stem.string() + ".yaml",
                      "image: " + image.filename().string() +
                          "\nresolution: " + formatDouble(plan.resolution_m) + "\norigin: [" +
                          formatDouble(plan.origin.x()) + ", " + formatDouble(plan.origin.y()) +
                          ", 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

}  // namespace colonnade
