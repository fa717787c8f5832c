// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/accelerator/accelerator.hpp"

#include <algorithm>
#include <opencv2/core.hpp>
#include <tuple>

#include "colonnade/base/error.hpp"
#include "colonnade/edges/accelerator_registers.hpp"

namespace colonnade {
namespace {

constexpr int kStep = 1024;  // clocks between two looks
constexpr std::size_t kFrameWords = 3;  // of a packet, beside the lines: id, count, clocks

std::uint32_t halves(int high, int low) {
  return static_cast<std::uint32_t>(high & 0xffff) << 16 | static_cast<std::uint32_t>(low & 0xffff);
}

std::uint32_t field(std::uint32_t word, int lsb, int width) {
  return word >> lsb & ((1U << width) - 1);
}

int signedField(std::uint32_t word, int lsb, int width) {
  return static_cast<int>(word << (32 - lsb - width)) >> (32 - width);
}

FixedLine toLine(std::uint32_t word) {
  return {
      signedField(word, registers::kLineThetaLsb, registers::kLineThetaWidth),
      signedField(word, registers::kLineRhoLsb, registers::kLineRhoWidth),
      static_cast<int>(field(word, registers::kLineVotesLsb, registers::kLineVotesWidth)),
      static_cast<int>(field(word, registers::kLineClassLsb, registers::kLineClassWidth))};
}

std::string faultNames(std::uint32_t faults) {
  static constexpr std::pair<std::uint32_t, const char*> kNames[] = {
      {registers::kStatusLineShort, "a line too short"},
      {registers::kStatusLineLong, "a line too long"},
      {registers::kStatusFrameShort, "a frame too short"},
      {registers::kStatusNoStart, "data before a start of frame"}};
  std::string names;
  for (const auto& [bit, name] : kNames) {
    if ((faults & bit) != 0) names += (names.empty() ? "" : ", ") + std::string(name);
  }
  return names;
}

}  // namespace

std::string sizeName(const cv::Size& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

std::string differenceFrom(const FixedResult& expected, const AcceleratorResult& result) {
  switch (result.fault) {
    case AcceleratorFault::kHang:
      return "device hangs";
    case AcceleratorFault::kBadFrame:
      return "device got a broken frame";
    case AcceleratorFault::kLateWrite:
      return "device had a register written in mid-frame";
    case AcceleratorFault::kBadPacket:
      return "device sent a broken packet";
    case AcceleratorFault::kNone:
      break;
  }
  if (cv::norm(result.found.edges, expected.edges, cv::NORM_L1) != 0.0) return "edges differ";
  if (result.found.lines != expected.lines) return "lines differ";
  return {};
}

Accelerator::Accelerator(std::unique_ptr<AcceleratorTransport> transport, FixedShape shape)
    : transport_(std::move(transport)), shape_(std::move(shape)) {
  transport_->reset();  // of a process that ended in mid-frame something may be left
  const std::uint32_t identity = transport_->readRegister(registers::kId);
  const std::uint32_t version = transport_->readRegister(registers::kVersion);
  if (identity != registers::kIdentity || version >> 16 != registers::kInterface >> 16) {
    throw Error("accelerator: the device does not answer as one (id " + std::to_string(identity) +
                ", version " + std::to_string(version) + "); load the bitstream of this release");
  }
  const std::uint32_t built = transport_->readRegister(registers::kShape);
  const auto angles = static_cast<std::size_t>(field(built, registers::kShapeAnglesLsb, registers::kShapeAnglesWidth));
  const auto passes = static_cast<int>(field(built, registers::kShapePassesLsb, registers::kShapePassesWidth));
  if (angles != shape_.angles_deg.size() || passes != shape_.hysteresis_passes) {
    throw Error("accelerator: the device is built for " + std::to_string(angles) + " angles and " +
                std::to_string(passes) + " passes, not " +
                std::to_string(shape_.angles_deg.size()) + " and " +
                std::to_string(shape_.hysteresis_passes));
  }
  const std::uint32_t size = transport_->readRegister(registers::kSize);
  size_ = {static_cast<int>(size & 0xffff), static_cast<int>(size >> 16)};
  // Four frames' pixels and, where angles share memories, some turns for many of them.
  const int bins = 2 * rhoReach(size_.width, size_.height) + 1;
  patience_ = 4 * (size_.area() + static_cast<int>(angles) * bins) + 100 * kStep;
  start();
}

Accelerator::~Accelerator() = default;

void Accelerator::start() {
  transport_->writeRegister(registers::kFrameId, next_id_);
  transport_->writeRegister(registers::kControl, registers::kControlAutoRestart);
  configured_ = false;
  sent_ = 0;
}

void Accelerator::reset() {
  transport_->reset();
  edges_.reset();
  packet_.reset();
  lost_ += on_the_way_;
  on_the_way_ = 0;
  start();
}

bool Accelerator::letDeviceTakeAll() {
  for (int waited = 0; !transport_->allSent(); waited += kStep) {
    if (waited > patience_) return false;
    transport_->advance(kStep);
  }
  return true;
}

void Accelerator::configure(const FixedParameters& parameters) {
  parameters_ = parameters;
  configured_ = false;
}

std::uint16_t Accelerator::submit(const cv::Mat& gray) {
  if (gray.type() != CV_8UC1 || gray.size() != size_) {
    throw Error("accelerator: the device takes 8-bit gray images of " +
                sizeName(size_) + ", not " + sizeName(gray.size()));
  }
  if (!canSubmit()) throw Error("accelerator: two frames are on their way; take a result first");
  // A register written while a frame comes in would count for the next one; wait for its end.
  if (!configured_ && letDeviceTakeAll()) {
    const FixedParameters& p = parameters_;
    transport_->writeRegister(registers::kThresholds, halves(p.high, p.low));
    transport_->writeRegister(registers::kVotes, halves(p.inclined_votes, p.vertical_votes));
    transport_->writeRegister(
        registers::kVerticals,
        static_cast<std::uint32_t>((p.vertical_to_deg & 255) << 8 | (p.vertical_from_deg & 255)));
    transport_->writeRegister(registers::kFirstRow, halves(0, p.first_row));
    for (std::size_t word = 0; 32 * word < shape_.angles_deg.size(); ++word) {
      std::uint32_t bits = 0;
      for (std::size_t b = 0; b < 32; ++b) {
        const std::size_t a = 32 * word + b;
        if (p.enabled.empty() || (a < p.enabled.size() && p.enabled[a])) bits |= 1U << b;
      }
      transport_->writeRegister(registers::kEnable0 + 4 * static_cast<std::uint32_t>(word), bits);
    }
    configured_ = true;
  }
  transport_->sendFrame(gray);
  if (on_the_way_++ == 0) waited_ = 0;
  ++sent_;
  return next_id_++;
}

std::uint32_t Accelerator::takeStatus() {
  const std::uint32_t status = transport_->readRegister(registers::kStatus);
  if (status != 0) transport_->writeRegister(registers::kStatus, status);
  return status;
}

std::optional<AcceleratorResult> Accelerator::take() {
  if (!edges_) edges_ = transport_->takeEdges();
  if (!packet_) packet_ = transport_->takePacket();
  if (!edges_ || !packet_) return std::nullopt;
  AcceleratorResult result = interpret(*edges_, *packet_);
  const std::uint32_t status = takeStatus();
  const auto fault = [&](AcceleratorFault what, const std::string& detail) {
    if (result.fault != AcceleratorFault::kNone) return;
    result.fault = what;
    result.detail = detail;
  };
  // The device counts frames itself: if it has taken fewer than were sent, this is not the oldest's.
  const auto taken =
      static_cast<std::uint16_t>(transport_->readRegister(registers::kFrames) >> 16);
  if (transport_->allSent() && taken != sent_) {
    fault(AcceleratorFault::kBadPacket, "the device has taken " + std::to_string(taken) +
                                            " frames of " + std::to_string(sent_));
  }
  if ((status & registers::kStatusNoStart) != 0) {
    fault(AcceleratorFault::kBadFrame, faultNames(registers::kStatusNoStart));
  }
  // submit() never does that; another master on the bus may.
  if ((status & registers::kStatusLateWrite) != 0) {
    fault(AcceleratorFault::kLateWrite, "a parameter was written in mid-frame");
  }
  return result;
}

std::optional<AcceleratorResult> Accelerator::poll() {
  if (lost_ > 0) {
    --lost_;
    return hang("lost with the frame before it");
  }
  if (on_the_way_ == 0) return std::nullopt;
  if (auto result = take()) {
    edges_.reset();
    packet_.reset();
    --on_the_way_;
    ++oldest_id_;
    waited_ = 0;
    if (result->fault != AcceleratorFault::kNone) reset();
    return result;
  }
  if (waited_ <= patience_) {
    transport_->advance(kStep);
    waited_ += kStep;
    return std::nullopt;
  }
  std::string what = edges_ ? "no line packet" : packet_ ? "no whole edge map" : "nothing";
  what += " came out in " + std::to_string(patience_) + " clocks";
  const std::string faults = faultNames(takeStatus());
  if (!faults.empty()) what += "; " + faults + " came in";
  --on_the_way_;
  waited_ = 0;
  reset();
  return hang(what);
}

AcceleratorResult Accelerator::wait() {
  if (on_the_way_ == 0 && lost_ == 0) throw Error("accelerator: no frame is on its way");
  for (;;) {
    if (auto result = poll()) return std::move(*result);
  }
}

AcceleratorResult Accelerator::hang(const std::string& where) {
  AcceleratorResult result;
  result.frame_id = oldest_id_++;
  result.fault = AcceleratorFault::kHang;
  result.detail = where;
  return result;
}

AcceleratorResult Accelerator::interpret(const std::vector<std::uint8_t>& edges,
                                         const std::vector<std::uint32_t>& packet) {
  AcceleratorResult result;
  result.frame_id = oldest_id_;
  const auto bad = [&](const std::string& detail) {
    result.fault = AcceleratorFault::kBadPacket;
    result.detail = detail;
    return result;
  };
  if (packet.size() < kFrameWords) return bad("a line packet without its frame");
  if (packet.front() != oldest_id_) {
    return bad("the packet of frame " + std::to_string(packet.front()) + " instead of " +
               std::to_string(oldest_id_));
  }
  const std::uint32_t counted = packet[packet.size() - 2];
  if ((counted & 0xffff) != packet.size() - kFrameWords) return bad("a wrong number of lines");
  if (edges.size() != static_cast<std::size_t>(size_.area())) {
    return bad("an edge map of " + std::to_string(edges.size()) + " bytes");
  }
  result.clocks = packet.back();
  if (counted >> 16 != 0) {
    result.fault = AcceleratorFault::kBadFrame;
    result.detail = faultNames(counted >> 16);
    return result;
  }
  for (std::size_t i = 1; i + 2 < packet.size(); ++i) {
    result.found.lines.push_back(toLine(packet[i]));
  }
  std::sort(result.found.lines.begin(), result.found.lines.end(), [](const auto& a, const auto& b) {
    return std::tie(a.theta_deg, a.rho) < std::tie(b.theta_deg, b.rho);
  });
  result.found.edges.create(size_, CV_8UC1);
  std::transform(edges.begin(), edges.end(), result.found.edges.data, [](std::uint8_t byte) {
    return static_cast<std::uint8_t>(byte & 8 ? 1 + (byte & 7) : 0);
  });
  return result;
}

}  // namespace colonnade
