// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace colonnade {

/// The bytes of a file, inflated when it is gzip (any number of members), without holding it whole.
/// Unlike gzread it tells a clean end, a cut and damaged data apart, and never loses bytes that
/// were inflated before a wrong checksum.
class ByteStream {
 public:
  enum class End {
    kNone,     ///< more bytes may follow
    kEnd,      ///< the file, and its last gz member, is whole
    kCut,      ///< the file ends inside a gz member
    kDamaged,  ///< data zlib cannot inflate, bytes behind the last gz member, or a read error
    kChecksum  ///< everything was inflated, but its checksum or length is wrong
  };

  /// Throws Error naming path and reason when the file is missing, unreadable or a folder.
  explicit ByteStream(const std::filesystem::path& path);
  ~ByteStream();
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  /// Copies up to `count` bytes; fewer only when the stream has ended, see `end()`.
  std::size_t read(void* destination, std::size_t count);

  /// Bytes handed out so far, counted after inflating.
  std::uint64_t offset() const { return offset_; }
  End end() const { return end_; }
  const std::string& detail() const { return detail_; }
  bool isCompressed() const;
  std::uint64_t fileSize() const;
  /// How much of the file has been consumed, 0 to 1.
  double progress() const;

 private:
  struct Impl;
  void refill();

  std::unique_ptr<Impl> impl_;
  std::uint64_t offset_ = 0;
  End end_ = End::kNone;
  std::string detail_;
};

}  // namespace colonnade
