// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// Two vote memories that change roles with every frame: one counts, a vote in every clock, while the
/// other is read and cleared. A word holds a bin of LANES angles: they are read together and counted
/// one by one. Votes for one bin may follow each other at once.
module vote_memory #(
  parameter int DEPTH = 173,
  parameter int VOTE_WIDTH = 8,
  parameter int LANES = 1,
  parameter int ADDRESS_WIDTH = $clog2(DEPTH)
) (
  input  wire                         clk_i,
  input  wire                         rst_i,
  input  wire                         vote_i,
  input  wire                         vote_bank_i,
  input  wire  [LANES-1:0]            vote_lane_i,      // the one bit of the angle that counts
  input  wire  [ADDRESS_WIDTH-1:0]    vote_address_i,
  input  wire                         scan_i,           // read this bin, clear it one clock later
  input  wire                         scan_bank_i,
  input  wire  [ADDRESS_WIDTH-1:0]    scan_address_i,
  output logic [LANES*VOTE_WIDTH-1:0] scan_votes_o      // one clock after scan_i, held until the next
);
  /* verilator no_inline_module */  // one class for all of them: models compile faster
  (* ram_style = "block", no_rw_check *)
  logic [LANES*VOTE_WIDTH-1:0] memory0 [DEPTH];
  (* ram_style = "block", no_rw_check *)
  logic [LANES*VOTE_WIDTH-1:0] memory1 [DEPTH];
  logic [LANES*VOTE_WIDTH-1:0] read0_q, read1_q;

  // A vote: read, then add, then write; the sum is forwarded to votes one and two clocks behind.
  logic vote_q, write_q, bank_q, write_bank_q;
  logic [LANES-1:0] lane_q, write_lane_q;
  logic [ADDRESS_WIDTH-1:0] address_q, write_address_q, clear_address_q;
  logic [VOTE_WIDTH-1:0] sum, sum_q, sum_d1_q;
  logic forward_q, forward_d1_q, clear_q, scan_bank_q;
  always_comb begin
    sum = '0;
    if (LANES == 1 || vote_q)
      for (int l = 0; l < LANES; l++)
        sum = sum | ({VOTE_WIDTH{lane_q[l]}} & (bank_q ? read1_q[l*VOTE_WIDTH +: VOTE_WIDTH]
                                                       : read0_q[l*VOTE_WIDTH +: VOTE_WIDTH]));
    if (forward_q) sum = sum_q;
    else if (forward_d1_q) sum = sum_d1_q;
    sum = sum + 1'b1;
  end
  always_ff @(posedge clk_i) begin
    address_q <= vote_address_i;
    bank_q <= vote_bank_i;
    lane_q <= vote_lane_i;
    write_address_q <= address_q;
    write_bank_q <= bank_q;
    write_lane_q <= lane_q;
    sum_q <= sum;
    sum_d1_q <= sum_q;
    forward_q <= vote_q && vote_address_i == address_q && vote_bank_i == bank_q &&
                 (vote_lane_i & lane_q) != '0;
    forward_d1_q <= write_q && vote_address_i == write_address_q && vote_bank_i == write_bank_q &&
                    (vote_lane_i & write_lane_q) != '0;
    clear_address_q <= scan_address_i;
    if (scan_i) scan_bank_q <= scan_bank_i;
    vote_q <= vote_i & ~rst_i;
    write_q <= vote_q & ~rst_i;
    clear_q <= scan_i & ~rst_i;
  end
  assign scan_votes_o = scan_bank_q ? read1_q : read0_q;

  logic counts0, counts1;  // the role of each memory's read port in this clock
  assign counts0 = vote_i & ~vote_bank_i;
  assign counts1 = vote_i & vote_bank_i;
  logic [ADDRESS_WIDTH-1:0] read_address0, read_address1, put_address0, put_address1;
  assign read_address0 = counts0 ? vote_address_i : scan_address_i;
  assign read_address1 = counts1 ? vote_address_i : scan_address_i;
  logic write0, write1, clear0, clear1;
  assign write0 = write_q & ~write_bank_q;
  assign write1 = write_q & write_bank_q;
  assign clear0 = clear_q & ~scan_bank_q;
  assign clear1 = clear_q & scan_bank_q;
  assign put_address0 = write0 ? write_address_q : clear_address_q;
  assign put_address1 = write1 ? write_address_q : clear_address_q;
  always_ff @(posedge clk_i) begin
    if (counts0 || (scan_i && !scan_bank_i)) read0_q <= memory0[read_address0];
    if (write0 || clear0)
      for (int l = 0; l < LANES; l++)
        if (write_lane_q[l] || clear0)
          memory0[put_address0][l*VOTE_WIDTH +: VOTE_WIDTH] <= write0 ? sum_q : '0;
  end
  always_ff @(posedge clk_i) begin
    if (counts1 || (scan_i && scan_bank_i)) read1_q <= memory1[read_address1];
    if (write1 || clear1)
      for (int l = 0; l < LANES; l++)
        if (write_lane_q[l] || clear1)
          memory1[put_address1][l*VOTE_WIDTH +: VOTE_WIDTH] <= write1 ? sum_q : '0;
  end
endmodule
`default_nettype wire
