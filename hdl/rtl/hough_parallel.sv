// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// Hough transform with vote memories for every angle of a small set: takes a word of PPC pixels in
/// every clock, whatever the number of edges, and never waits (thesis figures 60 to 66, without
/// multipliers).
module hough_parallel #(
  parameter int WIDTH = 120,
  parameter int HEIGHT = 120,
  parameter int PPC = 1,
  parameter int ANGLES = 12,
  parameter logic [1439:0] ANGLE_SET = accelerator_pkg::THESIS_SET,
  parameter int REACH = 86
) (
  input  wire                          clk_i,
  input  wire                          rst_i,
  /* verilator lint_off UNUSEDSIGNAL */  // the other fields are for other stages
  input  stream_pkg::parameters_t parameters0_i,
  input  stream_pkg::parameters_t parameters1_i,
  /* verilator lint_on UNUSEDSIGNAL */
  input  wire                          valid_i,
  input  stream_pkg::position_t   position_i,
  input  wire  [PPC*4-1:0]             edges_i,
  output logic                         cleared_o,
  output logic                         room_o,
  input  wire                          packet_idle_i,   // the former packet has ended
  output logic                         scan_bank_o,
  output logic                         begin_o,
  output logic                         end_o,
  output logic                         line_valid_o,
  input  wire                          line_ready_i,
  output logic [31:0]                  line_o
);
  localparam int VOTE_WIDTH = $clog2(2 * (WIDTH > HEIGHT ? WIDTH : HEIGHT) + 1);
  localparam int BIN_WIDTH = $clog2(2 * REACH + 1);
  assign room_o = 1'b1;

  // One register on the way in, beside which the frame's parameters are chosen.
  logic valid_q, row_counts_q;
  stream_pkg::position_t position_q;
  logic [PPC*4-1:0] edges_q;
  localparam int ROW_WIDTH = $clog2(HEIGHT + 1);
  logic [ROW_WIDTH-1:0] row_q, row;
  assign row = position_i.first_row ? '0 : row_q;
  logic [15:0] first_row;
  assign first_row = position_i.bank ? parameters1_i.first_row : parameters0_i.first_row;
  always_ff @(posedge clk_i) begin
    valid_q <= valid_i & position_i.active & ~rst_i;
    position_q <= position_i;
    edges_q <= edges_i;
    row_counts_q <= (first_row >> ROW_WIDTH) == '0 && row >= first_row[ROW_WIDTH-1:0];
    if (valid_i && position_i.active) row_q <= position_i.last_word ? row + 1'b1 : row;
  end

  logic [ANGLES-1:0] vertical0, vertical1, scan_vertical_q;
  angle_classes #(.ANGLES(ANGLES), .ANGLE_SET(ANGLE_SET)) u_classes (
    .clk_i(clk_i), .rst_i(rst_i), .verticals0_i({parameters0_i.vertical_to, parameters0_i.vertical_from}),
    .verticals1_i({parameters1_i.vertical_to, parameters1_i.vertical_from}),
    .vertical0_o(vertical0), .vertical1_o(vertical1)
  );
  always_ff @(posedge clk_i) scan_vertical_q <= scan_bank_o ? vertical1 : vertical0;

  logic scan, scanned;
  logic [BIN_WIDTH-1:0] scan_bin;
  logic [ANGLES*VOTE_WIDTH-1:0] votes;
  for (genvar a = 0; a < ANGLES; a++) begin : g_angle
    logic vertical_q, enable_q;
    always_ff @(posedge clk_i) begin
      vertical_q <= position_i.bank ? vertical1[a] : vertical0[a];
      enable_q <= position_i.bank ? parameters1_i.enable[a] : parameters0_i.enable[a];
    end
    angle_votes #(
      .ANGLE(32'(ANGLE_SET[a*8 +: 8])), .WIDTH(WIDTH), .HEIGHT(HEIGHT), .PPC(PPC), .REACH(REACH),
      .VOTE_WIDTH(VOTE_WIDTH)
    ) u_votes (
      .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid_q), .position_i(position_q), .edges_i(edges_q),
      .allow_i(enable_q & (vertical_q | row_counts_q)), .scan_i(scan), .scan_bank_i(scan_bank_o),
      .scan_bin_i(scan_bin), .scanned_i(scanned), .votes_o(votes[a*VOTE_WIDTH +: VOTE_WIDTH])
    );
  end
  // The last votes are written two clocks after valid_q, as peak_scan takes up the request; it reads in
  // the next clock.
  logic complete_q, complete_bank_q;
  always_ff @(posedge clk_i) begin
    complete_q <= valid_q & position_q.last_row & position_q.last_word & ~rst_i;
    complete_bank_q <= position_q.bank;
  end

  peak_scan #(
    .ANGLES(ANGLES), .ANGLE_SET(ANGLE_SET), .REACH(REACH), .VOTE_WIDTH(VOTE_WIDTH)
  ) u_scan (
    .clk_i(clk_i), .rst_i(rst_i), .cleared_o(cleared_o), .request_i(complete_q),
    .request_bank_i(complete_bank_q), .packet_idle_i(packet_idle_i), .vertical_i(scan_vertical_q),
    .vertical_votes_i(scan_bank_o ? parameters1_i.vertical_votes : parameters0_i.vertical_votes),
    .inclined_votes_i(scan_bank_o ? parameters1_i.inclined_votes : parameters0_i.inclined_votes),
    .scan_o(scan), .scan_bank_o(scan_bank_o), .scan_bin_o(scan_bin), .scanned_o(scanned),
    .votes_i(votes), .begin_o(begin_o), .end_o(end_o), .line_valid_o(line_valid_o),
    .line_ready_i(line_ready_i), .line_o(line_o)
  );
endmodule
`default_nettype wire
