// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "standing_part.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace colonnade {
namespace {

constexpr double kSigmas = 4.0;
/// Something this much nearer stands before the surface; whether that moved is not known.
constexpr double kBefore_m = 0.5;
constexpr int kCells = 16;  ///< across the picture
constexpr int kMinPatches = 2;
constexpr double kMinShare = 1.0 / 3.0;  ///< of a cell's patches, to call it moving
constexpr float kBody_m = 0.35f;         ///< what is so near to it moves with it
constexpr double kMostMoving = 0.5;      ///< of all patches
constexpr double kWidestPerson_m = 1.5;  ///< or two; what is wider is a wall

enum class Patch { kUnknown, kStands, kMoved };

Patch judge(const SurfacePoint& point, const PyramidLevel& current,
            const Eigen::Isometry3d& T_current_reference, const Matrix6& covariance) {
  const Eigen::Vector3d q = T_current_reference * point.p_reference.cast<double>();
  if (q.z() < 0.2) return Patch::kUnknown;
  const PinholeCamera& camera = current.camera;
  const auto u = static_cast<int>(std::lround(camera.fx_px * q.x() / q.z() + camera.cx_px));
  const auto v = static_cast<int>(std::lround(camera.fy_px * q.y() / q.z() + camera.cy_px));
  if (u < 0 || v < 0 || u >= current.depth_m.cols || v >= current.depth_m.rows)
    return Patch::kUnknown;
  const double depth = static_cast<double>(current.depth_m.at<float>(v, u));
  if (depth <= 0.0 || depth < q.z() - kBefore_m) return Patch::kUnknown;
  const Eigen::Vector3d n = T_current_reference.linear() * point.normal.cast<double>();
  const double r = n.dot(q - camera.ray(u, v) * depth);
  const Vector6 J = planeDistanceByCamera(n, q);
  const double variance = J.dot(covariance * J) + 1.0 / static_cast<double>(point.inverse_variance);
  return r * r > kSigmas * kSigmas * variance ? Patch::kMoved : Patch::kStands;
}

/// A coarse picture of the reference: where something moved, and how far away it was.
class MovingCells {
 public:
  explicit MovingCells(const PinholeCamera& camera)
      : camera_(camera), cell_px_(std::max(1, camera.width_px / kCells)), cells_(size()) {}

  void add(const Eigen::Vector3f& p, Patch patch) {
    Cell* cell = at(column(p), row(p));
    if (!cell || patch == Patch::kUnknown) return;
    ++cell->patches;
    if (patch != Patch::kMoved) return;
    ++cell->moved;
    cell->nearest_m = std::min(cell->nearest_m, p.z());
    cell->farthest_m = std::max(cell->farthest_m, p.z());
  }

  /// The widest row of cells that move beside each other; 0 where nothing moves.
  double widestMoving_m() const {
    double widest_m = 0.0;
    for (int row = 0; row < rows(); ++row) {
      double width_m = 0.0;
      for (int column = 0; column < columns(); ++column) {
        const Cell* cell = at(column, row);
        width_m = cell->moves() ? width_m + widthAt(cell->nearest_m) : 0.0;
        widest_m = std::max(widest_m, width_m);
      }
    }
    return widest_m;
  }

  /// Whether the point is part of what moves in its cell or one beside it.
  bool moves(const Eigen::Vector3f& p) const {
    for (int dv = -1; dv <= 1; ++dv)
      for (int du = -1; du <= 1; ++du) {
        const Cell* cell = at(column(p) + du, row(p) + dv);
        if (cell && cell->moves() && p.z() > cell->nearest_m - kBody_m &&
            p.z() < cell->farthest_m + kBody_m)
          return true;
      }
    return false;
  }

 private:
  struct Cell {
    int patches = 0;
    int moved = 0;
    float nearest_m = 1e9f;
    float farthest_m = 0.0f;
    bool moves() const { return moved >= kMinPatches && moved >= kMinShare * patches; }
  };

  double widthAt(float depth_m) const {
    return cell_px_ * static_cast<double>(depth_m) / camera_.fx_px;
  }
  int columns() const { return camera_.width_px / cell_px_ + 1; }
  int rows() const { return camera_.height_px / cell_px_ + 1; }
  std::size_t size() const { return static_cast<std::size_t>(columns() * rows()); }
  int column(const Eigen::Vector3f& p) const {
    const double u = camera_.fx_px * static_cast<double>(p.x() / p.z()) + camera_.cx_px;
    return static_cast<int>(std::floor(u / cell_px_));
  }
  int row(const Eigen::Vector3f& p) const {
    const double v = camera_.fy_px * static_cast<double>(p.y() / p.z()) + camera_.cy_px;
    return static_cast<int>(std::floor(v / cell_px_));
  }
  const Cell* at(int column, int row) const {
    if (column < 0 || row < 0 || column >= columns() || row >= rows()) return nullptr;
    return &cells_[static_cast<std::size_t>(row * columns() + column)];
  }
  Cell* at(int column, int row) {
    return const_cast<Cell*>(static_cast<const MovingCells*>(this)->at(column, row));
  }

  PinholeCamera camera_;
  int cell_px_;
  std::vector<Cell> cells_;
};

}  // namespace

Vector6 planeDistanceByCamera(const Eigen::Vector3d& n, const Eigen::Vector3d& q) {
  Vector6 J;
  J << -n, -q.cross(n);
  return J;
}

std::optional<Reference> standingPart(const Reference& reference, const RgbdPyramid& current,
                                      const Eigen::Isometry3d& T_reference_current,
                                      const Matrix6& covariance, double least_share) {
  if (reference.pyramid.levels.empty() || current.levels.empty()) return std::nullopt;
  const Eigen::Isometry3d T_current_reference = T_reference_current.inverse();
  MovingCells cells(reference.pyramid.levels.front().camera);
  std::size_t moved = 0;
  for (const SurfacePoint& point : reference.surfaces) {
    const Patch patch = judge(point, current.levels.front(), T_current_reference, covariance);
    cells.add(point.p_reference, patch);
    moved += patch == Patch::kMoved;
  }
  const double share = static_cast<double>(moved) / static_cast<double>(reference.surfaces.size());
  const double width_m = cells.widestMoving_m();
  if (width_m == 0.0 || width_m > kWidestPerson_m) return std::nullopt;
  if (share < least_share || share > kMostMoving) return std::nullopt;
  Reference standing = reference;
  const auto moves = [&](const auto& point) { return cells.moves(point.p_reference); };
  std::erase_if(standing.surfaces, moves);
  for (auto& points : standing.photometric) std::erase_if(points, moves);
  return standing;
}

}  // namespace colonnade
