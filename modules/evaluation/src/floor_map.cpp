// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/evaluation/floor_map.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

/// The flat `key: value` lines of the file.
class Settings {
 public:
  explicit Settings(const std::filesystem::path& path) : path_(path) {
    std::ifstream file(path);
    if (!file || std::filesystem::is_directory(path))
      throw Error(path.string() + ": cannot be read as a floor map (YAML)");
    std::string line;
    while (std::getline(file, line)) {
      line = line.substr(0, line.find('#'));
      const auto colon = line.find(':');
      if (colon == std::string::npos) continue;
      std::string value = trimmed(line.substr(colon + 1));
      if (value.size() >= 2 && (value.front() == '"' || value.front() == '\''))
        value = value.substr(1, value.size() - 2);
      values_[trimmed(line.substr(0, colon))] = value;
    }
  }

  std::string text(const std::string& key) const {
    const auto found = values_.find(key);
    if (found == values_.end() || found->second.empty())
      throw Error(path_.string() + ": \"" + key + "\" is missing; a floor map has image, " +
                  "resolution and origin");
    return found->second;
  }
  double number(const std::string& key) const { return toNumber(key, text(key)); }
  double numberOr(const std::string& key, double otherwise) const {
    return values_.contains(key) ? number(key) : otherwise;
  }
  Pose2 pose(const std::string& key) const {
    std::string list = text(key);
    if (list.front() != '[' || list.back() != ']') complain(key, list, "[x, y, yaw]");
    const auto entries = fields(list.substr(1, list.size() - 2), ',');
    if (entries.size() != 3) complain(key, list, "[x, y, yaw]");
    return {toNumber(key, entries[0]), toNumber(key, entries[1]), toNumber(key, entries[2])};
  }
  [[noreturn]] void complain(const std::string& key, const std::string& value,
                             const std::string& wanted) const {
    throw Error(path_.string() + ": " + key + ": \"" + value + "\" is not " + wanted);
  }

 private:
  double toNumber(const std::string& key, const std::string& value) const {
    const auto number = parseDouble(value);
    if (!number || !std::isfinite(*number)) complain(key, value, "a number");
    return *number;
  }

  std::filesystem::path path_;
  std::map<std::string, std::string> values_;
};

}  // namespace

std::size_t FloorMap::freeCells() const {
  return static_cast<std::size_t>(std::count(free.begin(), free.end(), std::uint8_t{1}));
}

FloorMap readFloorMap(const std::filesystem::path& yaml) {
  const Settings settings(yaml);
  FloorMap map;
  map.resolution_m = settings.number("resolution");
  if (map.resolution_m <= 0.0)
    settings.complain("resolution", settings.text("resolution"), "above zero");
  map.T_world_corner = settings.pose("origin");
  const bool negate = settings.numberOr("negate", 0.0) != 0.0;
  const double free_below = settings.numberOr("free_thresh", 0.196);
  const auto image = yaml.parent_path() / settings.text("image");
  if (!std::filesystem::is_regular_file(image))
    throw Error(yaml.string() + ": its picture " + image.string() + " is missing");
  const cv::Mat cells = cv::imread(image.string(), cv::IMREAD_GRAYSCALE);
  if (cells.empty()) throw Error(image.string() + ": cannot be read as a picture");
  map.width = cells.cols;
  map.height = cells.rows;
  map.free.reserve(cells.total());
  for (int row = map.height - 1; row >= 0; --row)
    for (int column = 0; column < map.width; ++column) {
      const double shade = cells.at<unsigned char>(row, column) / 255.0;
      const double occupancy = negate ? shade : 1.0 - shade;
      map.free.push_back(occupancy < free_below ? 1 : 0);
    }
  if (map.freeCells() == 0) throw Error(image.string() + ": holds no free cell");
  return map;
}

}  // namespace colonnade
