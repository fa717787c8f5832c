// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// Pixels in, {edge, sector} for each pixel out: Gaussian, operators, suppression, PASSES of
/// hysteresis (thesis figures 46 and 47). Words come out 4 + PASSES lines after they went in.
module canny #(
  parameter int PPC = 1,
  parameter int WORDS = 120,
  parameter int PASSES = 2
) (
  input  wire                        clk_i,
  input  wire                        rst_i,
  input  wire  [19:0]                low_i,   // of bank 1, of bank 0
  input  wire  [19:0]                high_i,
  input  wire                        valid_i,
  input  stream_pkg::position_t position_i,
  input  wire  [PPC*8-1:0]           pixels_i,
  output logic                       valid_o,
  output stream_pkg::position_t      position_o,
  output logic [PPC*4-1:0]           edges_o
);
  logic blurred_valid, gradient_valid;
  stream_pkg::position_t blurred_position, gradient_position;
  logic [PPC*8-1:0] blurred;
  logic [PPC*13-1:0] gradients;
  gaussian #(.PPC(PPC), .WORDS(WORDS)) u_gaussian (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid_i), .position_i(position_i), .pixels_i(pixels_i),
    .valid_o(blurred_valid), .position_o(blurred_position), .pixels_o(blurred)
  );
  gradient #(.PPC(PPC), .WORDS(WORDS)) u_gradient (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(blurred_valid), .position_i(blurred_position),
    .pixels_i(blurred), .valid_o(gradient_valid), .position_o(gradient_position),
    .gradients_o(gradients)
  );

  // Slice k: after k passes.
  localparam int BITS = stream_pkg::POSITION_WIDTH;
  logic [PASSES:0] valid;
  logic [(PASSES+1)*BITS-1:0] position;
  logic [(PASSES+1)*PPC*5-1:0] labels;
  suppression #(.PPC(PPC), .WORDS(WORDS)) u_suppression (
    .clk_i(clk_i), .rst_i(rst_i), .low_i(low_i), .high_i(high_i), .valid_i(gradient_valid),
    .position_i(gradient_position), .gradients_i(gradients), .valid_o(valid[0]),
    .position_o(position[BITS-1:0]), .labels_o(labels[PPC*5-1:0])
  );
  for (genvar k = 0; k < PASSES; k++) begin : g_pass
    hysteresis #(.PPC(PPC), .WORDS(WORDS)) u_hysteresis (
      .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid[k]), .position_i(position[k*BITS +: BITS]),
      .labels_i(labels[k*PPC*5 +: PPC*5]), .valid_o(valid[k+1]),
      .position_o(position[(k+1)*BITS +: BITS]), .labels_o(labels[(k+1)*PPC*5 +: PPC*5])
    );
  end

  assign valid_o = valid[PASSES];
  assign position_o = position[PASSES*BITS +: BITS];
  always_comb begin
    for (int p = 0; p < PPC; p++)
      edges_o[p*4 +: 4] = labels[PASSES*PPC*5 + p*5 + 4]
                              ? {1'b1, labels[PASSES*PPC*5 + p*5 +: 3]} : 4'b0000;
  end
endmodule
`default_nettype wire
