// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// 5x5 Gaussian (1 4 6 4 1 in both directions, rounded), thesis figure 48: first down the columns,
/// then along the line, so that only one value of each column moves on.
module gaussian #(
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
  output logic [PPC*8-1:0]           pixels_o
);
  logic column_valid, sum_valid, window_valid;
  stream_pkg::position_t column_position, sum_position, window_position;
  logic [PPC*40-1:0] columns;
  line_taps #(.ROWS(5), .WIDTH(8), .PPC(PPC), .WORDS(WORDS)) u_lines (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid_i), .position_i(position_i), .pixels_i(pixels_i),
    .valid_o(column_valid), .position_o(column_position), .columns_o(columns)
  );

  logic [PPC*9-1:0] outer_q, inner_q;
  logic [PPC*11-1:0] middle_q, middle_d1_q;
  logic [PPC*12-1:0] both_q, sums_q;
  always_ff @(posedge clk_i) begin
    for (int p = 0; p < PPC; p++) begin
      outer_q[p*9 +: 9] <= {1'b0, columns[p*40 +: 8]} + {1'b0, columns[p*40+32 +: 8]};
      inner_q[p*9 +: 9] <= {1'b0, columns[p*40+8 +: 8]} + {1'b0, columns[p*40+24 +: 8]};
      middle_q[p*11 +: 11] <= {1'b0, columns[p*40+16 +: 8], 2'b00} + {2'b00, columns[p*40+16 +: 8], 1'b0};
      both_q[p*12 +: 12] <= {3'b000, outer_q[p*9 +: 9]} + {1'b0, inner_q[p*9 +: 9], 2'b00};
      middle_d1_q[p*11 +: 11] <= middle_q[p*11 +: 11];
      sums_q[p*12 +: 12] <= both_q[p*12 +: 12] + {1'b0, middle_d1_q[p*11 +: 11]};
    end
  end
  delay #(.STAGES(3)) u_sum_delay (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(column_valid), .position_i(column_position),
    .valid_o(sum_valid), .position_o(sum_position)
  );

  logic [(PPC+4)*12-1:0] window;
  word_window #(.REACH(2), .WIDTH(12), .PPC(PPC)) u_window (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(sum_valid), .position_i(sum_position), .pixels_i(sums_q),
    .valid_o(window_valid), .position_o(window_position), .window_o(window)
  );

  logic [PPC*13-1:0] across_q, beside_q;
  logic [PPC*15-1:0] centre_q;
  logic [PPC*16-1:0] around_q, rounded_q, total_q;
  always_ff @(posedge clk_i) begin
    for (int p = 0; p < PPC; p++) begin
      across_q[p*13 +: 13] <= {1'b0, window[p*12 +: 12]} + {1'b0, window[(p+4)*12 +: 12]};
      beside_q[p*13 +: 13] <= {1'b0, window[(p+1)*12 +: 12]} + {1'b0, window[(p+3)*12 +: 12]};
      centre_q[p*15 +: 15] <= {1'b0, window[(p+2)*12 +: 12], 2'b00} + {2'b00, window[(p+2)*12 +: 12], 1'b0};
      around_q[p*16 +: 16] <= {3'b000, across_q[p*13 +: 13]} + {1'b0, beside_q[p*13 +: 13], 2'b00};
      rounded_q[p*16 +: 16] <= {1'b0, centre_q[p*15 +: 15]} + 16'd128;
      total_q[p*16 +: 16] <= around_q[p*16 +: 16] + rounded_q[p*16 +: 16];
    end
  end
  always_comb begin
    for (int p = 0; p < PPC; p++) pixels_o[p*8 +: 8] = total_q[p*16+8 +: 8];
  end
  delay #(.STAGES(3)) u_delay (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(window_valid), .position_i(window_position),
    .valid_o(valid_o), .position_o(position_o)
  );
endmodule
`default_nettype wire
