// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "colonnade/edges/accelerator_registers.hpp"
#include "colonnade/edges/angle_table.hpp"
#include "colonnade/edges/fixed_lines.hpp"
#include "colonnade/edges/fixed_stage.hpp"
#include "simulation.hpp"

namespace colonnade {

/// What a model was built with; kSet as the parameter SET of accelerator.sv.
template <class ModelType, int kWidth, int kHeight, int kPpc, int kPasses, int kSet, int kBanks>
struct Design {
  using Model = ModelType;
  static constexpr cv::Size size() { return {kWidth, kHeight}; }
  static constexpr int ppc = kPpc;
  static constexpr int banks = kBanks;
  static constexpr bool parallel = kBanks == 0;
  static FixedShape shape() {
    FixedShape shape;
    const auto take = [&](const auto& set) { shape.angles_deg.assign(set.begin(), set.end()); };
    if (kSet == 0) take(kThesisSet);
    if (kSet == 1) take(kRunSet);
    if (kSet == 2) take(kFullSet);
    shape.hysteresis_passes = kPasses;
    return shape;
  }
};

/// One packet of the lines' stream: a frame's lines by angle and distance, and its closing word.
struct Packet {
  std::uint32_t frame_id;
  std::vector<FixedLine> lines;
  std::uint32_t faults;
  std::uint32_t count;
};

/// The bench of one design: gives it parameters and images, and compares what leaves with the model
/// of the arithmetic (FixedStage).
template <class D>
class Rtl : public ::testing::Test {
 protected:
  Rtl() { simulation.write(registers::kControl, 0x80); }

  void configure(const FixedParameters& p) {
    auto word = [](int high, int low) {
      return static_cast<std::uint32_t>(high) << 16 | static_cast<std::uint32_t>(low);
    };
    simulation.write(registers::kThresholds, word(p.high, p.low));
    simulation.write(registers::kVotes, word(p.inclined_votes, p.vertical_votes));
    simulation.write(
        registers::kVerticals,
        static_cast<std::uint32_t>((p.vertical_to_deg & 255) << 8 | (p.vertical_from_deg & 255)));
    simulation.write(registers::kFirstRow, static_cast<std::uint32_t>(p.first_row));
    for (std::uint32_t i = 0; i < 6; ++i) {
      std::uint32_t bits = 0;
      for (std::size_t b = 0; b < 32; ++b) {
        const std::size_t a = 32 * i + b;
        if (p.enabled.empty() || (a < p.enabled.size() && p.enabled[a])) bits |= 1U << b;
      }
      simulation.write(registers::kEnable0 + 4 * i, bits);
    }
  }

