// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// Made by hdl/generate.py from hdl/accelerator.toml; edit those.
#pragma once

#include <cstdint>

namespace colonnade::registers {

inline constexpr std::uint32_t kIdentity = 0x434F4C4E;
inline constexpr std::uint32_t kInterface = 0x00010000;

// Byte offsets, see hdl/REGISTERS.md.
inline constexpr std::uint32_t kControl = 0x00;
inline constexpr std::uint32_t kGier = 0x04;
inline constexpr std::uint32_t kIer = 0x08;
inline constexpr std::uint32_t kIsr = 0x0C;
inline constexpr std::uint32_t kId = 0x10;
inline constexpr std::uint32_t kVersion = 0x14;
inline constexpr std::uint32_t kSize = 0x18;
inline constexpr std::uint32_t kShape = 0x1C;
inline constexpr std::uint32_t kStatus = 0x20;
inline constexpr std::uint32_t kFrames = 0x24;
inline constexpr std::uint32_t kCycles = 0x28;
inline constexpr std::uint32_t kTailCycles = 0x2C;
inline constexpr std::uint32_t kThresholds = 0x30;
inline constexpr std::uint32_t kVotes = 0x34;
inline constexpr std::uint32_t kVerticals = 0x38;
inline constexpr std::uint32_t kFirstRow = 0x3C;
inline constexpr std::uint32_t kFrameId = 0x40;
inline constexpr std::uint32_t kEnable0 = 0x50;
inline constexpr std::uint32_t kEnable1 = 0x54;
inline constexpr std::uint32_t kEnable2 = 0x58;
inline constexpr std::uint32_t kEnable3 = 0x5C;
inline constexpr std::uint32_t kEnable4 = 0x60;
inline constexpr std::uint32_t kEnable5 = 0x64;

// Fields of registers: a single bit as a mask, others by lowest bit and width.
inline constexpr std::uint32_t kControlStart = 1U << 0;
inline constexpr std::uint32_t kControlDone = 1U << 1;
inline constexpr std::uint32_t kControlIdle = 1U << 2;
inline constexpr std::uint32_t kControlAutoRestart = 1U << 7;
inline constexpr int kShapePixelsLsb = 0;
inline constexpr int kShapePixelsWidth = 8;
inline constexpr int kShapeAnglesLsb = 8;
inline constexpr int kShapeAnglesWidth = 8;
inline constexpr int kShapePassesLsb = 16;
inline constexpr int kShapePassesWidth = 8;
inline constexpr std::uint32_t kShapeShared = 1U << 24;
inline constexpr std::uint32_t kStatusLineShort = 1U << 0;
inline constexpr std::uint32_t kStatusLineLong = 1U << 1;
inline constexpr std::uint32_t kStatusFrameShort = 1U << 2;
inline constexpr std::uint32_t kStatusNoStart = 1U << 3;
inline constexpr std::uint32_t kStatusLateWrite = 1U << 4;

// Fields of a line word.
inline constexpr int kLineVotesLsb = 0;
inline constexpr int kLineVotesWidth = 11;
inline constexpr int kLineRhoLsb = 11;
inline constexpr int kLineRhoWidth = 12;
inline constexpr int kLineThetaLsb = 23;
inline constexpr int kLineThetaWidth = 8;
inline constexpr int kLineClassLsb = 31;
inline constexpr int kLineClassWidth = 1;

}  // namespace colonnade::registers
