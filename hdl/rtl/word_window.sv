// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// The pixels of a word with REACH neighbours on either side in the line, delayed by as many words as
/// the reach needs. Neighbours outside the line repeat the border, or are 0 with ZERO_BORDER; they
/// are chosen as the word moves in, so the window comes straight out of registers.
module word_window #(
  parameter int REACH = 1,
  parameter int WIDTH = 8,
  parameter int PPC = 1,
  parameter bit ZERO_BORDER = 0
) (
  input  wire                                 clk_i,
  input  wire                                 rst_i,
  input  wire                                 valid_i,
  input  stream_pkg::position_t          position_i,
  input  wire  [PPC*WIDTH-1:0]                pixels_i,
  output logic                                valid_o,
  output stream_pkg::position_t               position_o,
  output logic [(PPC+2*REACH)*WIDTH-1:0]      window_o    // the left neighbour in the lowest bits
);
  localparam int SIDE = (REACH + PPC - 1) / PPC;  // words on either side
  localparam int KEPT = 2 * SIDE + 1;
  localparam int WORD_WIDTH = PPC * WIDTH;

  // Slice k: the word k before the newest one, which is moving in.
  logic [KEPT*WORD_WIDTH-1:0] words;
  logic [(KEPT-1)*WORD_WIDTH-1:0] words_q;
  logic [KEPT-1:0] first, last, first_q, last_q;
  assign words = {words_q, pixels_i};
  assign first = {first_q[KEPT-2:0], position_i.first_word};
  assign last = {last_q[KEPT-2:0], position_i.last_word};
  logic [(PPC+2*REACH)*WIDTH-1:0] window;
  logic [SIDE:0] active_q, bank_q, first_row_q, last_row_q;
  always_ff @(posedge clk_i) begin
    if (valid_i) begin
      words_q <= words[(KEPT-1)*WORD_WIDTH-1:0];
      window_o <= window;
    end
  end
  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      valid_o <= 1'b0;
      {first_q, last_q, active_q, bank_q, first_row_q, last_row_q} <= '0;
    end else begin
      valid_o <= valid_i;
      if (valid_i) begin
        first_q <= first;
        last_q <= last;
        active_q <= {active_q[SIDE-1:0], position_i.active};
        bank_q <= {bank_q[SIDE-1:0], position_i.bank};
        first_row_q <= {first_row_q[SIDE-1:0], position_i.first_row};
        last_row_q <= {last_row_q[SIDE-1:0], position_i.last_row};
      end
    end
  end
  always_comb begin
    position_o = '0;
    position_o.active = active_q[SIDE];
    position_o.bank = bank_q[SIDE];
    position_o.first_row = first_row_q[SIDE];
    position_o.last_row = last_row_q[SIDE];
    position_o.first_word = first_q[SIDE];
    position_o.last_word = last_q[SIDE];
  end

  // Whether the line ends before the k-th word on either side.
  logic [SIDE:0] left_ends, right_ends;
  always_comb begin
    left_ends = '0;
    right_ends = '0;
    for (int k = 1; k <= SIDE; k++) begin
      left_ends[k] = left_ends[k-1] | first[SIDE+k-1];
      right_ends[k] = right_ends[k-1] | last[SIDE-k+1];
    end
  end
  always_comb begin
    window = '0;
    for (int p = 0; p < PPC; p++)
      window[(REACH+p)*WIDTH +: WIDTH] = words[SIDE*WORD_WIDTH + p*WIDTH +: WIDTH];
    for (int d = 1; d <= REACH; d++) begin
      // d pixels beside the word: in word k, which holds pixels (k-1) PPC + 1 .. k PPC beside it.
      if (!left_ends[(d+PPC-1)/PPC])
        window[(REACH-d)*WIDTH +: WIDTH] =
            words[(SIDE+(d+PPC-1)/PPC)*WORD_WIDTH + (((d+PPC-1)/PPC)*PPC-d)*WIDTH +: WIDTH];
      else if (!ZERO_BORDER)
        window[(REACH-d)*WIDTH +: WIDTH] = window[(REACH-d+1)*WIDTH +: WIDTH];
      if (!right_ends[(d+PPC-1)/PPC])
        window[(REACH+PPC-1+d)*WIDTH +: WIDTH] =
            words[(SIDE-(d+PPC-1)/PPC)*WORD_WIDTH + ((d-1)%PPC)*WIDTH +: WIDTH];
      else if (!ZERO_BORDER)
        window[(REACH+PPC-1+d)*WIDTH +: WIDTH] = window[(REACH+PPC-2+d)*WIDTH +: WIDTH];
    end
  end
endmodule
`default_nettype wire
