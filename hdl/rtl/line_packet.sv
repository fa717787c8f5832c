// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// One packet for each frame: frame id, lines, faults << 16 | number of lines, clocks.
module line_packet (
  input  wire         clk_i,
  input  wire         rst_i,
  input  wire         begin_i,
  input  wire         end_i,         // no more lines
  input  wire         line_valid_i,
  output logic        line_ready_o,
  input  wire  [31:0] line_i,
  input  wire  [15:0] frame_id_i,
  input  wire  [3:0]  faults_i,
  input  wire  [31:0] clocks_i,      // since the first pixel of the frame
  output logic        idle_o,
  output logic        done_o,        // the last word has been taken
  output logic        m_axis_tvalid,
  input  wire         m_axis_tready,
  output logic [31:0] m_axis_tdata,
  output logic        m_axis_tlast
);
  typedef enum logic [2:0] {Idle, Head, Lines, Count, Clocks} state_e;
  state_e state_q;
  logic [15:0] count_q;
  logic ended_q;  // the scan may end before the sink has taken the first word
  logic [31:0] clocks_q;
  assign idle_o = state_q == Idle;
  assign done_o = state_q == Clocks && m_axis_tready;
  assign line_ready_o = state_q == Lines && m_axis_tready;
  assign m_axis_tlast = state_q == Clocks;
  always_comb begin
    m_axis_tvalid = 1'b1;
    unique case (state_q)
      Head: m_axis_tdata = {16'd0, frame_id_i};
      Lines: begin
        m_axis_tvalid = line_valid_i;
        m_axis_tdata = line_i;
      end
      Count: m_axis_tdata = {12'd0, faults_i, count_q};
      Clocks: m_axis_tdata = clocks_q;
      default: begin
        m_axis_tvalid = 1'b0;
        m_axis_tdata = '0;
      end
    endcase
  end
  always_ff @(posedge clk_i) begin
    if (state_q != Clocks) clocks_q <= clocks_i;
    if (rst_i) begin
      state_q <= Idle;
      count_q <= '0;
      ended_q <= 1'b0;
    end else begin
      ended_q <= state_q != Idle && (ended_q || end_i);
      unique case (state_q)
        Idle: begin
          count_q <= '0;
          if (begin_i) state_q <= Head;
        end
        Head: if (m_axis_tready) state_q <= Lines;
        Lines: begin
          if (line_valid_i && m_axis_tready) count_q <= count_q + 1'b1;
          if (end_i || ended_q) state_q <= Count;
        end
        Count: if (m_axis_tready) state_q <= Clocks;
        default: if (m_axis_tready) state_q <= Idle;
      endcase
    end
  end
endmodule
`default_nettype wire
