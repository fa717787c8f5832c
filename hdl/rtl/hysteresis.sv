// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// One pass of hysteresis in raster order: a candidate becomes strong when one of its eight neighbours
/// is strong, those before it in their new state, those behind it as they came. One line of delay.
module hysteresis #(
  parameter int PPC = 1,
  parameter int WORDS = 120
) (
  input  wire                        clk_i,
  input  wire                        rst_i,
  input  wire                        valid_i,
  input  stream_pkg::position_t position_i,
  input  wire  [PPC*5-1:0]           labels_i,   // {strong, candidate, sector}
  output logic                       valid_o,
  output stream_pkg::position_t      position_o,
  output logic [PPC*5-1:0]           labels_o
);
  localparam int ADDRESS_WIDTH = $clog2(WORDS);

  // The labels of the former line, and the results of the line before it: read together, word by
  // word, and each overwritten by the next line once read.
  (* ram_style = "block", no_rw_check *)
  logic [PPC*5-1:0] labels_memory [WORDS];
  (* ram_style = "block", no_rw_check *)
  logic [PPC-1:0] results_memory [WORDS];
  logic [ADDRESS_WIDTH-1:0] address_q, address_d1_q, result_address_q;
  logic [PPC*5-1:0] here, below_q;
  logic [PPC-1:0] above;
  logic valid_q;
  stream_pkg::position_t position_q, line_q;
  always_ff @(posedge clk_i) begin
    if (valid_i) begin
      here <= labels_memory[address_q];
      above <= results_memory[address_q];
      below_q <= labels_i;
      address_d1_q <= address_q;
      position_q <= position_i;
    end
    if (valid_q) labels_memory[address_d1_q] <= below_q;
    if (valid_o) results_memory[result_address_q] <= results;
  end
  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      valid_q <= 1'b0;
      address_q <= '0;
      result_address_q <= '0;
      line_q <= '0;
    end else begin
      valid_q <= valid_i;
      if (valid_i) address_q <= position_i.last_word ? '0 : address_q + 1'b1;
      if (valid_o) result_address_q <= position_o.last_word ? '0 : result_address_q + 1'b1;
      if (valid_q && position_q.last_word) line_q <= position_q;
    end
  end

  // Strong bits of the three lines with a neighbour on either side, and the word's own labels.
  stream_pkg::position_t position;
  always_comb begin
    position = line_q;
    position.first_word = position_q.first_word;
    position.last_word = position_q.last_word;
  end
  logic [PPC*7-1:0] joined;  // {above, below, strong, candidate, sector} of each pixel
  always_comb begin
    for (int p = 0; p < PPC; p++)
      joined[p*7 +: 7] = {above[p] & ~line_q.first_row, below_q[p*5+4] & ~line_q.last_row, here[p*5 +: 5]};
  end
  logic window_valid;
  stream_pkg::position_t window_position;
  logic [(PPC+2)*7-1:0] window;
  word_window #(.REACH(1), .WIDTH(7), .PPC(PPC), .ZERO_BORDER(1)) u_window (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid_q), .position_i(position), .pixels_i(joined),
    .valid_o(window_valid), .position_o(window_position), .window_o(window)
  );

  // Reached from above, below or the right; from the left one clock later.
  logic [PPC-1:0] seed_q, candidate_q;
  logic [PPC*3-1:0] sector_q;
  logic seed_valid;
  stream_pkg::position_t seed_position;
  always_ff @(posedge clk_i) begin
    for (int p = 0; p < PPC; p++) begin
      seed_q[p] <= window[(p+1)*7+4] |
                   (window[(p+1)*7+3] &
                    (window[p*7+6] | window[(p+1)*7+6] | window[(p+2)*7+6] | window[p*7+5] |
                     window[(p+1)*7+5] | window[(p+2)*7+5] | window[(p+2)*7+4]));
      candidate_q[p] <= window[(p+1)*7+3];
      sector_q[p*3 +: 3] <= window[(p+1)*7 +: 3];
    end
  end
  delay #(.STAGES(1)) u_seed_delay (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(window_valid), .position_i(window_position),
    .valid_o(seed_valid), .position_o(seed_position)
  );

  // What is reached runs to the right along candidates: pixel p, if a seed lies at or left of it and
  // only candidates between.
  logic left_q, left;
  assign left = left_q & ~seed_position.first_word;
  logic [PPC-1:0] reached;
  for (genvar p = 0; p < PPC; p++) begin : g_reach
    logic [p+1:0] from;  // the seeds, bit 0 is the word's left neighbour
    assign from[0] = left & (&candidate_q[p:0]);
    for (genvar s = 0; s <= p; s++) begin : g_seed
      assign from[s+1] = seed_q[s] & (&candidate_q[p:s]);
    end
    assign reached[p] = |from;
  end
  logic [PPC-1:0] results;
  always_ff @(posedge clk_i) begin
    if (seed_valid) begin
      left_q <= reached[PPC-1];
      for (int p = 0; p < PPC; p++)
        labels_o[p*5 +: 5] <= {reached[p], candidate_q[p], sector_q[p*3 +: 3]};
    end
  end
  always_comb begin
    for (int p = 0; p < PPC; p++) results[p] = labels_o[p*5+4];
  end
  delay #(.STAGES(1)) u_delay (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(seed_valid), .position_i(seed_position),
    .valid_o(valid_o), .position_o(position_o)
  );
endmodule
`default_nettype wire
