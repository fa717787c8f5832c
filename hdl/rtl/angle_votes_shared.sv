// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// The votes of SLOTS angles of a set, every STRIDE-th, that take turns with an edge pixel: a
/// multiplier for each coordinate and one memory, a bin of all of them in each word.
module angle_votes_shared #(
  parameter int FIRST = 0,         // position of the first angle in the set
  parameter int STRIDE = 20,
  parameter int ANGLES = 180,      // of the set
  parameter logic [1439:0] ANGLE_SET = accelerator_pkg::FULL_SET,
  parameter int SLOTS = 9,
  parameter int REACH = 201,
  parameter int VOTE_WIDTH = 10,
  parameter int BIN_WIDTH = $clog2(2 * REACH + 1)
) (
  input  wire                         clk_i,
  input  wire                         rst_i,
  input  wire  [SLOTS-1:0]            allow_i,        // of each slot: it counts this pixel
  input  wire                         valid_i,
  input  wire                         bank_i,
  input  wire  [1:0]                  direction_i,
  input  wire  signed [11:0]          x_i,
  input  wire  signed [11:0]          y_i,
  input  wire  [SLOTS-1:0]            slot_i,         // one bit
  input  wire                         scan_i,
  input  wire                         scan_bank_i,
  input  wire  [BIN_WIDTH-1:0]        scan_bin_i,
  output logic [SLOTS*VOTE_WIDTH-1:0] votes_o         // one clock after scan_i, held until the next
);
  localparam int FRACTION = accelerator_pkg::FRACTION;
  localparam int TRIG = accelerator_pkg::TRIG_WIDTH;
  localparam int RHO_WIDTH = BIN_WIDTH + FRACTION;
  localparam int ENTRY = 4 + 2 * TRIG;

  // {admitted directions, sin, cos} of each slot; picked by comparison: an index times ENTRY would
  // become a shifter as wide as the table.
  logic [SLOTS*ENTRY-1:0] table_all;
  for (genvar s = 0; s < SLOTS; s++) begin : g_slot
    if (FIRST + s * STRIDE < ANGLES) begin : g_used
      localparam int ANGLE = 32'(ANGLE_SET[(FIRST+s*STRIDE)*8 +: 8]);
      assign table_all[s*ENTRY +: ENTRY] = {
        accelerator_pkg::ADMIT_TABLE[ANGLE*4 +: 4], accelerator_pkg::SIN_TABLE[ANGLE*TRIG +: TRIG],
        accelerator_pkg::COS_TABLE[ANGLE*TRIG +: TRIG]};
    end else begin : g_unused
      assign table_all[s*ENTRY +: ENTRY] = '0;
    end
  end
  logic [ENTRY-1:0] entry, entry_q;
  always_comb begin
    entry = '0;
    if (valid_i)
      for (int s = 0; s < SLOTS; s++)
        entry = entry | ({ENTRY{slot_i[s]}} & table_all[s*ENTRY +: ENTRY]);
  end
  logic [3:0] admitted;
  logic signed [TRIG-1:0] sine, cosine;
  assign {admitted, sine, cosine} = entry_q;

  logic [1:0] direction_q;
  logic signed [11:0] x_q, y_q;
  /* verilator lint_off UNUSEDSIGNAL */  // the products of a small image leave high bits empty
  logic signed [11+TRIG:0] x_part_q, y_part_q;
  /* verilator lint_on UNUSEDSIGNAL */
  logic allowed_q, valid_q, valid_d1_q, vote_q, bank_q, bank_d1_q, vote_bank_q;
  logic [SLOTS-1:0] slot_q, slot_d1_q, vote_slot_q;
  /* verilator lint_off UNUSEDSIGNAL */  // the fraction is rounded away
  logic [RHO_WIDTH-1:0] rho_q;
  /* verilator lint_on UNUSEDSIGNAL */
  always_ff @(posedge clk_i) begin
    if (valid_i) begin
      entry_q <= entry;
      allowed_q <= (slot_i & allow_i) != '0;
      direction_q <= direction_i;
      {x_q, y_q} <= {x_i, y_i};
    end
    {bank_q, bank_d1_q, vote_bank_q} <= {bank_i, bank_q, bank_d1_q};
    {slot_q, slot_d1_q, vote_slot_q} <= {slot_i, slot_q, slot_d1_q};
    if (valid_q) begin
      x_part_q <= x_q * cosine;
      y_part_q <= y_q * sine;
    end
    rho_q <= RHO_WIDTH'(x_part_q) + RHO_WIDTH'(y_part_q) +
             RHO_WIDTH'((REACH << FRACTION) + (1 << (FRACTION - 1)));
    valid_q <= valid_i & ~rst_i;
    valid_d1_q <= valid_q & allowed_q & admitted[direction_q] & ~rst_i;
    vote_q <= valid_d1_q & ~rst_i;
  end

  vote_memory #(.DEPTH(2 * REACH + 1), .VOTE_WIDTH(VOTE_WIDTH), .LANES(SLOTS)) u_memory (
    .clk_i(clk_i), .rst_i(rst_i), .vote_i(vote_q), .vote_bank_i(vote_bank_q), .vote_lane_i(vote_slot_q),
    .vote_address_i(rho_q[RHO_WIDTH-1:FRACTION]), .scan_i(scan_i), .scan_bank_i(scan_bank_i),
    .scan_address_i(scan_bin_i), .scan_votes_o(votes_o)
  );
endmodule
`default_nettype wire
