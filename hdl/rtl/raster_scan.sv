// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// Finds the lines in votes that come as a raster, a bin in each clock, an angle in each row; the same
/// rule as peak_scan.
module raster_scan #(
  parameter int ANGLES = 180,
  parameter logic [1439:0] ANGLE_SET = accelerator_pkg::FULL_SET,
  parameter int REACH = 201,
  parameter int VOTE_WIDTH = 10
) (
  input  wire                        clk_i,
  input  wire                        rst_i,
  input  wire  [7:0]                 vertical_from_i,
  input  wire  [7:0]                 vertical_to_i,
  input  wire  [10:0]                vertical_votes_i,
  input  wire  [10:0]                inclined_votes_i,
  input  wire                        valid_i,
  input  stream_pkg::position_t position_i,
  input  wire  [VOTE_WIDTH-1:0]      votes_i,
  output logic                       room_o,
  output logic                       line_valid_o,
  input  wire                        line_ready_i,
  output logic [31:0]                line_o
);
  logic column_valid, window_valid;
  stream_pkg::position_t column_position;
  /* verilator lint_off UNUSEDSIGNAL */  // a raster of votes has no banks
  stream_pkg::position_t window_position;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [3*VOTE_WIDTH-1:0] column;
  logic [15*VOTE_WIDTH-1:0] window;
  line_taps #(.ROWS(3), .WIDTH(VOTE_WIDTH), .PPC(1), .WORDS(2 * REACH + 1), .ZERO_BORDER(1)) u_rows (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid_i), .position_i(position_i), .pixels_i(votes_i),
    .valid_o(column_valid), .position_o(column_position), .columns_o(column)
  );
  word_window #(.REACH(2), .WIDTH(3 * VOTE_WIDTH), .PPC(1), .ZERO_BORDER(1)) u_window (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(column_valid), .position_i(column_position),
    .pixels_i(column), .valid_o(window_valid), .position_o(window_position), .window_o(window)
  );

  // What is known of each angle: theta + 90, whether the set goes on before and behind it; 16 bits
  // apart, so that the index needs no multiplication.
  logic [256*16-1:0] known;
  for (genvar a = 0; a < 256; a++) begin : g_angle
    if (a < ANGLES) begin : g_used
      localparam int THETA = 32'(ANGLE_SET[a*8 +: 8]);
      localparam bit FORMER = a > 0 && THETA - 32'(ANGLE_SET[((a+ANGLES-1)%ANGLES)*8 +: 8]) <= 2;
      localparam bit LATER = a + 1 < ANGLES && 32'(ANGLE_SET[((a+1)%ANGLES)*8 +: 8]) - THETA <= 2;
      assign known[a*16 +: 16] = {6'd0, LATER, FORMER, 8'(THETA)};
    end else begin : g_unused
      assign known[a*16 +: 16] = '0;
    end
  end
  logic [7:0] angle_q;
  logic signed [11:0] rho_q, rho;
  logic [9:0] here_q;
  logic signed [7:0] theta;
  assign theta = $signed(here_q[7:0] - 8'd90);
  assign rho = window_position.first_word ? 12'(-REACH) : rho_q;
  always_ff @(posedge clk_i) begin
    here_q <= known[angle_q*16 +: 10];
    if (rst_i) angle_q <= '0;
    else if (window_valid && window_position.active && window_position.last_word)
      angle_q <= window_position.last_row ? '0 : angle_q + 1'b1;
    if (window_valid) rho_q <= rho + 1'b1;
  end

  logic [VOTE_WIDTH-1:0] centre, centre_q;
  assign centre = window[7*VOTE_WIDTH +: VOTE_WIDTH];
  logic beaten_q, beaten_by_former_q, beaten_by_later_q, valid_q, inclined_q, enough_q, former, later;
  logic signed [11:0] rho_d1_q;
  logic signed [7:0] theta_q;
  always_comb begin
    former = 1'b0;
    later = 1'b0;
    for (int k = 0; k < 5; k++) begin
      if (window[k*3*VOTE_WIDTH +: VOTE_WIDTH] >= centre) former = 1'b1;
      if (window[(k*3+2)*VOTE_WIDTH +: VOTE_WIDTH] > centre) later = 1'b1;
    end
  end
  logic inclined;
  assign inclined = theta < $signed(vertical_from_i) || theta > $signed(vertical_to_i);
  always_ff @(posedge clk_i) begin
    valid_q <= window_valid && window_position.active && !rst_i;
    centre_q <= centre;
    theta_q <= theta;
    rho_d1_q <= rho;
    inclined_q <= inclined;
    enough_q <= 11'(centre) >= (inclined ? inclined_votes_i : vertical_votes_i);
    beaten_q <= window[VOTE_WIDTH +: VOTE_WIDTH] >= centre ||
                window[4*VOTE_WIDTH +: VOTE_WIDTH] >= centre ||
                window[10*VOTE_WIDTH +: VOTE_WIDTH] > centre ||
                window[13*VOTE_WIDTH +: VOTE_WIDTH] > centre;
    beaten_by_former_q <= former && here_q[8];
    beaten_by_later_q <= later && here_q[9];
  end

  logic hit;
  assign hit = valid_q && enough_q && !beaten_q && !beaten_by_former_q && !beaten_by_later_q;
  stream_fifo #(.WIDTH(32), .DEPTH(32), .MARGIN(16)) u_lines (
    .clk_i(clk_i), .rst_i(rst_i), .room_o(room_o), .valid_i(hit),
    .data_i(accelerator_pkg::line_word(inclined_q, theta_q, rho_d1_q, 11'(centre_q))), .valid_o(line_valid_o),
    .ready_i(line_ready_i), .data_o(line_o)
  );
endmodule
`default_nettype wire
