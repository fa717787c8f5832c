// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// One pass of hysteresis in raster order: a candidate becomes strong when one of its eight neighbours
/// is strong, those before it in their new state, those behind it as they came. A line and
/// three clocks of delay.
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

  // The labels of the former line, and the results of the line before it: as a word comes in, what is
  // above the next one is read, and each is overwritten by the next line once read.
  (* ram_style = "block", no_rw_check *)
  logic [PPC*5-1:0] labels_memory [WORDS];
  (* ram_style = "block", no_rw_check *)
  logic [PPC-1:0] results_memory [WORDS];
  logic [ADDRESS_WIDTH-1:0] read_address_q, address_q, result_address_q;
  logic [PPC*5-1:0] here;
  logic [PPC-1:0] above, reached;
  logic seed_valid;
  stream_pkg::position_t line_q, seed_position;
  always_ff @(posedge clk_i) begin
    if (valid_i) begin
      here <= labels_memory[read_address_q];
      above <= results_memory[read_address_q];
      labels_memory[address_q] <= labels_i;
    end
    if (seed_valid) results_memory[result_address_q] <= reached;
  end
  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      read_address_q <= ADDRESS_WIDTH'(1);
      address_q <= '0;
      result_address_q <= ADDRESS_WIDTH'(WORDS - 1);  // a word behind
      line_q <= '0;
    end else begin
      if (valid_i) begin
        read_address_q <= read_address_q == ADDRESS_WIDTH'(WORDS - 1) ? '0 : read_address_q + 1'b1;
        address_q <= read_address_q;
        if (position_i.last_word) line_q <= position_i;
      end
      if (seed_valid)
        result_address_q <= result_address_q == ADDRESS_WIDTH'(WORDS - 1) ? '0 : result_address_q + 1'b1;
    end
  end

  // The word above the one that comes in, and the word before it, which is decided now.
  logic [PPC*6-1:0] newest, centre_q;  // {strong above or below, strong, candidate, sector} of each pixel
  logic beside_q;                      // strong above or below the pixel at the left of the centre
  stream_pkg::position_t newest_position, centre_position_q;
  always_comb begin
    newest_position = line_q;
    newest_position.first_word = position_i.first_word;
    newest_position.last_word = position_i.last_word;
    for (int p = 0; p < PPC; p++)
      newest[p*6 +: 6] = {(above[p] & ~line_q.first_row) | (labels_i[p*5+4] & ~line_q.last_row),
                          here[p*5 +: 5]};
  end
  logic [PPC+1:0] across;  // of the centre with a neighbour on either side
  logic [PPC:0] raised;    // with the right one: the left one's new state comes a clock later
  always_comb begin
    across[0] = beside_q & ~centre_position_q.first_word;
    for (int p = 0; p < PPC; p++) begin
      across[p+1] = centre_q[p*6+5];
      raised[p] = centre_q[p*6+4];
    end
    across[PPC+1] = newest[5] & ~centre_position_q.last_word;
    raised[PPC] = newest[4] & ~centre_position_q.last_word;
  end

  // Reached from above, below or the right; from the left one clock later.
  logic [PPC-1:0] seed_q, candidate_q;
  logic [PPC*3-1:0] sector_q;
  always_ff @(posedge clk_i) begin
    if (valid_i) begin
      centre_q <= newest;
      centre_position_q <= newest_position;
      beside_q <= centre_q[PPC*6-1];
      for (int p = 0; p < PPC; p++) begin
        seed_q[p] <= raised[p] | (centre_q[p*6+3] & (across[p] | across[p+1] | across[p+2] | raised[p+1]));
        candidate_q[p] <= centre_q[p*6+3];
        sector_q[p*3 +: 3] <= centre_q[p*6 +: 3];
      end
      seed_position <= centre_position_q;
    end
    seed_valid <= valid_i & ~rst_i;
    if (rst_i) centre_position_q <= '0;
  end

  // What is reached runs to the right along candidates: pixel p, if a seed lies at or left of it and
  // only candidates between.
  logic left_q, left;
  assign left = left_q & ~seed_position.first_word;
  for (genvar p = 0; p < PPC; p++) begin : g_reach
    logic [p+1:0] from;  // the seeds, bit 0 is the word's left neighbour
    assign from[0] = left & (&candidate_q[p:0]);
    for (genvar s = 0; s <= p; s++) begin : g_seed
      assign from[s+1] = seed_q[s] & (&candidate_q[p:s]);
    end
    assign reached[p] = |from;
  end
  always_ff @(posedge clk_i) begin
    if (seed_valid) begin
      left_q <= reached[PPC-1];
      for (int p = 0; p < PPC; p++)
        labels_o[p*5 +: 5] <= {reached[p], candidate_q[p], sector_q[p*3 +: 3]};
    end
  end
  delay #(.STAGES(1)) u_delay (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(seed_valid), .position_i(seed_position),
    .valid_o(valid_o), .position_o(position_o)
  );
endmodule
`default_nettype wire
