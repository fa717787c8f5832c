// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "entry_bytes.hpp"

namespace colonnade {

/// What stands before every object of an MRPT archive: 0x80 + length, class name, version.
struct ObjectHeader {
  std::string class_name;  ///< as written, with or without namespaces
  std::string short_name;  ///< without namespaces: MRPT 1.x wrote none
  std::uint8_t version = 0;
  bool is_null = false;
};

/// Walks over serialised objects without building them: every size is checked before MRPT would
/// make memory for it, every nested class must be one that belongs there. Formats: serializeFrom()
/// of each class in MRPT 2.5.
class ObjectWalker {
 public:
  enum class Result {
    kWhole,   ///< the cursor stands behind the object's end flag
    kUnknown  ///< a class or version whose format is not known here; the cursor is anywhere
  };

  explicit ObjectWalker(EntryBytes& bytes) : bytes_(bytes) {}

  /// Throws StreamEnded or BadBytes. `base`: the class (short name, registered with MRPT) the
  /// object must derive from.
  Result walk(const std::string& base);

  static constexpr std::size_t kLargestBlock = 256U << 20U;  ///< bytes of one vector or image
  static constexpr std::int64_t kMostPixels = 64 << 20;
  static constexpr std::uint32_t kMostObjects = 100000;  ///< in one sensory frame

 private:
  friend struct Bodies;
  void walkObject(const std::string& base, int depth);
  ObjectHeader header();
  /// Nested objects of a known kind, inside a body.
  void object(const std::string& base) { walkObject(base, depth_ + 1); }
  std::uint32_t count(std::size_t bytes_each);
  void block(std::uint32_t elements, std::size_t bytes_each);
  void text();
  bool flag();

  EntryBytes& bytes_;
  int depth_ = 0;
};

/// The header at the cursor, which is left behind it. Throws BadBytes where there is none.
ObjectHeader readHeader(EntryBytes& bytes);

}  // namespace colonnade
