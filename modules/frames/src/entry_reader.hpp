// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <filesystem>
#include <optional>
#include <string>

#include "byte_stream.hpp"
#include "colonnade/frames/frame_source.hpp"
#include "entry_bytes.hpp"

namespace colonnade {

/// One top-level object of a rawlog.
struct Entry {
  std::size_t number = 0;
  std::uint64_t offset = 0;  ///< where it starts, in bytes of the uncompressed log
  mrpt::serialization::CSerializable::Ptr object;
};

/// Reads the top-level objects of a rawlog one by one and tells how the log ends. Every object of a
/// class frames are made of is checked by ObjectWalker before MRPT builds it. Never throws after
/// construction for bad bytes: an object MRPT refuses although its frame is sound is skipped and
/// counted, anything else ends the log.
class EntryReader {
 public:
  /// Throws Error when the file cannot be read, is empty or does not begin with an MRPT object.
  explicit EntryReader(const std::filesystem::path& path);

  std::optional<Entry> next();
  const Damage& damage() const { return damage_; }
  Damage& damage() { return damage_; }
  const ByteStream& stream() const { return stream_; }

 private:
  /// The object at the cursor; null when MRPT cannot build it. Throws StreamEnded and BadBytes.
  mrpt::serialization::CSerializable::Ptr readObject();
  void finish(LogEnding ending, const std::string& detail);
  void finishAtEndOfStream(bool inside_object);

  ByteStream stream_;
  EntryBytes bytes_;
  Damage damage_;
};

}  // namespace colonnade
