// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <random>

#include "rtl_bench.hpp"
#include "rtl_designs.hpp"
#include "shared_data.hpp"

namespace colonnade {
namespace {

using Designs = ::testing::Types<COLONNADE_RTL_DESIGNS>;
TYPED_TEST_SUITE(Rtl, Designs);

TYPED_TEST(Rtl, SaysWhatItIs) {
  EXPECT_EQ(this->simulation.read(registers::kId), registers::kIdentity);
  EXPECT_EQ(this->simulation.read(registers::kVersion), registers::kInterface);
  EXPECT_EQ(this->simulation.read(registers::kSize),
            static_cast<std::uint32_t>(TypeParam::size().height << 16 | TypeParam::size().width));
  const std::uint32_t shape = this->simulation.read(registers::kShape);
  EXPECT_EQ(shape & 255, static_cast<std::uint32_t>(TypeParam::ppc));
  EXPECT_EQ(shape >> 8 & 255, this->stage.shape().angles_deg.size());
}

TYPED_TEST(Rtl, KeepsBytesWithoutStrobe) {
  auto& simulation = this->simulation;
  simulation.write(registers::kThresholds, 0x01230045);
  simulation.write(registers::kThresholds, 0x03ff0267, 0b0110);  // the outer bytes stay
  EXPECT_EQ(simulation.read(registers::kThresholds), 0x01ff0245U);
  simulation.write(registers::kFirstRow, 0x00aa, 0b0010);
  EXPECT_EQ(simulation.read(registers::kFirstRow), 0U);
  simulation.write(registers::kEnable0, 0, 0b0001);
  EXPECT_EQ(simulation.read(registers::kEnable0) & 0xff, 0U);
  simulation.write(registers::kControl, 0, 0b1110);  // automatic restart is in the lowest byte
  EXPECT_EQ(simulation.read(registers::kControl) & 0x80, 0x80U);
}

/// Address and data come apart, answers wait, reads and writes overlap: each is answered once, and
/// what was written stands.
TYPED_TEST(Rtl, AnswersEachAccessOnceHoweverTheMasterStalls) {
  auto& simulation = this->simulation;
  std::mt19937 random(3);
  std::uint32_t thresholds = simulation.read(registers::kThresholds);
  simulation.write(registers::kFirstRow, 7);
  for (int i = 0; i < 400; ++i) {
    simulation.stalls.registers = static_cast<int>(random() % 1000);
    const std::uint32_t value = random() & 0x03ff03ff;
    std::uint32_t strobed = 0;
    const int strobes = static_cast<int>(random() % 16);
    for (int b = 0; b < 4; ++b) strobed |= strobes >> b & 1 ? 0xffU << (8 * b) : 0;
    const auto writes = simulation.write_answers;
    const auto reads = simulation.read_answers;
    const typename decltype(this->simulation)::Write write{registers::kThresholds, value, strobes};
    EXPECT_EQ(simulation.access(write, registers::kFirstRow), 7U);
    thresholds = (thresholds & ~strobed) | (value & strobed);
    EXPECT_EQ(simulation.read(registers::kThresholds), thresholds);
    for (int k = static_cast<int>(random() % 8); k > 0; --k) simulation.cycle();
    EXPECT_EQ(simulation.write_answers, writes + 1);
    EXPECT_EQ(simulation.read_answers, reads + 2);
  }
}

TYPED_TEST(Rtl, TakesOneFrameForEachStartAndInterrupts) {
  const FixedParameters p{60, 90, 8, 8, -10, 10, 0, {}};
  this->configure(p);
  auto& simulation = this->simulation;
  simulation.write(registers::kControl, 1);
  simulation.write(registers::kGier, 1);
  simulation.write(registers::kIer, 1);
  this->send(this->randomImage(1));
  this->send(this->randomImage(4));
  this->runUntilPackets(1);
  if (this->HasFatalFailure()) return;
  EXPECT_TRUE(simulation.interrupt());
  EXPECT_EQ(simulation.read(registers::kControl) & 2, 2U);  // done, cleared by reading
  EXPECT_EQ(simulation.read(registers::kControl) & 2, 0U);
  simulation.write(registers::kIsr, 1);
  EXPECT_FALSE(simulation.interrupt());
  for (int i = 0; i < 4 * TypeParam::size().area(); ++i) simulation.cycle();
  EXPECT_EQ(simulation.packet_ends.size(), 1U) << "nobody asked for the second frame";
  EXPECT_EQ(simulation.read(registers::kFrames), 0x00010001U);
  simulation.write(registers::kControl, 1);
  this->runUntilPackets(2);
  this->expectExact(0, this->randomImage(1), p);
  this->expectExact(1, this->randomImage(4), p);
}

TYPED_TEST(Rtl, GivesTheBitsOfTheModelForEveryFrameWithRandomStalls) {
  // COLONNADE_RTL_FRAMES=1000 for the long comparison.
  const char* wanted = std::getenv("COLONNADE_RTL_FRAMES");
  const unsigned frames =
      wanted ? static_cast<unsigned>(std::atoi(wanted)) : (TypeParam::size().width == 320 ? 8 : 40);
  for (unsigned seed = 1; seed <= frames; ++seed) {
    const auto p = this->randomParameters(seed);
    auto& stalls = this->simulation.stalls;
    stalls = {};
    if (seed % 2 == 0)
      stalls = {static_cast<int>(seed * 97 % 700), static_cast<int>(seed * 53 % 700),
                static_cast<int>(seed * 31 % 900), static_cast<int>(seed * 71 % 900)};
    this->configure(p);
    const cv::Mat image = this->randomImage(seed);
    this->send(image);
    this->runUntilPackets(seed);
    if (this->HasFatalFailure()) return;
    this->expectExact(seed - 1, image, p);
    EXPECT_EQ(this->packet(seed - 1).faults, 0U);
    EXPECT_EQ(this->packet(seed - 1).frame_id, seed - 1);
    if (this->HasFailure()) return;
  }
  EXPECT_EQ(this->simulation.read(registers::kStatus), 0U);
}

TYPED_TEST(Rtl, TakesFramesWithoutAGap) {
  const auto p = FixedParameters{60, 90, 8, 8, -10, 10, 0, {}};
  this->configure(p);
  for (unsigned i = 0; i < 5; ++i) this->send(this->randomImage(3 * i + 1));
  this->runUntilPackets(5);
  if (this->HasFatalFailure()) return;
  for (unsigned i = 0; i < 5; ++i) this->expectExact(i, this->randomImage(3 * i + 1), p);
  const auto& starts = this->simulation.frame_starts;
  ASSERT_EQ(starts.size(), 5U);
  // Where votes do not queue for long, as in the shape of `run`.
  const bool sustained = TypeParam::parallel || TypeParam::size().width == 320;
  for (std::size_t i = 1; i < starts.size() && sustained; ++i) {
    EXPECT_EQ(starts[i] - starts[i - 1],
              static_cast<std::uint64_t>(TypeParam::size().area() / TypeParam::ppc));
  }
}

TYPED_TEST(Rtl, KeepsFramesApartWhenTheSinksAreSlow) {
  const auto p = FixedParameters{60, 90, 8, 8, -10, 10, 0, {}};
  this->configure(p);
  this->simulation.stalls = {100, 500, 1018, 300};
  for (unsigned i = 0; i < 4; ++i) this->send(this->randomImage(3 * i + 1));
  this->runUntilPackets(4);
  if (this->HasFatalFailure()) return;
  for (unsigned i = 0; i < 4; ++i) this->expectExact(i, this->randomImage(3 * i + 1), p);
}

TYPED_TEST(Rtl, MendsBrokenFramesAndSaysSo) {
  const FixedParameters p{60, 90, 8, 8, -10, 10, 0, {}};
  this->configure(p);
  auto& simulation = this->simulation;
  const std::size_t words_of_line =
      static_cast<std::size_t>(TypeParam::size().width / TypeParam::ppc);
  std::size_t frames = 0;
  const auto expectFaults = [&](std::uint32_t faults, const char* what) {
    // A broken frame is followed by a whole one, which must be right.
    const cv::Mat image = this->randomImage(7);
    this->send(image);
    frames += 2;
    this->runUntilPackets(frames);
    if (this->HasFatalFailure()) return;
    EXPECT_EQ(this->packet(frames - 2).faults, faults & 7) << what;
    EXPECT_EQ(simulation.read(registers::kStatus) & 31, faults) << what;
    simulation.write(registers::kStatus, 31);
    EXPECT_EQ(simulation.read(registers::kStatus), 0U) << what;
    this->expectExact(frames - 1, image, p);
    EXPECT_EQ(this->packet(frames - 1).faults, 0U) << what;
  };

  this->send(this->randomImage(1));  // the second line lacks three words
  simulation.video.erase(simulation.video.begin() + static_cast<std::ptrdiff_t>(words_of_line + 2),
                         simulation.video.begin() + static_cast<std::ptrdiff_t>(words_of_line + 5));
  expectFaults(1, "short line");

  this->send(this->randomImage(1));  // the third line goes on
  simulation.video.insert(
      simulation.video.begin() + static_cast<std::ptrdiff_t>(2 * words_of_line + 5), 4,
      hdl::VideoWord{});
  expectFaults(2, "long line");

  this->send(this->randomImage(1));  // the last ten lines are missing
  simulation.video.resize(simulation.video.size() - 10 * words_of_line);
  expectFaults(4, "short frame");

  this->send(this->randomImage(1));  // two lines too many
  for (std::size_t i = 0; i < 2 * words_of_line; ++i) {
    simulation.video.push_back({0, false, (i + 1) % words_of_line == 0});
  }
  expectFaults(8, "data without a start of frame");

  this->send(this->randomImage(1));  // the last line lacks a word, and the next frame waits
  simulation.video.pop_back();
  simulation.video.back().end_of_line = true;
  expectFaults(1, "short last line");
}

TYPED_TEST(Rtl, ARegisterWrittenInMidFrameCountsForTheNextFrame) {
  const FixedParameters before{60, 90, 8, 8, -10, 10, 0, {}};
  FixedParameters after = before;
  after.low = 20;
  after.high = 150;
  this->configure(before);
  auto& simulation = this->simulation;
  for (const int clocks : {200, 2000}) {
    const std::size_t frames = simulation.packet_ends.size();
    const cv::Mat image = this->randomImage(4);
    this->send(image);
    while (simulation.frame_starts.size() == frames) simulation.cycle();
    for (int i = 0; i < clocks / TypeParam::ppc && !simulation.video.empty(); ++i)
      simulation.cycle();
    ASSERT_FALSE(simulation.video.empty());
    simulation.write(registers::kThresholds, 150U << 16 | 20U);
    this->send(image);
    this->runUntilPackets(frames + 2);
    if (this->HasFatalFailure()) return;
    EXPECT_EQ(simulation.read(registers::kStatus), 16U);
    simulation.write(registers::kStatus, 16);
    this->expectExact(frames, image, before);
    this->expectExact(frames + 1, image, after);
    this->configure(before);
  }
}

/// A write that lands in the very clock a frame begins is either in time for it or reported.
TYPED_TEST(Rtl, AWriteAtAFramesBeginningIsInTimeOrReported) {
  const FixedParameters before{60, 90, 8, 8, -10, 10, 0, {}};
  FixedParameters after = before;
  after.low = 20;
  after.high = 150;
  auto& simulation = this->simulation;
  const cv::Mat image = this->randomImage(4);
  this->configure(before);
  this->send(image);  // the memories are clear once it has gone through
  this->runUntilPackets(1);
  int late = 0;
  for (int lead = 0; lead < 6; ++lead) {
    this->configure(before);
    const std::size_t frame = simulation.packet_ends.size();
    for (int i = 16 * TypeParam::size().width; i > 0; --i)
      simulation.cycle();  // blank lines go out
    this->send(image);
    for (int i = 0; i < lead; ++i) simulation.cycle();
    simulation.write(registers::kThresholds, 150U << 16 | 20U);
    this->runUntilPackets(frame + 1);
    if (this->HasFatalFailure()) return;
    const bool reported = simulation.read(registers::kStatus) == 16;
    simulation.write(registers::kStatus, 31);
    this->expectExact(frame, image, reported ? before : after);
    late += reported;
  }
  EXPECT_GT(late, 0);
}

TYPED_TEST(Rtl, WorksOnAfterAResetAtAnyMoment) {
  std::mt19937 random(5);
  const auto p = FixedParameters{60, 90, 8, 8, -10, 10, 0, {}};
  auto& simulation = this->simulation;
  for (int i = 0; i < 12; ++i) {
    this->configure(this->randomParameters(static_cast<unsigned>(i)));
    this->send(this->randomImage(3));
    this->send(this->randomImage(6));
    simulation.stalls = {static_cast<int>(random() % 300), static_cast<int>(random() % 300), 300,
                         300};
    const int limit = 4 * TypeParam::size().area() / TypeParam::ppc;
    for (int k = static_cast<int>(random() % static_cast<unsigned>(limit)); k > 0; --k) {
      simulation.cycle();
    }
    simulation.reset();
    simulation.write(registers::kControl, 0x80);
    this->configure(p);
    this->send(this->randomImage(4));
    this->runUntilPackets(1);
    if (this->HasFatalFailure()) return;
    this->expectExact(0, this->randomImage(4), p);
    EXPECT_EQ(this->packet(0).frame_id, 0U);
    EXPECT_EQ(this->packet(0).faults, 0U);
    if (this->HasFailure()) return;
  }
}

TYPED_TEST(Rtl, FrameIdsWrap) {
  this->configure({60, 90, 8, 8, -10, 10, 0, {}});
  this->simulation.write(registers::kFrameId, 65535);
  this->send(this->randomImage(1));
  this->send(this->randomImage(4));
  this->runUntilPackets(2);
  if (this->HasFatalFailure()) return;
  EXPECT_EQ(this->packet(0).frame_id, 65535U);
  EXPECT_EQ(this->packet(1).frame_id, 0U);
}

TYPED_TEST(Rtl, KeepsToItsClocks) {
  COLONNADE_REQUIRE_RECORDING(folder, "corridor_xtion");
  cv::Mat image = cv::imread((folder / "rgb/0000000005.400000.jpg").string(), cv::IMREAD_GRAYSCALE);
  ASSERT_FALSE(image.empty());
  cv::resize(image, image, TypeParam::size(), 0, 0, cv::INTER_AREA);
  const int passes = this->stage.shape().hysteresis_passes;
  const int words = TypeParam::size().width / TypeParam::ppc;
  const int bins = 2 * rhoReach(TypeParam::size().width, TypeParam::size().height) + 1;
  const int bound = 4 * words + bins + 60 + passes * words;
  // Low votes, for as many lines as may be, then what `run` uses.
  for (const FixedParameters& p :
       {FixedParameters{18, 48, 12, 12, -10, 10, 0, {}},
        runParameters(this->stage.shape(), {}, {}, image.cols, image.rows)}) {
    const std::size_t frame = this->simulation.packet_ends.size();
    this->configure(p);
    this->send(image);
    this->runUntilPackets(frame + 1);
    if (this->HasFatalFailure()) return;
    this->expectExact(frame, image, p);
    const auto lines = this->packet(frame).lines;
    const auto cycles = static_cast<int>(this->simulation.read(registers::kCycles));
    const auto tail = static_cast<int>(this->simulation.read(registers::kTailCycles));
    const int waits = this->waitsOf(lines);
    const int backlog = this->backlogOf(frame);
    std::printf(
        "%dx%d, %d px/clk, %d passes, %zu angles: %d clocks, %d after the last pixel, %zu lines, "
        "%d "
        "wait for others; 4W/PPC + kW/PPC + bins + 60 is %d, votes queue for %d\n",
        TypeParam::size().width, TypeParam::size().height, TypeParam::ppc, passes,
        this->stage.shape().angles_deg.size(), cycles, tail, lines.size(), waits, bound, backlog);
    EXPECT_LE(tail, bound + backlog + waits);
    if (TypeParam::parallel && this->stage.shape().angles_deg.size() == 12) {
      EXPECT_LE(tail, bound);
    }
    if (TypeParam::size().width == 320) {
      EXPECT_EQ(backlog, 0);
    }
    if (TypeParam::size().width == 120) {
      EXPECT_GT(lines.size(), 3U);
      EXPECT_LE(cycles, TypeParam::ppc == 1 ? 15400 : 4400);
      EXPECT_LE(tail, 1000);
    }
  }
}

}  // namespace
}  // namespace colonnade
