// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colonnade/accelerator/model_transport.hpp"

#include "VRun320.h"
#include "VRun640.h"
#include "VThesis1.h"
#include "VThesis4.h"
#include "colonnade/base/error.hpp"
#include "colonnade/edges/fixed_lines.hpp"
#include "simulation.hpp"

namespace colonnade {
namespace {

template <class Model>
class ModelTransport : public AcceleratorTransport {
 public:
  explicit ModelTransport(const AcceleratorModel& model)
      : size_(model.size),
        pixels_per_clock_(model.pixels_per_clock),
        simulation_(std::make_unique<hdl::Simulation<Model>>()) {}

  std::uint32_t readRegister(std::uint32_t offset) override { return simulation_->read(offset); }
  void writeRegister(std::uint32_t offset, std::uint32_t value) override {
    simulation_->write(offset, value);
  }
  void sendFrame(const cv::Mat& gray) override {
    for (int v = 0; v < gray.rows; ++v) {
      const auto* row = gray.ptr<std::uint8_t>(v);
      for (int u = 0; u < gray.cols; u += pixels_per_clock_) {
        hdl::VideoWord word{0, u == 0 && v == 0, u + pixels_per_clock_ == gray.cols};
        for (int p = 0; p < pixels_per_clock_; ++p)
          word.data |= static_cast<std::uint32_t>(row[u + p]) << (8 * p);
        simulation_->video.push_back(word);
      }
    }
  }
  bool allSent() const override { return simulation_->video.empty(); }
  void advance(int clocks) override {
    for (int i = 0; i < clocks; ++i) simulation_->cycle();
  }
  std::optional<std::vector<std::uint8_t>> takeEdges() override {
    auto& words = simulation_->edges;
    const auto count = static_cast<std::size_t>(size_.area() / pixels_per_clock_);
    if (words.size() < count) return std::nullopt;
    std::vector<std::uint8_t> bytes;
    bytes.reserve(static_cast<std::size_t>(size_.area()));
    for (std::size_t i = 0; i < count; ++i) {
      for (int p = 0; p < pixels_per_clock_; ++p)
        bytes.push_back(static_cast<std::uint8_t>(words[i].data >> (8 * p)));
    }
    words.erase(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(count));
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
  void reset() override { simulation_->reset(); }

 private:
  cv::Size size_;
  int pixels_per_clock_;
  std::unique_ptr<hdl::Simulation<Model>> simulation_;
};

struct Entry {
  AcceleratorModel model;
  std::unique_ptr<AcceleratorTransport> (*make)(const AcceleratorModel&);
};

template <class Model>
std::unique_ptr<AcceleratorTransport> make(const AcceleratorModel& model) {
  return std::make_unique<ModelTransport<Model>>(model);
}

/// As built by CMakeLists.txt.
const std::vector<Entry>& entries() {
  static const FixedShape thesis{{kThesisSet.begin(), kThesisSet.end()}, 0};
  static const std::vector<Entry> all = {
      {{"run", {320, 240}, 1, runShape()}, make<VRun320>},
      {{"run", {640, 480}, 1, runShape()}, make<VRun640>},
      {{"thesis", {120, 120}, 1, thesis}, make<VThesis1>},
      {{"thesis", {120, 120}, 4, thesis}, make<VThesis4>},
  };
  return all;
}

}  // namespace

const std::vector<AcceleratorModel>& acceleratorModels() {
  static const std::vector<AcceleratorModel> models = [] {
    std::vector<AcceleratorModel> result;
    for (const Entry& entry : entries()) result.push_back(entry.model);
    return result;
  }();
  return models;
}

std::unique_ptr<AcceleratorTransport> makeModelTransport(const AcceleratorModel& model) {
  for (const Entry& entry : entries()) {
    if (entry.model.name == model.name && entry.model.size == model.size &&
        entry.model.pixels_per_clock == model.pixels_per_clock)
      return entry.make(entry.model);
  }
  throw Error("accelerator: this program holds no model \"" + model.name + "\" of that size");
}

std::vector<cv::Size> modelSizes() {
  std::vector<cv::Size> sizes;
  for (const AcceleratorModel& model : acceleratorModels())
    if (model.name == "run") sizes.push_back(model.size);
  return sizes;
}

std::unique_ptr<AcceleratorTransport> makeModelTransport(const cv::Size& size) {
  for (const AcceleratorModel& model : acceleratorModels())
    if (model.name == "run" && model.size == size) return makeModelTransport(model);
  return nullptr;
}

}  // namespace colonnade
