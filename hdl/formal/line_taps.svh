// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// line_taps behind a raster of whole lines: it writes at the word's place in the line, so it stays inside
// its memory, and reads what stands above the next word.
  logic f_started_q = 1'b0;
  always_ff @(posedge clk_i) f_started_q <= 1'b1;
  always_comb assume (rst_i == !f_started_q);
  logic [ADDRESS_WIDTH-1:0] f_word_q = '0;
  always_ff @(posedge clk_i)
    if (valid_i && !rst_i) f_word_q <= 32'(f_word_q) == WORDS - 1 ? '0 : f_word_q + 1'b1;
  always_comb if (valid_i) assume (!rst_i && position_i.last_word == (32'(f_word_q) == WORDS - 1));
  always_comb if (f_started_q) begin
    assert (32'(f_word_q) < WORDS && address_q == f_word_q);
    assert (32'(read_address_q) == (32'(f_word_q) == WORDS - 1 ? 0 : 32'(f_word_q) + 1));
    assert (read_address_q != address_q);
  end
