// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "byte_stream.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include "colonnade/base/error.hpp"

namespace colonnade {
namespace {

constexpr std::size_t kChunk = 256 * 1024;
constexpr int kGzipOnly = 15 + 16;  // window bits of zlib: largest window, gzip wrapper

}  // namespace

struct ByteStream::Impl {
  int file = -1;
  std::uint64_t file_size = 0;
  std::uint64_t file_read = 0;
  bool file_ended = false;
  bool compressed = false;
  bool between_members = false;
  z_stream zip{};
  std::vector<unsigned char> input = std::vector<unsigned char>(kChunk);
  std::size_t input_begin = 0, input_end = 0;
  std::vector<unsigned char> output;  // inflated, only for gzip
  std::size_t output_begin = 0, output_end = 0;

  ~Impl() {
    if (compressed) inflateEnd(&zip);
    if (file >= 0) ::close(file);
  }

  /// Fills the input buffer; false with errno set on a read error.
  bool readFile() {
    input_begin = input_end = 0;
    ssize_t count = -1;
    do count = ::read(file, input.data(), input.size());
    while (count < 0 && errno == EINTR);
    if (count < 0) return false;
    file_ended = count == 0;
    input_end = static_cast<std::size_t>(count);
    file_read += input_end;
    return true;
  }
};

ByteStream::ByteStream(const std::filesystem::path& path) : impl_(std::make_unique<Impl>()) {
  const auto fail = [&] { throw Error(path.string() + ": " + std::strerror(errno)); };
  impl_->file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (impl_->file < 0) fail();
  struct stat status {};
  if (::fstat(impl_->file, &status) != 0) fail();
  if (S_ISDIR(status.st_mode)) {
    errno = EISDIR;
    fail();
  }
  impl_->file_size = static_cast<std::uint64_t>(std::max<off_t>(status.st_size, 0));
  if (!impl_->readFile()) fail();
  if (impl_->input_end >= 2 && impl_->input[0] == 0x1f && impl_->input[1] == 0x8b) {
    if (inflateInit2(&impl_->zip, kGzipOnly) != Z_OK)
      throw Error(path.string() + ": zlib cannot be started");
    impl_->compressed = true;
    impl_->output.resize(kChunk);
  }
}

ByteStream::~ByteStream() = default;

bool ByteStream::isCompressed() const { return impl_->compressed; }
std::uint64_t ByteStream::fileSize() const { return impl_->file_size; }

double ByteStream::progress() const {
  if (impl_->file_size == 0) return end_ == End::kNone ? 0.0 : 1.0;
  const auto waiting = impl_->input_end - impl_->input_begin;
  return std::min(
      1.0, static_cast<double>(impl_->file_read - waiting) / static_cast<double>(impl_->file_size));
}

void ByteStream::refill() {
  Impl& s = *impl_;
  if (s.input_begin == s.input_end && !s.file_ended && !s.readFile()) {
    end_ = End::kDamaged;
    detail_ = std::string("read error: ") + std::strerror(errno);
    return;
  }
  const bool exhausted = s.input_begin == s.input_end;
  if (!s.compressed) {
    if (exhausted) end_ = End::kEnd;
    return;
  }
  if (s.between_members) {
    if (exhausted) {
      end_ = End::kEnd;
      return;
    }
    if (s.input[s.input_begin] == 0) {  // zero padding behind a member is legal
      ++s.input_begin;
      return;
    }
    if (s.input[s.input_begin] != 0x1f) {
      end_ = End::kDamaged;
      detail_ = "bytes behind the end of the gz data";
      return;
    }
    inflateReset(&s.zip);
    s.between_members = false;
  }
  if (exhausted) {
    end_ = End::kCut;
    detail_ = "the file ends inside its gz data";
    return;
  }
  s.zip.next_in = s.input.data() + s.input_begin;
  s.zip.avail_in = static_cast<uInt>(s.input_end - s.input_begin);
  s.zip.next_out = s.output.data();
  s.zip.avail_out = static_cast<uInt>(s.output.size());
  const int status = inflate(&s.zip, Z_NO_FLUSH);
  s.input_begin = s.input_end - s.zip.avail_in;
  s.output_begin = 0;
  s.output_end = s.output.size() - s.zip.avail_out;
  if (status == Z_STREAM_END) {
    s.between_members = true;
  } else if (status != Z_OK && status != Z_BUF_ERROR) {
    const std::string reason = s.zip.msg ? s.zip.msg : "cannot be inflated";
    const bool trailer = reason == "incorrect data check" || reason == "incorrect length check";
    end_ = trailer ? End::kChecksum : End::kDamaged;
    detail_ = "gz data: " + reason;
  }
}

std::size_t ByteStream::read(void* destination, std::size_t count) {
  Impl& s = *impl_;
  auto* target = static_cast<unsigned char*>(destination);
  std::size_t done = 0;
  while (done < count) {
    auto& begin = s.compressed ? s.output_begin : s.input_begin;
    const auto available = (s.compressed ? s.output_end : s.input_end) - begin;
    if (available == 0) {
      if (end_ != End::kNone) break;
      refill();
      continue;
    }
    const auto part = std::min(available, count - done);
    std::memcpy(target + done, (s.compressed ? s.output : s.input).data() + begin, part);
    begin += part;
    done += part;
  }
  offset_ += done;
  return done;
}

}  // namespace colonnade
