// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// The four directional 3x3 operators and the direction encoder (thesis figures 49 and 50): for each
/// pixel {sector, magnitude}.
module gradient #(
  parameter int PPC = 1,
  parameter int WORDS = 120
) (
  input  wire                        clk_i,
  input  wire                        rst_i,
  input  wire                        valid_i,
  input  stream_pkg::position_t position_i,
  input  wire  [PPC*8-1:0]           pixels_i,
  output logic                       valid_o,
  output stream_pkg::position_t      position_o,
  output logic [PPC*13-1:0]          gradients_o
);
  logic column_valid, window_valid;
  stream_pkg::position_t column_position, window_position;
  logic [PPC*24-1:0] columns;
  logic [(PPC+2)*24-1:0] window;
  line_taps #(.ROWS(3), .WIDTH(8), .PPC(PPC), .WORDS(WORDS)) u_lines (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid_i), .position_i(position_i), .pixels_i(pixels_i),
    .valid_o(column_valid), .position_o(column_position), .columns_o(columns)
  );
  word_window #(.REACH(1), .WIDTH(24), .PPC(PPC)) u_window (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(column_valid), .position_i(column_position),
    .pixels_i(columns), .valid_o(window_valid), .position_o(window_position), .window_o(window)
  );

  for (genvar p = 0; p < PPC; p++) begin : g_pixel
    operators u_operators (
      .clk_i(clk_i), .left_i(window[p*24 +: 24]), .middle_i(window[(p+1)*24 +: 24]),
      .right_i(window[(p+2)*24 +: 24]), .gradient_o(gradients_o[p*13 +: 13])
    );
  end
  delay #(.STAGES(6)) u_delay (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(window_valid), .position_i(window_position),
    .valid_o(valid_o), .position_o(position_o)
  );
endmodule
`default_nettype wire
