// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/simulation/truth.hpp"

#include <algorithm>
#include <cmath>

#include "line_walk.hpp"
#include "surfaces.hpp"
#include "upright_lines.hpp"

namespace colonnade {
namespace {

constexpr double kSeenShare = 0.10;  ///< of the image's height that must be seen of a landmark
constexpr int kGapSteps = 2;         ///< hidden steps within a visible piece

/// The longest visible piece of a line, first and last step.
struct Piece {
  int first = 0;
  int last = -1;
};

Piece longestPiece(const std::vector<bool>& visible) {
  Piece best, now;
  for (int step = 0; step < static_cast<int>(visible.size()); ++step) {
    if (!visible[static_cast<std::size_t>(step)]) continue;
    if (now.last < 0 || step - now.last > kGapSteps + 1) now.first = step;
    now.last = step;
    if (now.last - now.first > best.last - best.first || best.last < 0) best = now;
  }
  return best;
}

/// Mean gray level on the side `normal` (unit) points to less that on the other, 2 and 3 pixels
/// beside the piece.
double contrastOf(const cv::Mat& gray, const ImageLine& line, const Piece& piece,
                  const Eigen::Vector2d& normal) {
  double sum = 0.0;
  int count = 0;
  for (int step = piece.first; step <= piece.last; ++step) {
    for (const double beside : {2.0, 3.0}) {
      const Eigen::Vector2d p = line.at(step) + beside * normal,
                            q = line.at(step) - beside * normal;
      const cv::Point here(static_cast<int>(std::lround(p.x())),
                           static_cast<int>(std::lround(p.y())));
      const cv::Point there(static_cast<int>(std::lround(q.x())),
                            static_cast<int>(std::lround(q.y())));
      const cv::Rect image({0, 0}, gray.size());
      if (!image.contains(here) || !image.contains(there)) continue;
      sum += gray.at<unsigned char>(here) - gray.at<unsigned char>(there);
      ++count;
    }
  }
  return count > 0 ? sum / count : 0.0;
}

SeenColumn columnOf(const std::string& kind, int id, bool upright, const ImageLine& line,
                    const Piece& piece, const cv::Mat& gray, const PinholeCamera& camera,
                    const Eigen::Isometry3d& T_world_camera) {
  SeenColumn column;
  column.kind = kind;
  column.id = id;
  column.from = line.at(piece.first);
  column.to = line.at(piece.last);
  if (upright ? column.from.y() > column.to.y() : column.from.x() > column.to.x()) {
    std::swap(column.from, column.to);
  }
  const Eigen::Vector2d along = (column.to - column.from).normalized();
  const Eigen::Vector2d right(along.y(), -along.x());  // of a line drawn downwards
  column.length_px = (column.to - column.from).norm();
  column.contrast = contrastOf(gray, line, piece, upright ? right : Eigen::Vector2d(-right));
  const Eigen::Vector2d middle = 0.5 * (column.from + column.to);
  const Eigen::Vector3d p_camera =
      camera.ray(middle.x(), middle.y()) /
      (0.5 * (line.inverseAt(piece.first) + line.inverseAt(piece.last)));
  column.range_m = (T_world_camera.linear() * p_camera).head<2>().norm();
  return column;
}

LandmarkRecord uprightRecord(const VerticalEdge& edge, LandmarkKind kind, std::size_t id) {
  LandmarkRecord record;
  record.id = LandmarkId{static_cast<std::int32_t>(id)};
  record.kind = kind;
  record.p_world = record.extent_a = record.extent_b = edge.p_world;
  record.hallway = edge.hallway;
  return record;
}

LandmarkRecord floorRecord(const FloorLine& line, std::size_t id) {
  LandmarkRecord record;
  record.id = LandmarkId{static_cast<std::int32_t>(id)};
  record.kind = LandmarkKind::kFloorEdge;
  record.p_world = 0.5 * (line.a + line.b);
  record.extent_a = line.a;
  record.extent_b = line.b;
  const Eigen::Vector2d d = line.b - line.a;
  double direction = std::atan2(d.y(), d.x());
  if (direction < 0.0) direction += kPi;
  record.direction = direction >= kPi ? 0.0 : direction;
  record.hallway = line.hallway;
  return record;
}

}  // namespace

Truth::Truth(const World& world, const Building& building)
    : camera_(world.camera.pinhole()),
      range_m_(world.depth.range_max_m),
      others_(uprightLinesOf(world, building)),
      rounds_(roundOutlinesOf(world)) {
  const auto upright = [&](const VerticalEdge& edge) {
    const auto& p = edge.p_world;
    outlines_.push_back({{p.x(), p.y(), 0.0}, {p.x(), p.y(), edge.height_m}});
  };
  for (const auto& edge : building.edges) {
    landmarks_.push_back(uprightRecord(edge, LandmarkKind::kPillarEdge, landmarks_.size()));
    kinds_.push_back(kindOf(edge.belonging));
    if (edge.partner) {
      landmarks_.back().pair_id = LandmarkId{static_cast<std::int32_t>(*edge.partner)};
    }
    upright(edge);
  }
  for (const auto& line : building.floor_lines) {
    landmarks_.push_back(floorRecord(line, landmarks_.size()));
    kinds_.push_back(name(LandmarkKind::kFloorEdge));
    outlines_.push_back({{line.a.x(), line.a.y(), 0.0}, {line.b.x(), line.b.y(), 0.0}});
  }
  for (const auto& edge : building.edges) {
    if (!edge.slope) continue;
    landmarks_.push_back(uprightRecord(edge, LandmarkKind::kDepthSlope, landmarks_.size()));
    kinds_.push_back(name(LandmarkKind::kDepthSlope));
    upright(edge);
  }
}

Truth::~Truth() = default;

std::vector<SeenColumn> Truth::observe(const Surfaces& surfaces, const cv::Mat& gray,
                                       const Eigen::Isometry3d& T_world_camera, double stamp_s) {
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  std::vector<SeenColumn> columns;
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    auto& landmark = landmarks_[i];
    const auto line =
        projectedLine(T_camera_world * outlines_[i].a, T_camera_world * outlines_[i].b, camera_);
    if (!line) continue;
    const double step_px = (line->to - line->from).norm() / line->steps;
    if (step_px * line->steps < kShortestPx) continue;
    const auto visible = unhiddenSteps(*line, surfaces);
    int in_range = 0;
    for (int step = 0; step <= line->steps; ++step) {
      in_range += visible[static_cast<std::size_t>(step)] && line->inverseAt(step) * range_m_ > 1.0;
    }
    if (step_px * in_range >= kSeenShare * camera_.height_px) {
      if (landmark.observations++ == 0) landmark.first_stamp_s = stamp_s;
      landmark.last_stamp_s = stamp_s;
    }
    const Piece piece = longestPiece(visible);
    if (step_px * (piece.last - piece.first) < kShortestPx) continue;
    columns.push_back(columnOf(kinds_[i], number(landmark.id),
                               landmark.kind != LandmarkKind::kFloorEdge, *line, piece, gray,
                               camera_, T_world_camera));
  }
  const auto projected = [&](const Eigen::Vector2d& p, double bottom_m, double top_m) {
    const auto at = [&](double z) -> Eigen::Vector3d {
      return T_camera_world * Eigen::Vector3d(p.x(), p.y(), z);
    };
    return projectedLine(at(bottom_m), at(top_m), camera_);
  };
  const auto see = [&](const std::string& kind, int id, const ImageLine& line,
                       const std::vector<bool>& visible) {
    const double step_px = (line.to - line.from).norm() / line.steps;
    const Piece piece = longestPiece(visible);
    if (step_px * (piece.last - piece.first) < kShortestPx) return;
    columns.push_back(columnOf(kind, id, true, line, piece, gray, camera_, T_world_camera));
  };
  for (std::size_t i = 0; i < others_.size(); ++i) {
    const auto& other = others_[i];
    if (const auto line = projected(other.p_world, other.bottom_m, other.top_m))
      see(other.kind, static_cast<int>(i), *line, unhiddenSteps(*line, surfaces));
  }
  for (std::size_t i = 0; i < rounds_.size(); ++i) {
    const auto ends = silhouette(rounds_[i], T_world_camera.translation().head<2>());
    for (std::size_t side = 0; side < ends.size(); ++side) {
      const auto line = projected(ends[side].p_world, 0.0, rounds_[i].top_m);
      const auto inner = projected(ends[side].p_inner, 0.0, rounds_[i].top_m);
      if (!line || !inner) continue;
      const auto seen = unhiddenSteps(*inner, surfaces);
      std::vector<bool> visible(static_cast<std::size_t>(line->steps) + 1);
      for (std::size_t step = 0; step < visible.size(); ++step)
        visible[step] = seen[step * (seen.size() - 1) / (visible.size() - 1)];
      see(kindOf(Belonging::kRound), static_cast<int>(2 * i + side), *line, visible);
    }
  }
  return columns;
}

}  // namespace colonnade
