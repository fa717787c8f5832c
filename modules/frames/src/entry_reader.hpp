// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <filesystem>
#include <optional>
#include <string>

#include "byte_stream.hpp"
#include "colonnade/frames/frame_source.hpp"

namespace colonnade {

/// One top-level object of a rawlog.
struct Entry {
  std::size_t number = 0;
  std::uint64_t offset = 0;  ///< where it starts, in bytes of the uncompressed log
  mrpt::serialization::CSerializable::Ptr object;
};

/// Reads the top-level objects of a rawlog one by one and tells how the log ends. Never throws
/// after construction for bad bytes: they end the log.
class EntryReader {
 public:
  /// Throws Error when the file cannot be read, is empty or does not begin with an MRPT object.
  explicit EntryReader(const std::filesystem::path& path);

  std::optional<Entry> next();
  const Damage& damage() const { return damage_; }
  Damage& damage() { return damage_; }
  const ByteStream& bytes() const { return bytes_; }

 private:
  std::optional<Entry> read();
  void finish(LogEnding ending, const std::string& detail);

  std::filesystem::path path_;
  ByteStream bytes_;
  Damage damage_;
  std::optional<Entry> first_;
};

}  // namespace colonnade
