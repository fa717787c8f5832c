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
  output logic                         scan_o,
  output logic                         scan_bank_o,
  output logic [BIN_WIDTH-1:0]         scan_bin_o,
  output logic                         scanned_o,      // the former step has read a bin
  input  wire  [ANGLES*VOTE_WIDTH-1:0] votes_i,        // of that bin, else 0
  output logic                         begin_o,        // a frame's scan begins
  output logic                         end_o,          // and has ended, all lines taken
  output logic                         line_valid_o,
  input  wire                          line_ready_i,
  output logic [31:0]                  line_o
);
  localparam int BINS = 2 * REACH + 1;
  // Step i reads bin i; the first and the last bin are out of any pixel's reach and left out. A bin is
  // decided four steps after its read, and its lines leave from the step behind that on.
  localparam int STEPS = BINS + 3;
  localparam int DECIDED = 4;
  localparam int STEP_WIDTH = $clog2(STEPS + 1);

  typedef enum logic [1:0] {ClearFirst, ClearSecond, Idle, Scan} state_e;
  state_e state_q;
  logic [STEP_WIDTH-1:0] step_q;
  logic pending_q, pending_bank_q, bank_q, last_step;
  logic [ANGLES-1:0] hits_q;
  logic advance;  // a step
  assign last_step = step_q == STEP_WIDTH'(STEPS);
  assign cleared_o = state_q == Idle || state_q == Scan;
  assign begin_o = state_q == Idle && pending_q && packet_idle_i;
  assign end_o = state_q == Scan && last_step && hits_q == '0;
  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      state_q <= ClearFirst;
      step_q <= STEP_WIDTH'(1);
      bank_q <= 1'b0;
      pending_q <= 1'b0;
      pending_bank_q <= 1'b0;
    end else begin
      if (request_i) pending_bank_q <= request_bank_i;
      pending_q <= request_i | (pending_q & ~begin_o);
      if (state_q == Idle) step_q <= STEP_WIDTH'(1);
      else if (advance && !last_step) step_q <= step_q + 1'b1;
      unique case (state_q)
        ClearFirst: if (last_step) begin
          state_q <= ClearSecond;
          step_q <= STEP_WIDTH'(1);
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
  assign scan_o = advance && state_q != Idle && step_q < STEP_WIDTH'(BINS - 1);
  assign scan_bank_o = bank_q;
  assign scan_bin_o = step_q[BIN_WIDTH-1:0];

  // The last bins of each angle: bin0_q the newest (bin step - 2), bin2_q the one that is decided.
  logic shifts, decides;
  assign shifts = advance && state_q == Scan;
  assign scanned_o = state_q == Scan && step_q != STEP_WIDTH'(1) && step_q < STEP_WIDTH'(BINS);
  assign decides = state_q == Scan && step_q > STEP_WIDTH'(DECIDED) && !last_step;
  for (genvar a = 0; a < ANGLES; a++) begin : g_bins
    logic [VOTE_WIDTH-1:0] bin0_q, bin1_q, bin2_q;
    always_ff @(posedge clk_i) begin
      if (state_q != Scan) {bin2_q, bin1_q} <= '0;
      else if (advance) {bin2_q, bin1_q} <= {bin1_q, bin0_q};
      if (advance) bin0_q <= votes_i[a*VOTE_WIDTH +: VOTE_WIDTH];
    end
  end

  // Each pair of bins is compared once, when the newer one arrives; a bin's chances go along with it
  // until it is in bin2_q. Between equal bins the former angle and the former bin win.
  // What does not fit is all ones, which is more votes than there can be.
  logic [VOTE_WIDTH-1:0] vertical_least, inclined_least;
  assign vertical_least = vertical_votes_i[VOTE_WIDTH-1:0] | {VOTE_WIDTH{(vertical_votes_i >> VOTE_WIDTH) != '0}};
  assign inclined_least = inclined_votes_i[VOTE_WIDTH-1:0] | {VOTE_WIDTH{(inclined_votes_i >> VOTE_WIDTH) != '0}};
  for (genvar a = 0; a <= ANGLES; a++) begin : g_between  // angle a - 1 and angle a
    /* verilator lint_off UNUSEDSIGNAL */  // of strangers only the last ones are looked at
    logic former_q, former_d1_q, later_q, later_d1_q;     // the chances of the one, the other
    /* verilator lint_on UNUSEDSIGNAL */
    if (a > 0 && a < ANGLES && 32'(ANGLE_SET[(a%ANGLES)*8 +: 8]) - 32'(ANGLE_SET[((a+ANGLES-1)%ANGLES)*8 +: 8]) <= 2)
    begin : g_neighbours
      always_ff @(posedge clk_i) begin
        if (shifts) begin
          former_q <= g_bins[a-1].bin0_q >= g_bins[a].bin0_q && g_bins[a-1].bin0_q >= g_bins[a].bin1_q &&
                      g_bins[a-1].bin0_q >= g_bins[a].bin2_q;
          former_d1_q <= former_q && g_bins[a-1].bin1_q >= g_bins[a].bin0_q;
          later_q <= !(g_bins[a-1].bin0_q >= g_bins[a].bin0_q) && !(g_bins[a-1].bin1_q >= g_bins[a].bin0_q) &&
                     !(g_bins[a-1].bin2_q >= g_bins[a].bin0_q);
          later_d1_q <= later_q && !(g_bins[a-1].bin0_q >= g_bins[a].bin1_q);
        end
      end
    end else begin : g_strangers
      assign {former_q, former_d1_q, later_q, later_d1_q} = '1;
    end
  end
  logic [ANGLES-1:0] lowest, others;
  logic [ANGLES*VOTE_WIDTH-1:0] votes_q;  // of the bins that fire
  for (genvar a = 0; a < ANGLES; a++) begin : g_angle
    localparam bit FORMER = a > 0 && 32'(ANGLE_SET[a*8 +: 8]) - 32'(ANGLE_SET[((a+ANGLES-1)%ANGLES)*8 +: 8]) <= 2;
    localparam bit LATER = a + 1 < ANGLES && 32'(ANGLE_SET[((a+1)%ANGLES)*8 +: 8]) - 32'(ANGLE_SET[a*8 +: 8]) <= 2;
    logic own_q, own_d1_q;
    logic [VOTE_WIDTH-1:0] least_q;
    always_ff @(posedge clk_i) begin
      if (shifts) begin
        own_q <= !(g_bins[a].bin1_q >= g_bins[a].bin0_q) && !(g_bins[a].bin2_q >= g_bins[a].bin0_q);
        own_d1_q <= own_q && g_bins[a].bin1_q >= g_bins[a].bin0_q;
        least_q <= vertical_i[a] ? vertical_least : inclined_least;
        votes_q[a*VOTE_WIDTH +: VOTE_WIDTH] <= g_bins[a].bin2_q;
      end
      if (rst_i) hits_q[a] <= 1'b0;
      else if (advance) begin
        hits_q[a] <= 1'b0;
        if (decides)
          hits_q[a] <= own_d1_q && g_bins[a].bin2_q >= g_bins[a].bin0_q && g_bins[a].bin2_q >= least_q &&
                       g_between[a].later_d1_q && g_between[a+1].former_d1_q &&
                       !(FORMER && g_bins[(a+ANGLES-1)%ANGLES].bin0_q >= g_bins[a].bin2_q) &&
                       !(LATER && g_bins[(a+1)%ANGLES].bin0_q > g_bins[a].bin2_q);
      end else if (line_ready_i) hits_q[a] <= others[a];
    end
  end

  // Lines of one bin leave one by one, the first angle first.
  logic [11:0] hit_rho_q;
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
  assign advance = hits_q == '0 || (line_ready_i && !several);
  always_ff @(posedge clk_i) begin
    if (advance) hit_rho_q <= 12'(step_q) - 12'(REACH + DECIDED);
  end
  always_comb begin
    line_o = accelerator_pkg::line_word(1'b0, 8'd0, hit_rho_q, 11'd0);
    if (ANGLES < 32 || line_valid_o)  // a simulation need not look for it in every clock
      for (int a = 0; a < ANGLES; a++)
        if (lowest[a])
          line_o = line_o | accelerator_pkg::line_word(
              ~vertical_i[a], 8'(ANGLE_SET[a*8 +: 8] - 8'd90), 12'd0, 11'(votes_q[a*VOTE_WIDTH +: VOTE_WIDTH]));
  end
endmodule
`default_nettype wire
