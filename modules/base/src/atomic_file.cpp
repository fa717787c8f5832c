// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/base/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "colonnade/base/error.hpp"

namespace colonnade {
namespace {

std::string systemReason() { return std::strerror(errno); }

void flushToDisk(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) throw Error(path.string() + ": " + systemReason());
  const bool flushed = ::fsync(file) == 0;
  const std::string reason = systemReason();
  ::close(file);
  if (!flushed) throw Error(path.string() + ": " + reason);
}

}  // namespace

void writeFileAtomically(const std::filesystem::path& path,
                         const std::function<void(const std::filesystem::path&)>& write) {
  // The temporary name keeps the extensions: writers choose format and compression by them.
  const auto temporary = path.parent_path() / (".partial." + std::to_string(::getpid()) + "." +
                                               path.filename().string());
  try {
    write(temporary);
    flushToDisk(temporary);
    std::filesystem::rename(temporary, path);
  } catch (const std::exception& error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw Error(path.string() + ": cannot be written: " + error.what());
  }
}

void writeFileAtomically(const std::filesystem::path& path, std::string_view content) {
  writeFileAtomically(path, [&](const std::filesystem::path& temporary) {
    std::ofstream file(temporary, std::ios::binary);
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    file.close();
    if (!file) throw Error(std::to_string(content.size()) + " bytes: " + systemReason());
  });
}

}  // namespace colonnade
