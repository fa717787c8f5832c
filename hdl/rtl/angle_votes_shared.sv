// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// The votes of SLOTS consecutive angles of a set that take turns with one edge pixel: a multiplier
/// for each coordinate, one memory for all of them.
module angle_votes_shared #(
  parameter int FIRST = 0,         // position of the first angle in the set
  parameter int ANGLES = 180,      // of the set
  parameter logic [1439:0] ANGLE_SET = accelerator_pkg::FULL_SET,
  parameter int SLOTS = 9,
  parameter int REACH = 201,
  parameter int VOTE_WIDTH = 10,
  parameter int SLOT_WIDTH = $clog2(SLOTS + 1),
  parameter int ADDRESS_WIDTH = $clog2(SLOTS * (2 * REACH + 1))
) (
  input  wire                       clk_i,
  input  wire                       rst_i,
  input  wire  [2*SLOTS-1:0]        allow_i,        // {steep and flat rows, lower rows only} of each slot
  input  wire                       valid_i,
  input  wire                       bank_i,
  input  wire                       row_counts_i,
  input  wire  [1:0]                direction_i,
  input  wire  signed [11:0]        x_i,
  input  wire  signed [11:0]        y_i,
  input  wire  [SLOT_WIDTH-1:0]     slot_i,
  input  wire                       scan_i,
  input  wire                       scan_bank_i,
  input  wire  [ADDRESS_WIDTH-1:0]  scan_address_i,
  output logic [VOTE_WIDTH-1:0]     votes_o
);
  localparam int FRACTION = accelerator_pkg::FRACTION;
  localparam int TRIG = accelerator_pkg::TRIG_WIDTH;
  localparam int BINS = 2 * REACH + 1;
  localparam int RHO_WIDTH = $clog2(BINS) + FRACTION;
  localparam int ENTRY = 4 + ADDRESS_WIDTH + 2 * TRIG;

  // {admitted directions, first address, sin, cos} of each slot.
  logic [SLOTS*ENTRY-1:0] table_all;
  for (genvar s = 0; s < SLOTS; s++) begin : g_slot
    if (FIRST + s < ANGLES) begin : g_used
      localparam int ANGLE = 32'(ANGLE_SET[(FIRST+s)*8 +: 8]);
      assign table_all[s*ENTRY +: ENTRY] = {
        accelerator_pkg::ADMIT_TABLE[ANGLE*4 +: 4], ADDRESS_WIDTH'(s * BINS),
        accelerator_pkg::SIN_TABLE[ANGLE*TRIG +: TRIG], accelerator_pkg::COS_TABLE[ANGLE*TRIG +: TRIG]};
    end else begin : g_unused
      assign table_all[s*ENTRY +: ENTRY] = '0;
    end
  end

  // Picked by comparison: an index times ENTRY would become a shifter as wide as the table.
  logic [ENTRY-1:0] entry, entry_q;
  logic [1:0] allow;
  always_comb begin
    entry = '0;
    allow = '0;
    for (int s = 0; s < SLOTS; s++) begin
      entry = entry | ({ENTRY{slot_i == SLOT_WIDTH'(s)}} & table_all[s*ENTRY +: ENTRY]);
      allow = allow | ({2{slot_i == SLOT_WIDTH'(s)}} & allow_i[s*2 +: 2]);
    end
  end
  logic [3:0] admitted;
  logic [ADDRESS_WIDTH-1:0] base, base_q, base_d1_q, address_q;
  logic signed [TRIG-1:0] sine, cosine;
  assign {admitted, base, sine, cosine} = entry_q;
  logic [1:0] direction_q;
  logic signed [11:0] x_q, y_q;
  /* verilator lint_off UNUSEDSIGNAL */  // the products of a small image leave high bits empty
  logic signed [11+TRIG:0] x_part_q, y_part_q;
  /* verilator lint_on UNUSEDSIGNAL */
  logic allowed_q, valid_q, valid_d1_q, valid_d2_q, vote_q;
  logic bank_q, bank_d1_q, bank_d2_q, vote_bank_q;
  /* verilator lint_off UNUSEDSIGNAL */  // the fraction is rounded away
  logic [RHO_WIDTH-1:0] rho_q;
  /* verilator lint_on UNUSEDSIGNAL */
  always_ff @(posedge clk_i) begin
    entry_q <= entry;
    allowed_q <= allow[1] | (allow[0] & row_counts_i);
    direction_q <= direction_i;
    {x_q, y_q} <= {x_i, y_i};
    {bank_q, bank_d1_q, bank_d2_q, vote_bank_q} <= {bank_i, bank_q, bank_d1_q, bank_d2_q};
    x_part_q <= x_q * cosine;
    y_part_q <= y_q * sine;
    base_q <= base;
    rho_q <= RHO_WIDTH'(x_part_q) + RHO_WIDTH'(y_part_q) +
             RHO_WIDTH'((REACH << FRACTION) + (1 << (FRACTION - 1)));
    base_d1_q <= base_q;
    address_q <= base_d1_q + ADDRESS_WIDTH'(rho_q[RHO_WIDTH-1:FRACTION]);
    valid_q <= valid_i & ~rst_i;
    valid_d1_q <= valid_q & allowed_q & admitted[direction_q] & ~rst_i;
    valid_d2_q <= valid_d1_q & ~rst_i;
    vote_q <= valid_d2_q & ~rst_i;
  end

  vote_memory #(.DEPTH(SLOTS * BINS), .VOTE_WIDTH(VOTE_WIDTH)) u_memory (
    .clk_i(clk_i), .rst_i(rst_i), .vote_i(vote_q), .vote_bank_i(vote_bank_q),
    .vote_address_i(address_q), .scan_i(scan_i), .scan_bank_i(scan_bank_i),
    .scan_address_i(scan_address_i), .scan_votes_o(votes_o)
  );
endmodule
`default_nettype wire
