// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// A column of ROWS lines for each pixel: the word's line in the middle, delayed by ROWS/2 lines.
/// Rows outside the frame repeat the border, or are 0 with ZERO_BORDER. Row 0 is the upper one and in
/// the lowest bits. One memory of one line, ROWS - 1 lines wide.
module line_taps #(
  parameter int ROWS = 3,
  parameter int WIDTH = 8,      // bits of a pixel
  parameter int PPC = 1,
  parameter int WORDS = 120,    // of a line, at least 16
  parameter bit ZERO_BORDER = 0
) (
  input  wire                             clk_i,
  input  wire                             rst_i,
  input  wire                             valid_i,
  input  stream_pkg::position_t      position_i,
  input  wire  [PPC*WIDTH-1:0]            pixels_i,
  output logic                            valid_o,
  output stream_pkg::position_t           position_o,
  output logic [PPC*ROWS*WIDTH-1:0]       columns_o   // pixel p, row r at (p*ROWS + r)*WIDTH
);
  localparam int MIDDLE = ROWS / 2;
  localparam int WORD_WIDTH = PPC * WIDTH;
  localparam int ADDRESS_WIDTH = $clog2(WORDS);

  // Line k back is in slice k - 1.
  (* ram_style = "block", no_rw_check *)
  logic [(ROWS-1)*WORD_WIDTH-1:0] memory [WORDS];
  logic [(ROWS-1)*WORD_WIDTH-1:0] older_q;
  logic [ADDRESS_WIDTH-1:0] read_address_q, address_q;

  // As a word comes in, what is above the next one is read.
  always_ff @(posedge clk_i) begin
    if (valid_i) begin
      older_q <= memory[read_address_q];
      memory[address_q] <= taps[(ROWS-1)*WORD_WIDTH-1:0];
    end
  end
  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      read_address_q <= ADDRESS_WIDTH'(1);
      address_q <= '0;
    end else if (valid_i) begin
      read_address_q <= read_address_q == ADDRESS_WIDTH'(WORDS - 1) ? '0 : read_address_q + 1'b1;
      address_q <= read_address_q;
    end
  end

  // Line k back in slice k; what is known of the lines likewise.
  logic [ROWS*WORD_WIDTH-1:0] taps;
  assign taps = {older_q, pixels_i};
  logic [ROWS-1:0] first, last;
  logic [ROWS-1:1] first_q, last_q;
  logic [MIDDLE:0] active, bank;
  logic [MIDDLE:1] active_q, bank_q;
  assign first = {first_q, position_i.first_row && position_i.active};
  assign last = {last_q, position_i.last_row && position_i.active};
  assign active = {active_q, position_i.active};
  assign bank = {bank_q, position_i.bank};
  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      first_q <= '0;
      last_q <= '0;
      active_q <= '0;
      bank_q <= '0;
    end else if (valid_i && position_i.last_word) begin
      first_q <= first[ROWS-2:0];
      last_q <= last[ROWS-2:0];
      active_q <= active[MIDDLE-1:0];
      bank_q <= bank[MIDDLE-1:0];
    end
  end

  // Walking from the middle outwards, nothing beyond the frame's first and last line counts.
  logic [ROWS*WORD_WIDTH-1:0] rows;  // upper row first
  logic [MIDDLE:0] above_ends, below_ends;
  always_comb begin
    rows = '0;
    rows[MIDDLE*WORD_WIDTH +: WORD_WIDTH] = taps[MIDDLE*WORD_WIDTH +: WORD_WIDTH];
    above_ends = '0;
    below_ends = '0;
    above_ends[0] = first[MIDDLE];
    below_ends[0] = last[MIDDLE];
    for (int d = 1; d <= MIDDLE; d++) begin
      if (!above_ends[d-1])
        rows[(MIDDLE-d)*WORD_WIDTH +: WORD_WIDTH] = taps[(MIDDLE+d)*WORD_WIDTH +: WORD_WIDTH];
      else if (!ZERO_BORDER)
        rows[(MIDDLE-d)*WORD_WIDTH +: WORD_WIDTH] = rows[(MIDDLE-d+1)*WORD_WIDTH +: WORD_WIDTH];
      if (!below_ends[d-1])
        rows[(MIDDLE+d)*WORD_WIDTH +: WORD_WIDTH] = taps[(MIDDLE-d)*WORD_WIDTH +: WORD_WIDTH];
      else if (!ZERO_BORDER)
        rows[(MIDDLE+d)*WORD_WIDTH +: WORD_WIDTH] = rows[(MIDDLE+d-1)*WORD_WIDTH +: WORD_WIDTH];
      above_ends[d] = above_ends[d-1] | first[MIDDLE+d];
      below_ends[d] = below_ends[d-1] | last[MIDDLE-d];
    end
  end

  always_ff @(posedge clk_i) begin
    if (valid_i) begin
      for (int p = 0; p < PPC; p++)
        for (int r = 0; r < ROWS; r++)
          columns_o[(p*ROWS+r)*WIDTH +: WIDTH] <= rows[r*WORD_WIDTH + p*WIDTH +: WIDTH];
    end
  end
  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      valid_o <= 1'b0;
      position_o <= '0;
    end else begin
      valid_o <= valid_i;
      if (valid_i) begin
        position_o.active <= active[MIDDLE];
        position_o.bank <= bank[MIDDLE];
        position_o.first_row <= first[MIDDLE];
        position_o.last_row <= last[MIDDLE];
        position_o.first_word <= position_i.first_word;
        position_o.last_word <= position_i.last_word;
      end
    end
  end
endmodule
`default_nettype wire
