// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// valid and position, STAGES clocks later: beside a pipeline of as many registers.
module delay #(
  parameter int STAGES = 1
) (
  input  wire                        clk_i,
  input  wire                        rst_i,
  input  wire                        valid_i,
  input  stream_pkg::position_t position_i,
  output logic                       valid_o,
  output stream_pkg::position_t      position_o
);
  localparam int BITS = stream_pkg::POSITION_WIDTH;
  logic [STAGES-1:0] valid_q;
  logic [STAGES*BITS-1:0] position_q;
  always_ff @(posedge clk_i) begin
    if (rst_i) valid_q <= '0;
    else valid_q <= STAGES'({valid_q, valid_i});
    position_q <= (STAGES*BITS)'({position_q, position_i});
  end
  assign valid_o = valid_q[STAGES-1];
  assign position_o = position_q[(STAGES-1)*BITS +: BITS];
endmodule
`default_nettype wire
