// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "entry_reader.hpp"

#include <mrpt/io/CStream.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/serialization/CArchive.h>

#include <stdexcept>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"

namespace colonnade {
namespace {

/// Lets MRPT read from a ByteStream; a short read throws, so that no field is left half filled.
class ArchiveInput : public mrpt::io::CStream {
 public:
  explicit ArchiveInput(ByteStream& bytes) : bytes_(bytes) {}
  std::size_t Read(void* buffer, std::size_t count) override {
    if (bytes_.read(buffer, count) != count) throw std::runtime_error("the log ends here");
    return count;
  }
  std::size_t Write(const void*, std::size_t) override { throw std::logic_error("read only"); }
  std::uint64_t Seek(std::int64_t, TSeekOrigin) override { throw std::logic_error("no seeking"); }
  std::uint64_t getTotalBytesCount() const override { return bytes_.fileSize(); }
  std::uint64_t getPosition() const override { return bytes_.offset(); }

 private:
  ByteStream& bytes_;
};

std::string firstLine(const std::string& text) { return trimmed(text.substr(0, text.find('\n'))); }

}  // namespace

EntryReader::EntryReader(const std::filesystem::path& path) : path_(path), bytes_(path) {
  mrpt::obs::CObservation::GetRuntimeClassIdStatic();
  if (bytes_.fileSize() == 0) throw Error(path.string() + ": empty file, no frames");
  first_ = read();
  if (!first_ && damage_.ending != LogEnding::kCut)
    throw Error(path.string() + ": not an MRPT rawlog (" + damage_.detail + ")");
}

std::optional<Entry> EntryReader::next() {
  if (first_) {
    auto entry = std::move(first_);
    first_.reset();
    return entry;
  }
  if (damage_.ending != LogEnding::kNotReached) return std::nullopt;
  return read();
}

std::optional<Entry> EntryReader::read() {
  Entry entry;
  entry.number = damage_.entries_read;
  entry.offset = bytes_.offset();
  ArchiveInput input(bytes_);
  auto archive = mrpt::serialization::archiveFrom(input);
  std::string reason;
  try {
    entry.object = archive.ReadObject();
  } catch (const std::exception& error) {
    reason = firstLine(error.what());
  }
  if (entry.object) {
    ++damage_.entries_read;
    return entry;
  }
  const bool nothing_read = bytes_.offset() == entry.offset;
  damage_.ending_entry = entry.number;
  damage_.ending_offset = entry.offset;
  switch (bytes_.end()) {
    case ByteStream::End::kNone:
      finish(LogEnding::kDamaged, reason);
      break;
    case ByteStream::End::kEnd:
      finish(nothing_read ? LogEnding::kEnd : LogEnding::kCut,
             nothing_read ? "" : "the file ends inside an object");
      break;
    case ByteStream::End::kCut:
      finish(LogEnding::kCut, bytes_.detail());
      break;
    case ByteStream::End::kDamaged:
    case ByteStream::End::kChecksum:
      finish(LogEnding::kDamaged, bytes_.detail());
      break;
  }
  return std::nullopt;
}

void EntryReader::finish(LogEnding ending, const std::string& detail) {
  damage_.ending = ending;
  damage_.detail = detail;
}

}  // namespace colonnade
