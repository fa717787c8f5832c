// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// Reads all angles' votes side by side, a bin in each step, and reports local maxima: bins with
/// enough votes that beat everything within 2 bins at their own and the neighbouring angles, the first
/// of equal ones. Steps wait while several angles fire together, so no line is lost. After a reset it
/// reads both banks once, to clear them.
module peak_scan #(
  parameter int ANGLES = 12,
  parameter logic [1439:0] ANGLE_SET = accelerator_pkg::THESIS_SET,
  parameter int REACH = 86,
  parameter int VOTE_WIDTH = 8,
  parameter int BIN_WIDTH = $clog2(2 * REACH + 1)
) (
  input  wire                          clk_i,
  input  wire                          rst_i,
  output logic                         cleared_o,      // the memories may count
  input  wire                          request_i,      // a frame's votes are complete
  input  wire                          packet_idle_i,  // the former frame's packet has ended
  input  wire                          request_bank_i,
  input  wire  [ANGLES-1:0]            vertical_i,     // class 0, for the bank being scanned
  input  wire  [10:0]                  vertical_votes_i,
  input  wire  [10:0]                  inclined_votes_i,
  output logic                         advance_o,
  output logic                         scan_o,
  output logic                         scan_bank_o,
  output logic [BIN_WIDTH-1:0]         scan_bin_o,
  output logic                         scanned_o,      // the former step has read a bin to report
  input  wire  [ANGLES*VOTE_WIDTH-1:0] votes_i,
  output logic                         begin_o,        // a frame's scan begins
  output logic                         end_o,          // and has ended, all lines taken
  output logic                         line_valid_o,
  input  wire                          line_ready_i,
  output logic [31:0]                  line_o
);
  localparam int BINS = 2 * REACH + 1;
  localparam int STEPS = BINS + 5;  // the last bin is decided four steps after its read
  localparam int STEP_WIDTH = $clog2(STEPS + 1);

  typedef enum logic [1:0] {ClearFirst, ClearSecond, Idle, Scan} state_e;
  state_e state_q;
  logic [STEP_WIDTH-1:0] step_q;
  logic pending_q, pending_bank_q, bank_q, last_step;
  logic [ANGLES-1:0] hits_q, hits;
  assign last_step = step_q == STEP_WIDTH'(STEPS);
  assign cleared_o = state_q == Idle || state_q == Scan;
  assign begin_o = state_q == Idle && pending_q && packet_idle_i;
  assign end_o = state_q == Scan && last_step && hits_q == '0;
  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      state_q <= ClearFirst;
      step_q <= '0;
      bank_q <= 1'b0;
      pending_q <= 1'b0;
      pending_bank_q <= 1'b0;
    end else begin
      if (request_i) pending_bank_q <= request_bank_i;
      pending_q <= request_i | (pending_q & ~begin_o);
      if (state_q == Idle) step_q <= '0;
      else if (advance_o && !last_step) step_q <= step_q + 1'b1;
      unique case (state_q)
        ClearFirst: if (last_step) begin
          state_q <= ClearSecond;
          step_q <= '0;
          bank_q <= 1'b1;
        end
        ClearSecond: if (last_step) state_q <= Idle;
        Idle: if (begin_o) begin
          state_q <= Scan;
          bank_q <= pending_bank_q;
        end
        default: if (end_o) state_q <= Idle;
      endcase
    end
  end
  assign scan_o = advance_o && state_q != Idle && step_q < STEP_WIDTH'(BINS);
  assign scan_bank_o = bank_q;
  assign scan_bin_o = step_q[BIN_WIDTH-1:0];

  // The last four bins of each angle, the newest (bin step - 2) in slice 0.
  assign scanned_o = state_q == Scan && step_q != '0 && step_q <= STEP_WIDTH'(BINS);
  logic [ANGLES*3*VOTE_WIDTH-1:0] older_q;
  logic [ANGLES*4*VOTE_WIDTH-1:0] window;
  always_comb begin
    for (int a = 0; a < ANGLES; a++)
      window[a*4*VOTE_WIDTH +: 4*VOTE_WIDTH] =
          {older_q[a*3*VOTE_WIDTH +: 3*VOTE_WIDTH], votes_i[a*VOTE_WIDTH +: VOTE_WIDTH]};
  end
  always_ff @(posedge clk_i) begin
    if (state_q != Scan) older_q <= '0;
    else if (advance_o)
      for (int a = 0; a < ANGLES; a++)
        older_q[a*3*VOTE_WIDTH +: 3*VOTE_WIDTH] <= window[a*4*VOTE_WIDTH +: 3*VOTE_WIDTH];
  end

  // Each pair of bins is compared once, when the newer one arrives; a bin's chances go along with it
  // until it is in slice 2.
  // What does not fit is all ones, which is more votes than there can be.
  logic [VOTE_WIDTH-1:0] vertical_least, inclined_least;
  assign vertical_least = vertical_votes_i[VOTE_WIDTH-1:0] | {VOTE_WIDTH{(vertical_votes_i >> VOTE_WIDTH) != '0}};
  assign inclined_least = inclined_votes_i[VOTE_WIDTH-1:0] | {VOTE_WIDTH{(inclined_votes_i >> VOTE_WIDTH) != '0}};
  logic [ANGLES-1:0] own, against_former, against_later;
  for (genvar a = 0; a < ANGLES; a++) begin : g_angle
    localparam int THETA = 32'(ANGLE_SET[a*8 +: 8]);
    localparam bit LATER = a + 1 < ANGLES && 32'(ANGLE_SET[((a+1)%ANGLES)*8 +: 8]) - THETA <= 2;
    localparam int BASE = a * 4 * VOTE_WIDTH;
    localparam int NEXT = ((a + 1) % ANGLES) * 4 * VOTE_WIDTH;
    logic [VOTE_WIDTH-1:0] bin0, bin1, bin2;
    assign {bin2, bin1, bin0} = window[BASE +: 3*VOTE_WIDTH];
    logic older1, older2, own_q, own_d1_q;  // the older bin is at least equal
    assign older1 = bin1 >= bin0;
    assign older2 = bin2 >= bin0;
    assign own[a] = own_d1_q & older2;
    always_ff @(posedge clk_i) begin
      if (advance_o) {own_q, own_d1_q} <= {~older1 & ~older2, own_q & older1};
    end
    if (LATER) begin : g_later
      // The former angle's bins against the later one's; the former wins if equal.
      logic [VOTE_WIDTH-1:0] later0, later1, later2;
      assign {later2, later1, later0} = window[NEXT +: 3*VOTE_WIDTH];
      logic same, ahead1, ahead2, behind1, behind2;
      assign same = bin0 >= later0;
      assign ahead1 = bin1 >= later0;
      assign ahead2 = bin2 >= later0;
      assign behind1 = bin0 >= later1;
      assign behind2 = bin0 >= later2;
      logic former_q, former_d1_q, later_q, later_d1_q;
      assign against_later[a] = former_d1_q & ahead2;
      assign against_former[(a+1)%ANGLES] = later_d1_q & ~behind2;
      always_ff @(posedge clk_i) begin
        if (advance_o) begin
          {former_q, former_d1_q} <= {same & behind1 & behind2, former_q & ahead1};
          {later_q, later_d1_q} <= {~same & ~ahead1 & ~ahead2, later_q & ~behind1};
        end
      end
    end else begin : g_last
      assign against_later[a] = 1'b1;
      assign against_former[(a+1)%ANGLES] = 1'b1;
    end
    logic [VOTE_WIDTH-1:0] least_q;
    always_ff @(posedge clk_i) least_q <= vertical_i[a] ? vertical_least : inclined_least;
    assign hits[a] = own[a] && against_former[a] && against_later[a] && bin2 >= least_q;
  end

  // Lines of one bin leave one by one, the first angle first; their votes have moved on to slice 3.
  logic [11:0] hit_rho_q;
  logic [ANGLES-1:0] lowest, others;
  assign lowest = hits_q & (~hits_q + 1'b1);
  assign others = hits_q & ~lowest;
  assign line_valid_o = hits_q != '0;
  // Whether more than one is left holds up everything: found by fours, not by the chain of `others`.
  localparam int FOURS = (ANGLES + 3) / 4;
  logic [FOURS*4-1:0] padded;
  logic several, any;
  assign padded = (FOURS*4)'(hits_q);
  always_comb begin
    several = 1'b0;
    any = 1'b0;
    for (int k = 0; k < FOURS; k++) begin
      several = several | (any & (padded[k*4 +: 4] != 4'd0)) |
                (padded[k*4] & padded[k*4+1]) | (padded[k*4+2] & padded[k*4+3]) |
                ((padded[k*4] | padded[k*4+1]) & (padded[k*4+2] | padded[k*4+3]));
      any = any | (padded[k*4 +: 4] != 4'd0);
    end
  end
  assign advance_o = hits_q == '0 || (line_ready_i && !several);
  always_ff @(posedge clk_i) begin
    if (rst_i) hits_q <= '0;
    else if (advance_o) hits_q <= (state_q == Scan && step_q >= STEP_WIDTH'(4) && !last_step) ? hits : '0;
    else if (line_ready_i) hits_q <= others;
    if (advance_o) hit_rho_q <= 12'(step_q) - 12'(REACH + 4);
  end
  always_comb begin
    line_o = accelerator_pkg::line_word(1'b0, 8'd0, hit_rho_q, 11'd0);
    for (int a = 0; a < ANGLES; a++)
      if (lowest[a])
        line_o = line_o | accelerator_pkg::line_word(
            ~vertical_i[a], 8'(ANGLE_SET[a*8 +: 8] - 8'd90), 12'd0,
            11'(window[(a*4+3)*VOTE_WIDTH +: VOTE_WIDTH]));
  end
endmodule
`default_nettype wire
