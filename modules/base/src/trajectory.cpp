// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/base/trajectory.hpp"

#include <array>
#include <fstream>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {

Trajectory readTum(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path))
    throw Error(path.string() + ": cannot be read as a TUM trajectory");
  Trajectory trajectory;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const auto complain = [&](const std::string& what) {
      throw Error(path.string() + ":" + std::to_string(number) + ": " + what);
    };
    line = trimmed(line.substr(0, line.find('#')));
    if (line.empty()) continue;
    const auto entries = words(line);
    if (entries.size() != 8)
      complain("a TUM line has 8 numbers (stamp tx ty tz qx qy qz qw), found " +
               std::to_string(entries.size()));
    std::array<double, 8> v{};
    for (std::size_t i = 0; i < v.size(); ++i) {
      const auto value = parseDouble(entries[i]);
      if (!value || !std::isfinite(*value)) complain("\"" + entries[i] + "\" is not a number");
      v[i] = *value;
    }
    Eigen::Quaterniond q(v[7], v[4], v[5], v[6]);
    if (q.norm() < 1e-6) complain("the quaternion is zero");
    if (!trajectory.empty() && v[0] <= trajectory.back().stamp_s)
      complain("the stamp does not grow; sort the file by its first column");
    StampedPose pose;
    pose.stamp_s = v[0];
    pose.T_world_body.linear() = q.normalized().toRotationMatrix();
    pose.T_world_body.translation() << v[1], v[2], v[3];
    trajectory.push_back(pose);
  }
  return trajectory;
}

void writeTum(const std::filesystem::path& path, const Trajectory& trajectory) {
  std::string text = "# stamp tx ty tz qx qy qz qw\n";
  for (const auto& pose : trajectory) {
    Eigen::Quaterniond q(pose.T_world_body.linear());
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    const auto& t = pose.T_world_body.translation();
    text += formatFixed(pose.stamp_s, 6);
    for (const double v : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()})
      text += " " + formatFixed(v, 9);
    text += "\n";
  }
  writeFileAtomically(path, text);
}

}  // namespace colonnade
