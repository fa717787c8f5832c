// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// Which angles of a set are vertical, for the parameters of either bank: found for one and the other in
/// turn, every 32 clocks. A frame's edges arrive four lines, 64 words at least, after its parameters.
module angle_classes #(
  parameter int ANGLES = 12,
  parameter logic [1439:0] ANGLE_SET = accelerator_pkg::THESIS_SET
) (
  input  wire                clk_i,
  input  wire                rst_i,
  input  wire  [15:0]        verticals0_i,   // {to, from}, signed degrees
  input  wire  [15:0]        verticals1_i,
  output logic [ANGLES-1:0]  vertical0_o,
  output logic [ANGLES-1:0]  vertical1_o
);
  logic [4:0] turn_q;
  logic [7:0] from, to;
  assign {to, from} = turn_q[4] ? verticals1_i : verticals0_i;
  always_ff @(posedge clk_i) turn_q <= rst_i ? '0 : turn_q + 1'b1;
  for (genvar a = 0; a < ANGLES; a++) begin : g_angle
    localparam logic signed [7:0] THETA = $signed(ANGLE_SET[a*8 +: 8] - 8'd90);
    always_ff @(posedge clk_i) begin
      if (turn_q == 5'd15) vertical0_o[a] <= THETA >= $signed(from) && THETA <= $signed(to);
      if (turn_q == 5'd31) vertical1_o[a] <= THETA >= $signed(from) && THETA <= $signed(to);
    end
  end
endmodule
`default_nettype wire
