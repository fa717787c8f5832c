// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/base/log_path.hpp"

#include <string>

namespace colonnade {

std::filesystem::path logStem(const std::filesystem::path& log) {
  std::string name = log.filename().string();
  for (const std::string ending : {".gz", ".rawlog"})
    if (name.size() > ending.size() && name.ends_with(ending))
      name.resize(name.size() - ending.size());
  return log.parent_path() / name;
}

}  // namespace colonnade
