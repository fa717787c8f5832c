// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <verilated.h>

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <random>
#include <type_traits>
#include <vector>

namespace colonnade::hdl {

/// A word of the video stream.
struct VideoWord {
  std::uint32_t data = 0;
  bool start_of_frame = false;
  bool end_of_line = false;
};

/// The Verilated accelerator with a master on its video input, slaves on its outputs and an
/// AXI4-Lite master, all of which may stall at random. Protocol: values offered stay until they are
/// taken.
template <class Model>
class Simulation {
 public:
  explicit Simulation(std::uint32_t seed = 1) : model_(&context_, "accelerator"), random_(seed) {
    reset();
  }
  ~Simulation() { model_.final(); }

  /// Chances in 1024 that a master or slave does nothing in a clock; for `registers` on each of the
  /// five AXI4-Lite channels, so that an address and its data come apart.
  struct Stalls {
    int video = 0;
    int edges = 0;
    int lines = 0;
    int registers = 0;
  } stalls;

  std::deque<VideoWord> video;              ///< still to be sent
  std::vector<VideoWord> edges;             ///< received
  std::vector<std::uint32_t> lines;         ///< received, packets one after the other
  std::vector<std::size_t> packet_ends;     ///< positions in `lines` behind each packet
  std::vector<std::uint64_t> frame_starts;  ///< clocks in which a start of frame was taken
  std::uint64_t clock = 0;
  std::uint64_t write_answers = 0;  ///< AXI4-Lite responses taken
  std::uint64_t read_answers = 0;

  /// Pulls the reset, at any moment, and forgets all that is queued and received.
  void reset() {
    video.clear();
    model_.rst = 1;
    model_.s_axis_tvalid = model_.s_axil_awvalid = model_.s_axil_wvalid = model_.s_axil_arvalid = 0;
    for (int i = 0; i < 8; ++i) cycle();
    model_.rst = 0;
    edges.clear();
    lines.clear();
    packet_ends.clear();
    frame_starts.clear();
  }

  void cycle() {
    offerVideo();
    assign(model_.m_axis_edges_tready, !chance(stalls.edges));
    assign(model_.m_axis_lines_tready, !chance(stalls.lines));
    model_.clk = 0;
    model_.eval();
    takeVideo();
    receive();
    const bool address_taken = model_.s_axil_awvalid && model_.s_axil_awready;
    const bool data_taken = model_.s_axil_wvalid && model_.s_axil_wready;
    const bool read_taken = model_.s_axil_arvalid && model_.s_axil_arready;
    if (model_.s_axil_bvalid && model_.s_axil_bready) ++write_answers;
    if (model_.s_axil_rvalid && model_.s_axil_rready) {
      ++read_answers;
      read_data_ = model_.s_axil_rdata;
    }
    model_.clk = 1;
    model_.eval();
    if (taken_) model_.s_axis_tvalid = 0;
    if (address_taken) model_.s_axil_awvalid = 0;
    if (data_taken) model_.s_axil_wvalid = 0;
    if (read_taken) model_.s_axil_arvalid = 0;
    ++clock;
  }

  struct Write {
    std::uint32_t offset = 0;
    std::uint32_t value = 0;
    int strobes = 15;  ///< one bit for each byte to be written
  };
  /// A write, a read, or both at the same time; returns what was read.
  std::uint32_t access(std::optional<Write> write, std::optional<std::uint32_t> read) {
    const std::uint64_t write_end = write_answers + write.has_value();
    const std::uint64_t read_end = read_answers + read.has_value();
    bool address = write.has_value();  // still to be offered
    bool data = write.has_value();
    while (write_answers < write_end || read_answers < read_end) {
      if (address && !chance(stalls.registers)) {
        assign(model_.s_axil_awaddr, write->offset);
        model_.s_axil_awvalid = 1;
        address = false;
      }
      if (data && !chance(stalls.registers)) {
        model_.s_axil_wdata = write->value;
        assign(model_.s_axil_wstrb, write->strobes);
        model_.s_axil_wvalid = 1;
        data = false;
      }
      if (read && !chance(stalls.registers)) {
        assign(model_.s_axil_araddr, *read);
        model_.s_axil_arvalid = 1;
        read.reset();
      }
      model_.s_axil_bready = !chance(stalls.registers);
      model_.s_axil_rready = !chance(stalls.registers);
      cycle();
    }
    return read_data_;
  }
  void write(std::uint32_t offset, std::uint32_t value, int strobes = 15) {
    access(Write{offset, value, strobes}, std::nullopt);
  }
  std::uint32_t read(std::uint32_t offset) { return access(std::nullopt, offset); }

  bool interrupt() const { return model_.irq != 0; }

 private:
  template <class Port, class Value>
  static void assign(Port& port, Value value) {
    port = static_cast<std::remove_reference_t<Port>>(value);
  }
  bool chance(int of_1024) { return of_1024 > 0 && static_cast<int>(random_() % 1024) < of_1024; }

  void offerVideo() {
    if (model_.s_axis_tvalid || video.empty() || chance(stalls.video)) return;
    const VideoWord& word = video.front();
    model_.s_axis_tvalid = 1;
    assign(model_.s_axis_tdata, word.data);
    model_.s_axis_tuser = word.start_of_frame;
    model_.s_axis_tlast = word.end_of_line;
  }
  void takeVideo() {
    taken_ = model_.s_axis_tvalid && model_.s_axis_tready && !model_.rst;
    if (!taken_) return;
    if (model_.s_axis_tuser) frame_starts.push_back(clock);
    video.pop_front();
  }
  void receive() {
    if (model_.m_axis_edges_tvalid && model_.m_axis_edges_tready) {
      edges.push_back({model_.m_axis_edges_tdata, model_.m_axis_edges_tuser != 0,
                       model_.m_axis_edges_tlast != 0});
    }
    if (model_.m_axis_lines_tvalid && model_.m_axis_lines_tready) {
      lines.push_back(model_.m_axis_lines_tdata);
      if (model_.m_axis_lines_tlast) packet_ends.push_back(lines.size());
    }
  }

  VerilatedContext context_;
  Model model_;
  std::mt19937 random_;
  bool taken_ = false;
  std::uint32_t read_data_ = 0;
};

}  // namespace colonnade::hdl
