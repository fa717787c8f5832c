// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "object_walker.hpp"

#include <mrpt/rtti/CObject.h>

#include <algorithm>

#include "object_bodies.hpp"

namespace colonnade {

ObjectHeader readHeader(EntryBytes& bytes) {
  constexpr std::size_t kLongestName = 120;
  const auto length_byte = bytes.take<std::uint8_t>();
  const std::size_t length = length_byte & 0x7fU;
  if ((length_byte & 0x80U) == 0 || length == 0 || length > kLongestName)
    throw BadBytes("no MRPT object begins here");
  const auto* name = bytes.takeBlock(length);
  ObjectHeader header;
  header.class_name.assign(reinterpret_cast<const char*>(name), length);
  const bool sound = std::all_of(header.class_name.begin(), header.class_name.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' ||
           c == ':' || c == '<' || c == '>';
  });
  if (!sound) throw BadBytes("no MRPT object begins here");
  header.is_null = header.class_name == "nullptr";
  if (header.is_null) return header;
  header.version = bytes.take<std::uint8_t>();
  const auto colon = header.class_name.rfind(':');
  header.short_name =
      colon == std::string::npos ? header.class_name : header.class_name.substr(colon + 1);
  return header;
}

void ObjectWalker::walkObject(const std::string& base, int depth) {
  constexpr int kDeepest = 8;
  constexpr std::uint8_t kEndFlag = 0x88;
  if (depth > kDeepest) throw BadBytes("objects nested too deeply");
  const auto header = readHeader(bytes_);
  if (header.is_null) throw BadBytes("an empty object");
  const auto* type = mrpt::rtti::findRegisteredClass(header.class_name);
  if (!type || !type->ptrCreateObject)
    throw BadBytes("class " + header.class_name + " is not known");
  if (!base.empty() && header.short_name != base) {
    const auto* base_type = mrpt::rtti::findRegisteredClass(base);
    if (!base_type || !type->derivedFrom(base_type))
      throw BadBytes("class " + header.class_name + " where a " + base + " should be");
  }
  const ObjectBody* body = bodyOf(header.short_name);
  if (body == nullptr) throw UnknownFormat();
  const int outer = depth_;
  depth_ = depth;
  (*body)(*this, header.version);
  depth_ = outer;
  if (bytes_.take<std::uint8_t>() != kEndFlag)
    throw BadBytes("the end of a " + header.class_name + " is missing");
}

ObjectWalker::Result ObjectWalker::walk(const std::string& base) {
  try {
    walkObject(base, 0);
    return Result::kWhole;
  } catch (const UnknownFormat&) {
    return Result::kUnknown;
  }
}

std::uint32_t ObjectWalker::count(std::size_t bytes_each) {
  const auto count = bytes_.take<std::uint32_t>();
  if (count > kLargestBlock / bytes_each) throw BadBytes("a list of absurd length");
  return count;
}

void ObjectWalker::block(std::uint32_t elements, std::size_t bytes_each) {
  if (elements > kLargestBlock / bytes_each) throw BadBytes("a list of absurd length");
  bytes_.skip(elements * bytes_each);
}

void ObjectWalker::text() {
  const auto length = bytes_.take<std::uint32_t>();
  if (length > 65536) throw BadBytes("a text of absurd length");
  bytes_.skip(length);
}

bool ObjectWalker::flag() {
  const auto value = bytes_.take<std::uint8_t>();
  if (value > 1) throw BadBytes("a switch that is neither on nor off");
  return value == 1;
}

}  // namespace colonnade
