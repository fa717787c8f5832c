// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace colonnade {

struct JpegSize {
  int width = 0;
  int height = 0;
};

/// The size a JPEG claims in its frame header (ITU T.81, B.2.2), without decoding it; nothing when
/// there is no such header.
inline std::optional<JpegSize> jpegSize(const std::uint8_t* data, std::size_t size) {
  if (size < 4 || data[0] != 0xff || data[1] != 0xd8) return std::nullopt;
  for (std::size_t at = 2; at + 9 < size;) {
    if (data[at] != 0xff) return std::nullopt;
    const std::uint8_t marker = data[at + 1];
    if (marker == 0xff) {  // fill byte
      ++at;
      continue;
    }
    const bool frame =
        marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (frame)
      return JpegSize{data[at + 7] * 256 + data[at + 8], data[at + 5] * 256 + data[at + 6]};
    if (marker == 0xda) return std::nullopt;  // the scan begins without a frame header
    at += 2U + data[at + 2] * 256U + data[at + 3];
  }
  return std::nullopt;
}

}  // namespace colonnade
