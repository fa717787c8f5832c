// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "entry_reader.hpp"

#include <mrpt/io/CStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <new>

#include "colonnade/base/error.hpp"
#include "colonnade/base/text.hpp"
#include "object_walker.hpp"

namespace colonnade {
namespace {

/// Lets MRPT read an entry; a short read throws, so that no field is left half filled.
class ArchiveInput : public mrpt::io::CStream {
 public:
  explicit ArchiveInput(EntryBytes& bytes) : bytes_(bytes) {}
  std::size_t Read(void* buffer, std::size_t count) override {
    try {
      std::memcpy(buffer, bytes_.takeBlock(count), count);
    } catch (const StreamEnded&) {
      ended_ = true;
      throw;
    }
    return count;
  }
  std::size_t Write(const void*, std::size_t) override { throw std::logic_error("read only"); }
  std::uint64_t Seek(std::int64_t, TSeekOrigin) override { throw std::logic_error("no seeking"); }
  std::uint64_t getTotalBytesCount() const override { return 0; }
  std::uint64_t getPosition() const override { return bytes_.cursor(); }
  bool ended() const { return ended_; }

 private:
  EntryBytes& bytes_;
  bool ended_ = false;  ///< MRPT wraps exceptions, so the kind must be remembered
};

/// The last of MRPT's nested messages that says something, on one line.
std::string reasonOf(const std::exception& error) {
  std::string text = error.what();
  const auto message = text.find("Message:");
  if (message != std::string::npos) text = text.substr(message + 8);
  text = trimmed(text);
  return text.substr(0, text.find('\n'));
}

/// What may stand at the top level of a rawlog.
void requireLogEntry(const ObjectHeader& header) {
  const auto* type = mrpt::rtti::findRegisteredClass(header.class_name);
  if (!type) throw BadBytes("class " + header.class_name + " is not known");
  for (const auto* base : {CLASS_ID(mrpt::obs::CObservation), CLASS_ID(mrpt::obs::CSensoryFrame),
                           CLASS_ID(mrpt::obs::CActionCollection)})
    if (type->derivedFrom(base)) return;
  throw BadBytes("it holds a " + header.class_name);
}

}  // namespace

EntryReader::EntryReader(const std::filesystem::path& path) : stream_(path), bytes_(stream_) {
  if (stream_.fileSize() == 0) throw Error(path.string() + ": empty file, no frames");
  try {
    requireLogEntry(readHeader(bytes_));
  } catch (const BadBytes& bad) {
    throw Error(path.string() + ": not an MRPT rawlog (" + bad.what() + ")");
  } catch (const StreamEnded&) {
    if (stream_.end() == ByteStream::End::kDamaged)
      throw Error(path.string() + ": not an MRPT rawlog (" + stream_.detail() + ")");
    // Cut inside its first object: a log without whole entries.
  }
  bytes_.setCursor(0);
}

std::optional<Entry> EntryReader::next() {
  while (damage_.ending == LogEnding::kNotReached) {
    bytes_.startEntry();
    Entry entry;
    entry.number = damage_.entries_read;
    entry.offset = bytes_.entryOffset();
    damage_.ending_entry = entry.number;
    damage_.ending_offset = entry.offset;
    if (bytes_.atEnd()) {
      finishAtEndOfStream(false);
      break;
    }
    try {
      entry.object = readObject();
      ++damage_.entries_read;
      if (entry.object) return entry;
    } catch (const StreamEnded&) {
      finishAtEndOfStream(true);
    } catch (const BadBytes& bad) {
      finish(LogEnding::kDamaged, bad.what());
    }
  }
  return std::nullopt;
}

mrpt::serialization::CSerializable::Ptr EntryReader::readObject() {
  ObjectWalker walker(bytes_);
  const bool framed = walker.walk("") == ObjectWalker::Result::kWhole;
  const std::size_t end = bytes_.cursor();
  bytes_.setCursor(0);
  ArchiveInput input(bytes_);
  auto archive = mrpt::serialization::archiveFrom(input);
  std::string reason;
  try {
    auto object = archive.ReadObject();
    if (object && (!framed || bytes_.cursor() == end)) return object;
    reason = "its length is not what its class says";
  } catch (const std::bad_alloc&) {
    reason = "it asks for too much memory";
  } catch (const std::exception& error) {
    reason = reasonOf(error);
  }
  if (!framed && input.ended()) throw StreamEnded();
  bytes_.setCursor(0);
  const std::string name = readHeader(bytes_).class_name;
  if (!framed) throw BadBytes(name + ": " + reason);
  ++damage_.skipped[name + " that MRPT cannot read: " + reason];
  bytes_.setCursor(end);
  return nullptr;
}

void EntryReader::finishAtEndOfStream(bool inside_object) {
  switch (stream_.end()) {
    case ByteStream::End::kNone:
    case ByteStream::End::kEnd:
      if (inside_object)
        finish(LogEnding::kCut, "the file ends inside an object");
      else
        finish(LogEnding::kEnd, "");
      break;
    case ByteStream::End::kCut:
      finish(LogEnding::kCut, stream_.detail());
      break;
    case ByteStream::End::kDamaged:
    case ByteStream::End::kChecksum:
      finish(LogEnding::kDamaged, stream_.detail());
      break;
  }
}

void EntryReader::finish(LogEnding ending, const std::string& detail) {
  damage_.ending = ending;
  damage_.detail = detail;
}

}  // namespace colonnade
