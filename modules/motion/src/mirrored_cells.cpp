// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mirrored_cells.hpp"

#include <algorithm>
#include <iterator>

#include "residuals.hpp"

namespace colonnade {
namespace {

constexpr int kMinPoints = 3;
constexpr float kFacingUp = 0.8f;       ///< cosine to the picture's up: 37 degrees
constexpr float kLeastParallax = 2.0f;  ///< pixels between the depth measured and infinity
constexpr double kCertainFactor = 0.6, kCertainDifference = 6.0;    ///< squared sigmas
constexpr double kProbableFactor = 0.7, kProbableDifference = 3.0;  ///< once the floor is polished
constexpr float kMost = 8.0f;                                       ///< sigmas
constexpr double kMemory = 1500.0;                                  ///< cells, some twenty frames
constexpr double kPolishedShare = 0.02;

}  // namespace

MirroredCells::MirroredCells(const PinholeCamera& camera,
                             const std::vector<PhotometricPoint>& floor,
                             const PyramidLevel& current,
                             const Eigen::Isometry3d& T_current_reference)
    : grid_(camera), cells_(grid_.size()) {
  const AlignmentState state{T_current_reference, 0.0, 0.0};
  const Eigen::Matrix3f R = T_current_reference.linear().cast<float>();
  const Eigen::Vector3f t = T_current_reference.translation().cast<float>();
  const auto parallax = [&](const PhotometricPoint& point) {
    const Eigen::Vector3f at_infinity = R * point.p_reference;
    const Eigen::Vector3f at_depth = at_infinity + t;
    return static_cast<float>(camera.fx_px) *
           (at_infinity.hnormalized() - at_depth.hnormalized()).norm();
  };
  std::vector<PhotometricPoint> moved;
  std::copy_if(floor.begin(), floor.end(), std::back_inserter(moved),
               [&](const auto& point) { return parallax(point) > kLeastParallax; });
  const std::vector<float> residuals_here = brightnessResiduals(moved, current, state);
  std::vector<PhotometricPoint> points;  // still in the picture
  std::vector<float> here;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (residuals_here[i] < 0.0f) continue;
    points.push_back(moved[i]);
    here.push_back(residuals_here[i]);
  }
  const float noise = brightnessNoise(here);
  std::vector<std::size_t> cell_of;
  for (const PhotometricPoint& point : points) {
    cell_of.push_back(grid_.cellOf(point.p_reference));
    ++cells_[cell_of.back()].points;
  }
  std::vector<PhotometricPoint> placed = points;
  const auto add = [&](const auto& shares, auto cost) {
    for (std::size_t k = 0; k < shares.size(); ++k) {
      for (std::size_t i = 0; i < points.size(); ++i)
        placed[i].p_reference = shares[k] * points[i].p_reference;
      const std::vector<float> residuals =
          shares[k] == 1.0f ? here : brightnessResiduals(placed, current, state);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const float r = residuals[i] >= 0.0f ? std::min(residuals[i] / noise, kMost) : kMost;
        (cells_[cell_of[i]].*cost)[k] += static_cast<double>(r * r);
      }
    }
  };
  add(kAbout, &Cell::cost_about);
  add(kFarther, &Cell::cost_farther);
}

bool MirroredCells::Cell::judged() const { return points >= kMinPoints; }

bool MirroredCells::Cell::prefersFarther(double factor, double difference) const {
  return judged() && *std::min_element(cost_farther.begin(), cost_farther.end()) + difference <
                         factor * *std::min_element(cost_about.begin(), cost_about.end());
}

bool MirroredCells::Cell::mirrors() const {
  return prefersFarther(kProbableFactor, kProbableDifference);
}

int MirroredCells::judged() const {
  return static_cast<int>(
      std::count_if(cells_.begin(), cells_.end(), [](const Cell& cell) { return cell.judged(); }));
}

int MirroredCells::certain() const {
  return static_cast<int>(std::count_if(cells_.begin(), cells_.end(), [](const Cell& cell) {
    return cell.prefersFarther(kCertainFactor, kCertainDifference);
  }));
}

bool MirroredCells::mirrors(const Eigen::Vector3f& p_reference) const {
  return cells_[grid_.cellOf(p_reference)].mirrors();
}

bool MirroredCells::mirrorSomewhere() const {
  return std::any_of(cells_.begin(), cells_.end(), [](const Cell& cell) { return cell.mirrors(); });
}

std::vector<PhotometricPoint> pointsFacingUp(const Reference& reference) {
  const CellGrid grid(reference.pyramid.levels.front().camera);
  std::vector<int> votes(grid.size(), 0);
  for (const SurfacePoint& patch : reference.surfaces)
    votes[grid.cellOf(patch.p_reference)] += -patch.normal.y() > kFacingUp ? 1 : -1;
  std::vector<PhotometricPoint> points = reference.photometric.front();
  std::erase_if(points,
                [&](const auto& point) { return votes[grid.cellOf(point.p_reference)] <= 0; });
  return points;
}

void PolishedFloor::look(const MirroredCells& cells) {
  const double judged = cells.judged();
  if (judged == 0.0) return;
  share_ += judged / (judged + kMemory) * (cells.certain() / judged - share_);
}

bool PolishedFloor::isLikely() const { return share_ > kPolishedShare; }

}  // namespace colonnade
