// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/CObservation.h>

#include <cstdint>
#include <vector>

#include "colonnade/frames/rawlog_writer.hpp"

namespace colonnade {

/// The sensor observations of a record. Their images are left out (externally stored under
/// a mark); `withImages` puts them into the serialised bytes, so that a JPEG keeps its bytes.
std::vector<mrpt::obs::CObservation::Ptr> observationsOf(const FrameRecord& record,
                                                         const RawlogWriterOptions& options);

/// Replaces the marked images in serialised objects by the record's, in the format of CImage.
std::vector<std::uint8_t> withImages(std::vector<std::uint8_t> objects, const FrameRecord& record,
                                     int jpeg_quality);

}  // namespace colonnade
