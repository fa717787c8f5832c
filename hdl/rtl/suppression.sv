// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// Non-maximum suppression and the two thresholds (thesis figures 51 and 52): for each pixel
/// {strong, candidate, sector}, nothing in blank lines.
module suppression #(
  parameter int PPC = 1,
  parameter int WORDS = 120
) (
  input  wire                        clk_i,
  input  wire                        rst_i,
  input  wire  [19:0]                low_i,   // of bank 1, of bank 0
  input  wire  [19:0]                high_i,
  input  wire                        valid_i,
  input  stream_pkg::position_t position_i,
  input  wire  [PPC*13-1:0]          gradients_i,
  output logic                       valid_o,
  output stream_pkg::position_t      position_o,
  output logic [PPC*5-1:0]           labels_o
);
  logic column_valid, window_valid, compared_valid;
  stream_pkg::position_t column_position, window_position, compared_position;
  logic [PPC*39-1:0] columns;
  logic [(PPC+2)*39-1:0] window;
  line_taps #(.ROWS(3), .WIDTH(13), .PPC(PPC), .WORDS(WORDS), .ZERO_BORDER(1)) u_lines (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid_i), .position_i(position_i), .pixels_i(gradients_i),
    .valid_o(column_valid), .position_o(column_position), .columns_o(columns)
  );
  word_window #(.REACH(1), .WIDTH(39), .PPC(PPC), .ZERO_BORDER(1)) u_window (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(column_valid), .position_i(column_position),
    .pixels_i(columns), .valid_o(window_valid), .position_o(window_position), .window_o(window)
  );
  delay #(.STAGES(2)) u_compared_delay (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(window_valid), .position_i(window_position),
    .valid_o(compared_valid), .position_o(compared_position)
  );
  delay #(.STAGES(1)) u_delay (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(compared_valid), .position_i(compared_position),
    .valid_o(valid_o), .position_o(position_o)
  );

  // Thresholds of the frame that the window is in, in time for the comparison.
  logic [9:0] low_q, high_q;
  always_ff @(posedge clk_i) begin
    low_q <= window_position.bank ? low_i[19:10] : low_i[9:0];
    high_q <= window_position.bank ? high_i[19:10] : high_i[9:0];
  end

  for (genvar p = 0; p < PPC; p++) begin : g_pixel
    /* verilator lint_off UNUSEDSIGNAL */  // only the middle pixel's sector counts
    logic [38:0] left, middle, right;
    /* verilator lint_on UNUSEDSIGNAL */
    assign left = window[p*39 +: 39];
    assign middle = window[(p+1)*39 +: 39];
    assign right = window[(p+2)*39 +: 39];
    logic [9:0] size_q, before_q, behind_q;
    logic [2:0] sector_q, sector_d1_q;
    logic above_low_q, above_high_q, maximum_q;
    always_ff @(posedge clk_i) begin
      size_q <= middle[22:13];
      sector_q <= middle[25:23];
      unique case (middle[24:23])
        2'd0: {before_q, behind_q} <= {left[22:13], right[22:13]};
        2'd1: {before_q, behind_q} <= {left[9:0], right[35:26]};
        2'd2: {before_q, behind_q} <= {middle[9:0], middle[35:26]};
        default: {before_q, behind_q} <= {right[9:0], left[35:26]};
      endcase
      sector_d1_q <= sector_q;
      above_low_q <= size_q > low_q;
      above_high_q <= size_q > high_q;
      maximum_q <= size_q > before_q && size_q >= behind_q;
      labels_o[p*5 +: 5] <= {compared_position.active & above_low_q & above_high_q & maximum_q,
                             compared_position.active & above_low_q & maximum_q, sector_d1_q};
    end
  end
endmodule
`default_nettype wire
