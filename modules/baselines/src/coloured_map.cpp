// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "coloured_map.hpp"

#include <mrpt/maps/CColouredPointsMap.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "colonnade/base/atomic_file.hpp"

namespace colonnade {
namespace {

constexpr std::size_t kVertexBytes = 15;
static_assert(std::endian::native == std::endian::little, "the file's byte order");

}  // namespace

struct ColouredMap::Impl {
  double spacing_m;
  double max_depth_m;
  mrpt::maps::CColouredPointsMap map;
};

ColouredMap::ColouredMap(double spacing_m, double max_depth_m) : impl_(std::make_unique<Impl>()) {
  impl_->spacing_m = spacing_m;
  impl_->max_depth_m = max_depth_m;
}
ColouredMap::~ColouredMap() = default;

void ColouredMap::add(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  mrpt::maps::CColouredPointsMap local;
  local.reserve(static_cast<std::size_t>(frame.depth_m.total()) / 4);
  for (int v = 0; v < frame.depth_m.rows; ++v) {
    const float* depth = frame.depth_m.ptr<float>(v);
    Eigen::Vector3d last = Eigen::Vector3d::Constant(1e9);
    for (int u = 0; u < frame.depth_m.cols; ++u) {
      if (!(depth[u] > 0.05f) || depth[u] > impl_->max_depth_m) continue;
      const Eigen::Vector3d p = static_cast<double>(depth[u]) * frame.camera.ray(u, v);
      if ((p - last).norm() < impl_->spacing_m) continue;
      last = p;
      cv::Vec3b bgr;
      if (!frame.colour.empty())
        bgr = frame.colour.at<cv::Vec3b>(v, u);
      else if (!frame.gray.empty())
        bgr = cv::Vec3b::all(frame.gray.at<std::uint8_t>(v, u));
      const Eigen::Vector3f q = (T_world_camera * p).cast<float>();
      local.insertPointRGB(q.x(), q.y(), q.z(), static_cast<float>(bgr[2]) / 255.0f,
                           static_cast<float>(bgr[1]) / 255.0f,
                           static_cast<float>(bgr[0]) / 255.0f);
    }
  }
  impl_->map.insertAnotherMap(&local, mrpt::poses::CPose3D::Identity());
}

std::size_t ColouredMap::size() const { return impl_->map.size(); }

void ColouredMap::write(const std::filesystem::path& path) const {
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                     std::to_string(impl_->map.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\n"
                     "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
  text.reserve(text.size() + kVertexBytes * impl_->map.size());
  for (std::size_t i = 0; i < impl_->map.size(); ++i) {
    std::array<float, 3> point{};
    std::array<float, 3> colour{};
    impl_->map.getPointRGB(i, point[0], point[1], point[2], colour[0], colour[1], colour[2]);
    std::array<char, kVertexBytes> vertex{};
    std::memcpy(vertex.data(), point.data(), sizeof point);
    for (std::size_t c = 0; c < colour.size(); ++c)
      vertex[sizeof point + c] = static_cast<char>(std::lround(255.0f * colour[c]));
    text.append(vertex.data(), vertex.size());
  }
  writeFileAtomically(path, text);
}

}  // namespace colonnade
