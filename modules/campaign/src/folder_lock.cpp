// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "colonnade/base/error.hpp"

namespace colonnade {

FolderLock::FolderLock(const std::filesystem::path& folder, const std::string& what) {
  const auto path = folder / ".lock";
  file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (file_ < 0) throw Error(path.string() + ": cannot be written: " + std::strerror(errno));
  if (::flock(file_, LOCK_EX | LOCK_NB) == 0) return;
  const bool held = errno == EWOULDBLOCK;
  const std::string why = held ? "another process is at it" : std::strerror(errno);
  ::close(file_);
  throw Error(what + " (" + folder.string() + "): " + why);
}

FolderLock::~FolderLock() { ::close(file_); }

}  // namespace colonnade
