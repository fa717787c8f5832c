// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// Drives a model built for coverage as a host does: registers, frames with and without stalls,
// broken frames. What comes out is compared in tests/hdl; here only what has been exercised counts.
#include <verilated_cov.h>

#include <cstdio>
#include <cstdlib>
#include <random>

#include "VCovered.h"
#include "simulation.hpp"

namespace {

constexpr int kWidth = COVERED_WIDTH;
constexpr int kHeight = COVERED_HEIGHT;
constexpr int kPpc = COVERED_PPC;
using Simulation = colonnade::hdl::Simulation<VCovered>;

/// Bars and noise, so that every direction, threshold and chain occurs.
void queueFrame(Simulation& simulation, std::mt19937& random) {
  const unsigned kind = random() % 4;
  const int slope = static_cast<int>(random() % 9) - 4;
  const unsigned period = 6 + random() % 30;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; u += kPpc) {
      colonnade::hdl::VideoWord word{0, u == 0 && v == 0, u + kPpc == kWidth};
      for (int p = 0; p < kPpc; ++p) {
        const int place = kind == 1 ? 4 * v + slope * u : 4 * (u + p) + slope * v;
        const bool bar = static_cast<unsigned>(place + 4096) / 4 % period < period / 2;
        const std::uint32_t gray =
            kind == 0 ? random() & 255 : (bar ? 255 - random() % 8 : random() % 8);
        word.data |= gray << (8 * p);
      }
      simulation.video.push_back(word);
    }
  }
}

void runUntil(Simulation& simulation, std::size_t packets) {
  for (int i = 0; i < 3'000'000 && simulation.packet_ends.size() < packets; ++i) simulation.cycle();
  if (simulation.packet_ends.size() < packets) {
    std::fprintf(stderr, "coverage: the design hangs\n");
    std::exit(1);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t frames = argc > 2 ? static_cast<std::size_t>(std::atoi(argv[2])) : 30;
  std::mt19937 random(1);
  Simulation simulation(1);
  for (std::uint32_t offset = 0; offset < 0x70; offset += 4) {
    simulation.read(offset);
    for (const std::uint32_t value : {0xffffffffU, 0U}) {
      simulation.write(offset, value);
      simulation.read(offset);
      simulation.write(offset, value, 0);
    }
  }
  simulation.write(0x04, 1);
  simulation.write(0x08, 3);
  simulation.write(0x00, 0x80);
  for (std::size_t frame = 1; frame <= frames; ++frame) {
    simulation.stalls = {};
    if (frame % 3 == 0)
      simulation.stalls = {static_cast<int>(random() % 600), static_cast<int>(random() % 600), 900,
                           static_cast<int>(random() % 600)};
    const std::uint32_t low = random() % 120;
    simulation.write(0x30, (low + random() % 200) << 16 | low);
    const std::uint32_t votes = frame % 5 == 0 ? 2047 : 2 + random() % 20;
    simulation.write(0x34, votes << 16 | votes);
    simulation.write(0x38, (random() % 60) << 8 | (256 - random() % 60) % 256);
    simulation.write(0x3c, random() % kHeight);
    for (std::uint32_t i = 0; i < 6; ++i)
      simulation.write(0x50 + 4 * i, random() % 4 ? 0xffffffffU : random());
    queueFrame(simulation, random);
    auto& video = simulation.video;
    constexpr std::ptrdiff_t kLine = kWidth / kPpc;
    std::size_t expected = frame;
    switch (frame % 7) {
      case 1:  // a short line
        video.erase(video.begin() + kLine + 2, video.begin() + kLine + 4);
        break;
      case 2:  // a long one
        video.insert(video.begin() + 2 * kLine + 2, 3, colonnade::hdl::VideoWord{});
        break;
      case 3:  // words before a start of frame
        video.insert(video.begin(), 5, colonnade::hdl::VideoWord{});
        break;
      case 4:  // a frame cut short by the next
        video.resize(video.size() - 3 * static_cast<std::size_t>(kLine));
        queueFrame(simulation, random);
        ++expected;
        break;
      case 5:  // a register written in mid-frame
        for (int i = 0; i < 50; ++i) simulation.cycle();
        simulation.write(0x30, 80U << 16 | 40U);
        break;
      default:
        break;
    }
    static std::size_t extra = 0;
    extra += expected - frame;
    runUntil(simulation, frame + extra);
    simulation.read(0x20);
    simulation.write(0x20, 31);
    simulation.write(0x0c, 3);
  }
  VerilatedCov::write(argv[1]);
  return 0;
}
