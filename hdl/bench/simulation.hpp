// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <verilated.h>

#include <cstdint>
#include <deque>
#include <memory>
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
/// AXI4-Lite master, the streams of which may stall at random. Protocol: values offered stay until they are
/// taken.
template <class Model>
class Simulation {
 public:
  explicit Simulation(std::uint32_t seed = 1) : model_(&context_, "accelerator"), random_(seed) {
    reset();
  }
  ~Simulation() { model_.final(); }

  /// Chances in 1024 that a master or slave does nothing in a clock.
  struct Stalls {
    int video = 0;
    int edges = 0;
    int lines = 0;
  } stalls;

  std::deque<VideoWord> video;              ///< still to be sent
  std::vector<VideoWord> edges;             ///< received
  std::vector<std::uint32_t> lines;         ///< received, packets one after the other
  std::vector<std::size_t> packet_ends;     ///< positions in `lines` behind each packet
  std::vector<std::uint64_t> frame_starts;  ///< clocks in which a start of frame was taken
  std::uint64_t clock = 0;

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
    const bool write_taken = model_.s_axil_awvalid && model_.s_axil_awready;
    const bool read_taken = model_.s_axil_arvalid && model_.s_axil_arready;
    write_done_ = model_.s_axil_bvalid && model_.s_axil_bready;
    read_done_ = model_.s_axil_rvalid && model_.s_axil_rready;
    read_data_ = model_.s_axil_rdata;
    model_.clk = 1;
    model_.eval();
    if (taken_) model_.s_axis_tvalid = 0;
    if (write_taken) model_.s_axil_awvalid = model_.s_axil_wvalid = 0;
    if (read_taken) model_.s_axil_arvalid = 0;
    ++clock;
  }

  /// strobes: one bit for each byte to be written.
  void write(std::uint32_t offset, std::uint32_t value, int strobes = 15) {
    assign(model_.s_axil_awaddr, offset);
    model_.s_axil_wdata = value;
    assign(model_.s_axil_wstrb, strobes);
    model_.s_axil_awvalid = model_.s_axil_wvalid = model_.s_axil_bready = 1;
    do cycle();
    while (!write_done_);
  }

  bool interrupt() const { return model_.irq != 0; }

  std::uint32_t read(std::uint32_t offset) {
    assign(model_.s_axil_araddr, offset);
    model_.s_axil_arvalid = model_.s_axil_rready = 1;
    do cycle();
    while (!read_done_);
    return read_data_;
  }

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
  bool write_done_ = false;
  bool read_done_ = false;
  std::uint32_t read_data_ = 0;
};

}  // namespace colonnade::hdl
