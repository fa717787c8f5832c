// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"
#include "colonnade/simulation/seen_column.hpp"

namespace colonnade {

ColumnsFile::ColumnsFile(const std::filesystem::path& path)
    : path_(path),
      temporary_(path.parent_path() /
                 (".partial." + std::to_string(::getpid()) + "." + path.filename().string())),
      file_(temporary_, std::ios::binary | std::ios::trunc) {
  file_ << "stamp,frame,id,kind,u0,v0,u1,v1,length_px,range_m,contrast\n";
  check();
}

ColumnsFile::~ColumnsFile() {
  if (temporary_.empty()) return;
  file_.close();
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void ColumnsFile::check() {
  if (!file_) throw Error(path_.string() + ": cannot be written; is the disk full?");
}

void ColumnsFile::add(double stamp_s, std::size_t frame, const std::vector<SeenColumn>& columns) {
  const std::string instant = formatFixed(stamp_s, 6) + "," + std::to_string(frame) + ",";
  std::string rows;
  for (const auto& c : columns) {
    rows += instant + std::to_string(c.id) + "," + c.kind;
    for (const double value : {c.from.x(), c.from.y(), c.to.x(), c.to.y()}) {
      rows += "," + formatFixed(value, 2);
    }
    rows += "," + formatFixed(c.length_px, 1) + "," + formatFixed(c.range_m, 3) + "," +
            formatFixed(c.contrast, 1) + "\n";
  }
  file_ << rows;
  check();
}

void ColumnsFile::finish() {
  file_.close();
  check();
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) throw Error(path_.string() + ": cannot be written: " + error.message());
  temporary_.clear();
}

}  // namespace colonnade
