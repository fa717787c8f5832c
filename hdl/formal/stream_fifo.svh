// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// stream_fifo behind a source that keeps to room_o, one clock late: nothing is lost, doubled or
// reordered, it never overflows, and what is offered stays until it is taken. DEPTH 4.
  logic f_started_q = 1'b0, f_room_q = 1'b0;
  always_ff @(posedge clk_i) begin
    f_started_q <= 1'b1;
    f_room_q <= room_o && !rst_i;
  end
  always_comb assume (rst_i == !f_started_q);
  always_comb if (valid_i) assume (f_started_q && f_room_q);

  // One word, chosen freely, is followed by the number of words before it.
  (* anyconst *) logic [3:0] f_chosen;
  logic [3:0] f_sent_q = '0, f_received_q = '0;
  logic [WIDTH-1:0] f_word_q, f_data_q;
  logic f_offered_q = 1'b0;
  logic [3:0] f_out, f_before;
  assign f_out = f_received_q + 4'(valid_o);   // words that have left the memory
  assign f_before = f_chosen - f_out;          // words in the memory before the chosen one
  always_ff @(posedge clk_i) begin
    if (!rst_i) begin
      if (valid_i) f_sent_q <= f_sent_q + 1'b1;
      if (valid_i && f_sent_q == f_chosen) f_word_q <= data_i;
      if (valid_o && ready_i) f_received_q <= f_received_q + 1'b1;
    end
    f_offered_q <= valid_o && !ready_i && !rst_i;
    f_data_q <= data_o;
  end
  always_comb if (f_started_q) begin
    assert (count_q <= 3'(DEPTH - MARGIN));
    if (room_o) assert (count_q <= 3'(DEPTH - MARGIN - 2));
    if (f_room_q) assert (count_q <= 3'(DEPTH - MARGIN - 1));
    assert (f_sent_q == f_out + 4'(count_q));
    assert (write_q == f_sent_q[1:0] && read_q == f_out[1:0]);
    if (f_before < 4'(count_q)) assert (memory[f_chosen[1:0]] == f_word_q);
    if (valid_o && f_received_q == f_chosen) assert (data_o == f_word_q);
    if (f_offered_q) assert (valid_o && data_o == f_data_q);
  end
