// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "colonnade/frames/frame.hpp"

namespace colonnade {

/// How reading a log ended.
enum class LogEnding {
  kNotReached,
  kEnd,     ///< the last object is whole and nothing follows
  kCut,     ///< the file stops inside an object or inside the gz stream
  kDamaged  ///< bytes that are no object, a wrong checksum, or values no sensor can give
};

/// The word used in files and reports.
constexpr const char* name(LogEnding ending) {
  switch (ending) {
    case LogEnding::kNotReached:
      return "not reached";
    case LogEnding::kEnd:
      return "end";
    case LogEnding::kCut:
      return "cut";
    case LogEnding::kDamaged:
      return "damaged";
  }
  return "";
}

/// What was lost on the way. A log with any of it ends in ExitCode::kLossy.
struct Damage {
  LogEnding ending = LogEnding::kNotReached;
  std::size_t entries_read = 0;     ///< whole top-level objects read
  std::size_t ending_entry = 0;     ///< number of the entry that is cut or damaged
  std::uint64_t ending_offset = 0;  ///< where it starts, in bytes of the uncompressed log
  std::string detail;               ///< one line for a person
  std::map<std::string, std::size_t> skipped;  ///< reason -> observations lost
  std::map<std::string, std::size_t> ignored;  ///< what -> observations not used; no loss

  bool any() const {
    return ending == LogEnding::kCut || ending == LogEnding::kDamaged || !skipped.empty();
  }
};

/// A stream of frames in the order of time.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// The next frame, or nothing at the end; `damage()` then tells what kind of end it was.
  virtual std::optional<Frame> next() = 0;
  virtual const Damage& damage() const = 0;
  /// How much of the source has been read, 0 to 1.
  virtual double progress() const = 0;
};

}  // namespace colonnade
