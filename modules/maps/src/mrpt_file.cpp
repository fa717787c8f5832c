// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_file.hpp"

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <cmath>
#include <exception>
#include <vector>

#include "colonnade/base/atomic_file.hpp"
#include "colonnade/base/error.hpp"

namespace colonnade {
namespace {

/// MRPT's messages have many lines; ours have one.
std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

std::string serialised(const mrpt::serialization::CSerializable& object) {
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  archive << object;
  return {static_cast<const char*>(memory.getRawBufferData()), memory.getTotalBytesCount()};
}

/// gz in memory: MRPT's compress_gz_data_block goes through a temporary file whose name two
/// programs at once may share, and then yields an empty block.
std::string gzipped(const std::string& bytes) {
  z_stream stream{};
  constexpr int kGzipWindow = 15 + 16;
  constexpr int kMemoryLevel = 8;
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzipWindow, kMemoryLevel,
                   Z_DEFAULT_STRATEGY) != Z_OK)
    throw Error("zlib cannot be started");
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  const int result = deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  if (result != Z_STREAM_END) throw Error(std::to_string(bytes.size()) + " bytes do not compress");
  return packed;
}

void writeObject(const std::filesystem::path& path,
                 const mrpt::serialization::CSerializable& object) {
  writeFileAtomically(path, gzipped(serialised(object)));
}

mrpt::serialization::CSerializable::Ptr readObject(const std::filesystem::path& path) {
  mrpt::io::CFileGZInputStream file;
  if (!std::filesystem::is_regular_file(path) || !file.open(path.string()))
    throw Error(path.string() + ": cannot be read");
  try {
    auto object = mrpt::serialization::archiveFrom(file).ReadObject();
    if (object) return object;
  } catch (const std::exception& error) {
    throw Error(path.string() + ": holds no whole MRPT object: " + firstLine(error.what()));
  }
  throw Error(path.string() + ": holds no MRPT object");
}

mrpt::poses::CPosePDFGaussian toMrpt(const Pose2& pose, const Eigen::Matrix3d& covariance) {
  const auto finite = [](double value) { return std::isfinite(value) ? value : 0.0; };
  mrpt::poses::CPosePDFGaussian result;
  result.mean = mrpt::poses::CPose2D(finite(pose.x), finite(pose.y), finite(pose.phi));
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      result.cov(row, column) = finite(0.5 * (covariance(row, column) + covariance(column, row)));
  return result;
}

}  // namespace colonnade
