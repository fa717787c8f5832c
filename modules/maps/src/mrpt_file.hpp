// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/serialization/CSerializable.h>

#include <Eigen/Core>
#include <filesystem>
#include <string>

#include "colonnade/base/pose2.hpp"

namespace colonnade {

/// The bytes MRPT's archive makes of an object.
std::string serialised(const mrpt::serialization::CSerializable& object);

/// Writes an object as MRPT's programs expect it in a .gz file, atomically.
void writeObject(const std::filesystem::path& path,
                 const mrpt::serialization::CSerializable& object);

/// Reads the one object of a file, gz or plain. Throws Error when it holds none.
mrpt::serialization::CSerializable::Ptr readObject(const std::filesystem::path& path);

/// A pose with covariance in MRPT's terms. Not-a-number becomes zero: files must stay readable.
mrpt::poses::CPosePDFGaussian toMrpt(const Pose2& pose, const Eigen::Matrix3d& covariance);

}  // namespace colonnade
