// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mrclam_folder.hpp"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

/// A table of numbers with # comments, read line by line.
class Table {
 public:
  Table(std::filesystem::path path, std::vector<std::string> columns)
      : path_(std::move(path)), columns_(std::move(columns)) {}

  /// Calls `take(row)` for every line; at least one must exist.
  template <class Take>
  void read(Take take) {
    errno = 0;
    std::ifstream file(path_);
    if (!file || std::filesystem::is_directory(path_))
      throw Error(path_.string() + ": " + (errno != 0 ? std::strerror(errno) : "is a folder"));
    std::size_t rows = 0;
    std::string line;
    for (line_ = 1; std::getline(file, line); ++line_) {
      const auto entries = words(trimmed(line.substr(0, line.find('#'))));
      if (entries.empty()) continue;
      take(numbers(entries));
      ++rows;
    }
    if (rows == 0) throw Error(path_.string() + ": holds no line `" + joined(columns_, " ") + "`");
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(path_.string() + ":" + std::to_string(line_) + ": " + reason);
  }

  int whole(double value, const char* what) const {
    if (value != std::floor(value) || std::abs(value) > 1e6)
      fail(std::string(what) + " " + formatDouble(value) + " is no whole number");
    return static_cast<int>(value);
  }

  void requireOrder(double former_s, double now_s) const {
    if (now_s < former_s) fail("stamp " + formatFixed(now_s, 3) + " goes back");
  }

 private:
  std::vector<double> numbers(const std::vector<std::string>& entries) const {
    std::vector<double> row;
    for (const std::string& entry : entries) {
      const auto value = parseDouble(entry);
      if (!value || !std::isfinite(*value)) fail("`" + entry + "` is no finite number");
      row.push_back(*value);
    }
    if (row.size() != columns_.size())
      fail("expected `" + joined(columns_, " ") + "`, found " + std::to_string(row.size()) +
           " numbers");
    return row;
  }

  std::filesystem::path path_;
  std::vector<std::string> columns_;
  int line_ = 0;
};

std::filesystem::path robotFile(const std::filesystem::path& folder, int robot, const char* what) {
  return folder / ("Robot" + std::to_string(robot) + "_" + what + ".dat");
}

}  // namespace

std::map<int, int> readSubjectOfBarcode(const std::filesystem::path& folder) {
  Table table(folder / "Barcodes.dat", {"subject", "barcode"});
  std::map<int, int> subjects;
  table.read([&](const auto& row) {
    const int subject = table.whole(row[0], "subject");
    if (!subjects.emplace(table.whole(row[1], "barcode"), subject).second)
      table.fail("barcode " + formatDouble(row[1]) + " stands twice");
  });
  return subjects;
}

std::vector<MrclamLandmark> readMrclamLandmarks(const std::filesystem::path& folder) {
  Table table(folder / "Landmark_Groundtruth.dat", {"subject", "x", "y", "x_sigma", "y_sigma"});
  std::vector<MrclamLandmark> landmarks;
  table.read([&](const auto& row) {
    landmarks.push_back({table.whole(row[0], "subject"), {row[1], row[2]}, {row[3], row[4]}});
  });
  return landmarks;
}

std::vector<WheelSpeed> readWheelSpeeds(const std::filesystem::path& folder, int robot) {
  Table table(robotFile(folder, robot, "Odometry"),
              {"time", "forward_velocity", "angular_velocity"});
  std::vector<WheelSpeed> speeds;
  table.read([&](const auto& row) {
    if (!speeds.empty()) table.requireOrder(speeds.back().stamp_s, row[0]);
    speeds.push_back({row[0], row[1], row[2]});
  });
  return speeds;
}

std::vector<BarcodeReading> readBarcodeReadings(const std::filesystem::path& folder, int robot) {
  Table table(robotFile(folder, robot, "Measurement"), {"time", "barcode", "range", "bearing"});
  std::vector<BarcodeReading> readings;
  table.read([&](const auto& row) {
    if (!readings.empty()) table.requireOrder(readings.back().stamp_s, row[0]);
    readings.push_back({row[0], table.whole(row[1], "barcode"), row[2], row[3]});
  });
  return readings;
}

Trajectory readMrclamTruth(const std::filesystem::path& folder, int robot) {
  Table table(robotFile(folder, robot, "Groundtruth"), {"time", "x", "y", "orientation"});
  Trajectory truth;
  double former_s = -std::numeric_limits<double>::infinity();
  table.read([&](const auto& row) {
    table.requireOrder(former_s, row[0]);
    if (row[0] > former_s) truth.push_back({row[0], Pose2{row[1], row[2], row[3]}.toIsometry3()});
    former_s = row[0];
  });
  return truth;
}

}  // namespace colonnade
