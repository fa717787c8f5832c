// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "byte_stream.hpp"

namespace colonnade {

/// The stream ended inside an object.
struct StreamEnded : std::runtime_error {
  StreamEnded() : std::runtime_error("the file ends inside an object") {}
};

/// Bytes that cannot be what they should be.
struct BadBytes : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The bytes of one top-level object, fetched from the stream as far as they are looked at, so that
/// an object can be checked before MRPT makes memory for it.
class EntryBytes {
 public:
  explicit EntryBytes(ByteStream& stream) : stream_(stream) {}

  /// Forgets the bytes before the cursor: the next object starts here.
  void startEntry() {
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(cursor_));
    entry_offset_ += cursor_;
    cursor_ = 0;
  }

  template <class Number>
  Number take() {
    Number value;
    std::memcpy(&value, takeBlock(sizeof value), sizeof value);
    return value;
  }
  /// The next `count` bytes; the pointer holds until more is taken.
  const std::uint8_t* takeBlock(std::size_t count) {
    fetch(cursor_ + count);
    cursor_ += count;
    return bytes_.data() + cursor_ - count;
  }
  void skip(std::size_t count) { takeBlock(count); }

  /// True when the stream has no byte at the cursor.
  bool atEnd() { return !fetchIfAny(cursor_ + 1); }
  std::size_t cursor() const { return cursor_; }
  void setCursor(std::size_t cursor) { cursor_ = cursor; }
  std::uint64_t entryOffset() const { return entry_offset_; }
  const ByteStream& stream() const { return stream_; }

 private:
  bool fetchIfAny(std::size_t count) {
    // By pieces: a wrong count must not reserve more than the file has.
    constexpr std::size_t kPiece = 1024 * 1024;
    while (bytes_.size() < count) {
      const std::size_t had = bytes_.size();
      const std::size_t wanted = std::min(kPiece, count - had);
      bytes_.resize(had + wanted);
      const std::size_t got = stream_.read(bytes_.data() + had, wanted);
      bytes_.resize(had + got);
      if (got < wanted) return false;
    }
    return true;
  }
  void fetch(std::size_t count) {
    if (!fetchIfAny(count)) throw StreamEnded();
  }

  ByteStream& stream_;
  std::vector<std::uint8_t> bytes_;
  std::size_t cursor_ = 0;
  std::uint64_t entry_offset_ = 0;
};

}  // namespace colonnade
