// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// Canny and Hough without buses and queues, for measuring: positions come in beside the pixels. The
/// few pins of a small part do for all parameters: they are shifted in.
module image_stage #(
  parameter int WIDTH = 120,
  parameter int HEIGHT = 120,
  parameter int PASSES = 0,
  parameter int ANGLES = accelerator_pkg::THESIS_ANGLES,
  parameter logic [1439:0] ANGLE_SET = accelerator_pkg::THESIS_SET,
  parameter int REACH = 86
) (
  input  wire         clk_i,
  input  wire         rst_i,
  input  wire         shift_i,
  input  wire         parameter_i,
  input  wire         valid_i,
  input  wire  [5:0]  position_i,
  input  wire  [7:0]  pixel_i,
  output logic [3:0]  edges_o,
  output logic        cleared_o,
  input  wire         packet_idle_i,
  output logic        line_valid_o,
  input  wire         line_ready_i,
  output logic [31:0] line_o
);
  localparam int BITS = 2 * 270;  // of stream_pkg::parameters_t, for either bank
  logic [BITS-1:0] shift_q;
  stream_pkg::parameters_t parameters0, parameters1;
  assign {parameters1, parameters0} = shift_q;
  always_ff @(posedge clk_i) if (shift_i) shift_q <= {shift_q[BITS-2:0], parameter_i};

  /* verilator lint_off UNUSEDSIGNAL */  // what buses would need
  logic room, scan_bank, begins, ends;
  /* verilator lint_on UNUSEDSIGNAL */
  logic valid_q, edge_valid;
  stream_pkg::position_t position_q, edge_position;
  logic [7:0] pixel_q;
  always_ff @(posedge clk_i) {valid_q, position_q, pixel_q} <= {valid_i, position_i, pixel_i};
  canny #(.PPC(1), .WORDS(WIDTH), .PASSES(PASSES)) u_canny (
    .clk_i(clk_i), .rst_i(rst_i), .low_i({parameters1.low, parameters0.low}),
    .high_i({parameters1.high, parameters0.high}),
    .valid_i(valid_q), .position_i(position_q), .pixels_i(pixel_q), .valid_o(edge_valid),
    .position_o(edge_position), .edges_o(edges_o)
  );
  hough_parallel #(
    .WIDTH(WIDTH), .HEIGHT(HEIGHT), .PPC(1), .ANGLES(ANGLES), .ANGLE_SET(ANGLE_SET), .REACH(REACH)
  ) u_hough (
    .clk_i(clk_i), .rst_i(rst_i), .parameters0_i(parameters0), .parameters1_i(parameters1),
    .valid_i(edge_valid), .position_i(edge_position), .edges_i(edges_o), .cleared_o(cleared_o),
    .room_o(room), .packet_idle_i(packet_idle_i), .scan_bank_o(scan_bank), .begin_o(begins),
    .end_o(ends), .line_valid_o(line_valid_o), .line_ready_i(line_ready_i), .line_o(line_o)
  );
endmodule
`default_nettype wire
