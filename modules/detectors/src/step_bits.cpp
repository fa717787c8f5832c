// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "step_bits.hpp"

#include <algorithm>
#include <opencv2/core/hal/intrin.hpp>
#include <utility>

namespace colonnade {
namespace {

/// Edge codes by which way the gradient points across the line: 0 is no edge, then the sectors.
struct Codes {
  std::uint8_t rising[3], falling[3];
};
constexpr Codes kSteep{{8, 1, 2}, {4, 5, 6}}, kFlat{{2, 3, 4}, {6, 7, 8}};

using Lanes = cv::v_uint8x16;
constexpr int kLanes = Lanes::nlanes;

void storeWhere(const Lanes& code, const std::uint8_t (&codes)[3], std::uint8_t* bits) {
  const Lanes one_of = (code == cv::v_setall_u8(codes[0])) | (code == cv::v_setall_u8(codes[1])) |
                       (code == cv::v_setall_u8(codes[2]));
  const auto mask = static_cast<unsigned>(cv::v_signmask(one_of));
  bits[0] = static_cast<std::uint8_t>(mask);
  bits[1] = static_cast<std::uint8_t>(mask >> 8);
}
bool isOneOf(std::uint8_t code, const std::uint8_t (&codes)[3]) {
  return code == codes[0] || code == codes[1] || code == codes[2];
}

/// Which pixels of a row have codes that stand for steps in these directions. The steps of the bits
/// are rows.
struct RowBits {
  const Codes& codes;
  EdgeBits& bits;
};
template <std::size_t kKinds>
void setRowBits(const std::uint8_t* row, int columns, int v, const RowBits (&kinds)[kKinds]) {
  int u = 0;
  for (; u + kLanes <= columns; u += kLanes) {
    const Lanes code = cv::v_load(row + u);
    if (!cv::v_check_any(code > cv::v_setzero_u8())) continue;  // most pixels are no edges
    for (const auto& [codes, bits] : kinds) {
      storeWhere(code, codes.rising, bits.rising.step(v) + u / 8);
      storeWhere(code, codes.falling, bits.falling.step(v) + u / 8);
    }
  }
  for (; u < columns; ++u)
    for (const auto& [codes, bits] : kinds) {
      if (isOneOf(row[u], codes.rising)) bits.rising.set(v, u);
      if (isOneOf(row[u], codes.falling)) bits.falling.set(v, u);
    }
}

/// Bit c of byte r becomes bit r of byte c (Warren, "Hacker's Delight", 7-3).
std::uint64_t transposed(std::uint64_t x) {
  std::uint64_t t = (x ^ x >> 7) & 0x00AA00AA00AA00AAULL;
  x ^= t ^ t << 7;
  t = (x ^ x >> 14) & 0x0000CCCC0000CCCCULL;
  x ^= t ^ t << 14;
  t = (x ^ x >> 28) & 0x00000000F0F0F0F0ULL;
  return x ^ t ^ t << 28;
}

/// Rows become columns.
StepBits transposed(const StepBits& rows, int height, int width) {
  StepBits columns(width, height);
  constexpr int kTile = 8, kTiles = 8;
  for (int v = 0; v < height; v += kTile) {
    const int count = std::min(kTile, height - v);
    for (int u = 0; u < width; u += kTiles * kTile) {
      std::uint64_t any = 0;
      for (int i = 0; i < count; ++i) any |= rows.from(v + i, u);
      for (int tile_u = u; tile_u < std::min(u + kTiles * kTile, width); tile_u += kTile) {
        if ((any >> (tile_u - u) & 0xff) == 0) continue;  // most tiles hold no edges
        std::uint64_t tile = 0;
        for (int i = 0; i < count; ++i)
          tile |= std::uint64_t{rows.step(v + i)[tile_u / 8]} << (8 * i);
        tile = transposed(tile);
        for (int i = 0; i < std::min(kTile, width - tile_u); ++i)
          columns.step(tile_u + i)[v / 8] = static_cast<std::uint8_t>(tile >> (8 * i));
      }
    }
  }
  return columns;
}

}  // namespace

BitsOfBoth bitsOfBoth(const cv::Mat& edges) {
  const StepBits none(edges.rows, edges.cols);
  EdgeBits steep{none, none}, flat{none, none};
  for (int v = 0; v < edges.rows; ++v)
    setRowBits(edges.ptr<std::uint8_t>(v), edges.cols, v, {{kSteep, steep}, {kFlat, flat}});
  return {std::move(steep),
          {transposed(flat.rising, edges.rows, edges.cols),
           transposed(flat.falling, edges.rows, edges.cols)}};
}

void setSteepBits(const std::uint8_t* edges, int columns, int row, EdgeBits& bits) {
  setRowBits(edges, columns, row, {{kSteep, bits}});
}

}  // namespace colonnade
