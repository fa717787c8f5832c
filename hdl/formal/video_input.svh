// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// video_input whatever the source sends as long as it holds what it offers: words leave in raster
// order, whole lines and whole frames; a pixel that is taken is the pixel that leaves; nothing moves
// without room; counters stay in range.
  logic f_started_q = 1'b0;
  always_ff @(posedge clk_i) f_started_q <= 1'b1;
  always_comb assume (rst_i == !f_started_q);
  logic f_waiting_q = 1'b0, f_user_q, f_last_q;
  logic [PPC*8-1:0] f_data_q;
  always_ff @(posedge clk_i) begin
    f_waiting_q <= s_axis_tvalid && !s_axis_tready && !rst_i;
    {f_user_q, f_last_q, f_data_q} <= {s_axis_tuser, s_axis_tlast, s_axis_tdata};
  end
  always_comb if (f_waiting_q)
    assume (s_axis_tvalid && {s_axis_tuser, s_axis_tlast, s_axis_tdata} == {f_user_q, f_last_q, f_data_q});

  // What must come out: words and lines counted where they leave.
  logic [WORD_WIDTH-1:0] f_word_q = '0;
  logic [ROW_WIDTH-1:0] f_row_q = '0;
  logic f_moved_q = 1'b0, f_taken_q = 1'b0;
  always_ff @(posedge clk_i) begin
    f_moved_q <= (moves || blanks) && !rst_i;
    f_taken_q <= (starts || takes) && !rst_i;
    if (valid_o && !rst_i) f_word_q <= f_word_q == WORD_WIDTH'(WORDS - 1) ? '0 : f_word_q + 1'b1;
    if (valid_o && !rst_i && position_o.active && f_word_q == WORD_WIDTH'(WORDS - 1))
      f_row_q <= f_row_q == ROW_WIDTH'(HEIGHT - 1) ? '0 : f_row_q + 1'b1;
  end
  logic f_ends_line, f_ends_frame;
  assign f_ends_line = f_word_q == WORD_WIDTH'(WORDS - 1);
  assign f_ends_frame = f_row_q == ROW_WIDTH'(HEIGHT - 1);
  always_comb if (f_started_q) begin
    assert (32'(word_q) < WORDS && 32'(row_q) < HEIGHT && 32'(blank_q) <= BLANK_LINES);
    assert (state_q == Between || state_q == Frame || state_q == Blank);
    if (state_q == Between) assert (word_q == '0);
    if (state_q != Frame) assert (row_q == '0 && !fill_line_q && !fill_frame_q);
    if (fill_line_q) assert (word_q != '0);
    // the counters of what leaves follow those of what moves by one clock
    if (valid_o) assert (word_q == (f_ends_line ? '0 : f_word_q + 1'b1));
    else assert (word_q == f_word_q);
    if (valid_o && position_o.active && f_ends_line) assert (row_q == (f_ends_frame ? '0 : f_row_q + 1'b1));
    else assert (row_q == f_row_q);
    assert (valid_o == f_moved_q);
    if (valid_o) begin
      assert (position_o.first_word == (f_word_q == '0));
      assert (position_o.last_word == f_ends_line);
      assert (position_o.first_row == (position_o.active && f_row_q == '0));
      assert (position_o.last_row == (position_o.active && f_ends_frame));
      if (f_row_q != '0) assert (position_o.active);
    end
    if (f_taken_q) assert (valid_o && position_o.active && pixels_o == f_data_q);
    if (!room_i) assert (!moves && !blanks);
    if (s_axis_tready) assert (s_axis_tvalid);
    if (begin_o) assert (admit_i && s_axis_tready && s_axis_tuser);
  end
