// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// angle_votes behind a raster of whole lines and frames (video_input): rho is exactly that of the
// definition, so no pixel of a frame votes outside its memory nor in its first or last bin, which the
// scan leaves out.
  logic f_started_q = 1'b0;
  always_ff @(posedge clk_i) f_started_q <= 1'b1;
  always_comb assume (rst_i == !f_started_q);
  logic [6:0] f_word_q = '0, f_row_q = '0;
  always_ff @(posedge clk_i) if (valid_i && !rst_i) begin
    f_word_q <= position_i.last_word ? '0 : f_word_q + 1'b1;
    if (position_i.last_word) f_row_q <= position_i.last_row ? '0 : f_row_q + 1'b1;
  end
  always_comb if (valid_i) begin
    assume (position_i.last_word == (32'(f_word_q) == WIDTH / PPC - 1));
    assume (position_i.last_row == (32'(f_row_q) == HEIGHT - 1));
  end
  always_comb if (f_started_q) begin
    assert (32'(f_word_q) < WIDTH / PPC && 32'(f_row_q) < HEIGHT);
    assert (rho_q == RHO_WIDTH'(FIRST_RHO) + RHO_WIDTH'(f_word_q) * RHO_WIDTH'(STEP) +
                     RHO_WIDTH'(f_row_q) * RHO_WIDTH'(SINE));
    for (int p = 0; p < PPC; p++)
      assert ((RHO_WIDTH'(rho_q + RHO_WIDTH'(p * COSINE)) >> FRACTION) < RHO_WIDTH'(2 * REACH) &&
              (RHO_WIDTH'(rho_q + RHO_WIDTH'(p * COSINE)) >> FRACTION) > '0);
  end
