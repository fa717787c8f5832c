// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_file.hpp"

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/io/zip.h>
#include <mrpt/serialization/CArchive.h>

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

void writeObject(const std::filesystem::path& path,
                 const mrpt::serialization::CSerializable& object) {
  const std::string bytes = serialised(object);
  std::vector<unsigned char> packed;
  if (!mrpt::io::zip::compress_gz_data_block({bytes.begin(), bytes.end()}, packed))
    throw Error(path.string() + ": " + std::to_string(bytes.size()) +
                " bytes cannot be compressed");
  writeFileAtomically(path, {reinterpret_cast<const char*>(packed.data()), packed.size()});
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