  /// Queues the words of an image; `cut` may bend them before they leave.
  void send(const cv::Mat& image) {
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; u += D::ppc) {
        hdl::VideoWord word{0, u == 0 && v == 0, u + D::ppc == image.cols};
        for (int p = 0; p < D::ppc; ++p) {
          word.data |= static_cast<std::uint32_t>(image.at<unsigned char>(v, u + p)) << (8 * p);
        }
        simulation.video.push_back(word);
      }
    }
  }

  void runUntilPackets(std::size_t count, int limit = 4'000'000) {
    while ((simulation.packet_ends.size() < count || !edgesComplete(count)) && limit-- > 0) {
      simulation.cycle();
    }
    ASSERT_GE(simulation.packet_ends.size(), count) << "the design hangs";
  }
  bool edgesComplete(std::size_t frames) const {
    return simulation.edges.size() * D::ppc >= frames * static_cast<std::size_t>(D::size().area());
  }

  Packet packet(std::size_t index) const {
    const std::size_t begin = index == 0 ? 0 : simulation.packet_ends[index - 1];
    const std::size_t end = simulation.packet_ends[index];
    Packet result{simulation.lines[begin],
                  {},
                  simulation.lines[end - 2] >> 16,
                  simulation.lines[end - 2] & 0xffff};
    const auto signedField = [](std::uint32_t word, int low, int width) {
      return static_cast<int>(word << (32 - low - width)) >> (32 - width);
    };
    for (std::size_t i = begin + 1; i + 2 < end; ++i) {
      const std::uint32_t word = simulation.lines[i];
      result.lines.push_back(
          {signedField(word, registers::kLineThetaLsb, registers::kLineThetaWidth),
           signedField(word, registers::kLineRhoLsb, registers::kLineRhoWidth),
           static_cast<int>(word & 0x7ff), static_cast<int>(word >> 31)});
    }
    std::sort(result.lines.begin(), result.lines.end(), [](const auto& a, const auto& b) {
      return std::tie(a.theta_deg, a.rho) < std::tie(b.theta_deg, b.rho);
    });
    return result;
  }

  /// Compares a frame's edge map and lines with the model of the arithmetic.
  void expectExact(std::size_t index, const cv::Mat& image, const FixedParameters& p) {
    const auto expected = stage.process(image, p);
    const auto found = packet(index);
    EXPECT_EQ(found.count, found.lines.size());
    EXPECT_TRUE(found.lines == expected.lines) << "frame " << index << ": " << found.lines.size()
                                               << " lines, not " << expected.lines.size();
    const std::size_t words = static_cast<std::size_t>(D::size().area() / D::ppc);
    int wrong = 0;
    for (std::size_t i = 0; i < words; ++i) {
      const auto& word = simulation.edges[index * words + i];
      const int v = static_cast<int>(i) * D::ppc / D::size().width;
      const int u = static_cast<int>(i) * D::ppc % D::size().width;
      wrong += word.start_of_frame != (i == 0);
      wrong += word.end_of_line != (u + D::ppc == D::size().width);
      for (int k = 0; k < D::ppc; ++k) {
        const std::uint32_t byte = word.data >> (8 * k) & 0xff;
        const std::uint32_t code = byte & 8 ? 1 + (byte & 7) : 0;
        wrong += code != expected.edges.at<unsigned char>(v, u + k);
      }
    }
    EXPECT_EQ(wrong, 0) << "frame " << index;
  }

  cv::Mat randomImage(unsigned seed) const {
    cv::RNG random(seed);
    cv::Mat image(D::size(), CV_8UC1, cv::Scalar(random.uniform(0, 256)));
    if (seed % 3 == 0) random.fill(image, cv::RNG::UNIFORM, 0, 256);
    for (int i = random.uniform(0, 12); i > 0; --i) {
      const auto point = [&] {
        return cv::Point(random.uniform(-20, image.cols + 20),
                         random.uniform(-20, image.rows + 20));
      };
      cv::line(image, point(), point(), cv::Scalar(random.uniform(0, 256)), random.uniform(1, 9));
    }
    return image;
  }
  FixedParameters randomParameters(unsigned seed) const {
    std::mt19937 random(seed);
    FixedParameters p;
    p.low = static_cast<int>(random() % 200);
    p.high = p.low + static_cast<int>(random() % 300);
    p.vertical_votes = 3 + static_cast<int>(random() % 20);
    p.inclined_votes = 3 + static_cast<int>(random() % 20);
    p.vertical_from_deg = -static_cast<int>(random() % 50);
    p.vertical_to_deg = static_cast<int>(random() % 50);
    p.first_row = static_cast<int>(random() % 60);
    for (std::size_t a = 0; a < stage.shape().angles_deg.size(); ++a) {
      p.enabled.push_back(random() % 8 != 0);
    }
    return p;
  }

  /// Clocks that lines of a packet wait because others leave in the same step of the scan.
  static int waitsOf(const std::vector<FixedLine>& lines) {
    std::set<int> steps;
    for (const FixedLine& line : lines) steps.insert(line.rho);
    return static_cast<int>(lines.size() - steps.size());
  }

  /// Clocks that votes still queue for when the last word of a frame's edges has come in, if words
  /// come in every clock: each edge pixel takes one for every slot (BANKS angles of the set) that
  /// has an angle near its direction.
  int backlogOf(std::size_t frame) const {
    if (D::parallel) return 0;
    std::array<int, 4> turns{};
    const auto& angles = stage.shape().angles_deg;
    for (std::size_t d = 0; d < 4; ++d) {
      std::set<std::size_t> slots;
      for (std::size_t a = 0; a < angles.size(); ++a) {
        const auto& entry = kAngleTable[static_cast<std::size_t>(angles[a] - kFirstAngle_deg)];
        if (entry.admitted >> d & 1) slots.insert(a / static_cast<std::size_t>(D::banks));
      }
      turns[d] = static_cast<int>(slots.size());
    }
    const auto words = static_cast<std::size_t>(D::size().area() / D::ppc);
    int left = 0;
    for (std::size_t i = 0; i < words; ++i) {
      const std::uint32_t data = simulation.edges[frame * words + i].data;
      for (int p = 0; p < D::ppc; ++p) {
        if (data >> (8 * p) & 8) left += turns[data >> (8 * p) & 3];
      }
      left = std::max(left - 1, 0);
    }
    return left;
  }

  hdl::Simulation<typename D::Model> simulation;
  FixedStage stage{D::shape()};
};

}  // namespace colonnade
