// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/accelerator/model_transport.hpp"

#include "VRun320.h"
#include "VRun640.h"
#include "simulation.hpp"

namespace colonnade {
namespace {

const cv::Size kSmall{320, 240};  // as built by CMakeLists.txt
const cv::Size kLarge{640, 480};

template <class Model>
class ModelTransport : public AcceleratorTransport {
 public:
  explicit ModelTransport(const cv::Size& size) : size_(size) { reset(); }

  std::uint32_t readRegister(std::uint32_t offset) override { return simulation_->read(offset); }
  void writeRegister(std::uint32_t offset, std::uint32_t value) override {
    simulation_->write(offset, value);
  }
  void sendFrame(const cv::Mat& gray) override {
    for (int v = 0; v < gray.rows; ++v) {
      const auto* row = gray.ptr<std::uint8_t>(v);
      for (int u = 0; u < gray.cols; ++u) {
        simulation_->video.push_back({row[u], u == 0 && v == 0, u + 1 == gray.cols});
      }
    }
  }
  bool allSent() const override { return simulation_->video.empty(); }
  void advance(int clocks) override {
    for (int i = 0; i < clocks; ++i) simulation_->cycle();
  }
  std::optional<std::vector<std::uint8_t>> takeEdges() override {
    auto& words = simulation_->edges;
    const auto area = static_cast<std::size_t>(size_.area());
    if (words.size() < area) return std::nullopt;
    std::vector<std::uint8_t> bytes;
    bytes.reserve(area);
    for (std::size_t i = 0; i < area; ++i)
      bytes.push_back(static_cast<std::uint8_t>(words[i].data));
    words.erase(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(area));
    return bytes;
  }
  std::optional<std::vector<std::uint32_t>> takePacket() override {
    auto& ends = simulation_->packet_ends;
    if (ends.empty()) return std::nullopt;
    auto& words = simulation_->lines;
    const std::size_t size = ends.front();
    std::vector<std::uint32_t> packet(words.begin(),
                                      words.begin() + static_cast<std::ptrdiff_t>(size));
    words.erase(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(size));
    ends.erase(ends.begin());
    for (std::size_t& end : ends) end -= size;
    return packet;
  }
  void reset() override { simulation_ = std::make_unique<hdl::Simulation<Model>>(); }

 private:
  cv::Size size_;
  std::unique_ptr<hdl::Simulation<Model>> simulation_;
};

}  // namespace

std::vector<cv::Size> modelSizes() { return {kSmall, kLarge}; }

std::unique_ptr<AcceleratorTransport> makeModelTransport(const cv::Size& size) {
  if (size == kSmall) return std::make_unique<ModelTransport<VRun320>>(size);
  if (size == kLarge) return std::make_unique<ModelTransport<VRun640>>(size);
  return nullptr;
}

}  // namespace colonnade
