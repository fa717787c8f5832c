// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// The votes of one angle: rho follows the raster by adding cos for each pixel and sin for each row,
/// exactly; each of the PPC pixels of a word has vote memories of its own, added up when read.
module angle_votes #(
  parameter int ANGLE = 90,        // theta + 90
  parameter int WIDTH = 120,
  parameter int HEIGHT = 120,
  parameter int PPC = 1,
  parameter int REACH = 86,        // rho bins run from -REACH to REACH
  parameter int VOTE_WIDTH = 8,
  parameter int BIN_WIDTH = $clog2(2 * REACH + 1)
) (
  input  wire                        clk_i,
  input  wire                        rst_i,
  input  wire                        valid_i,      // active words only
  /* verilator lint_off UNUSEDSIGNAL */  // the whole stream; which sign the gradient has is not used
  input  stream_pkg::position_t position_i,
  input  wire  [PPC*4-1:0]           edges_i,
  /* verilator lint_on UNUSEDSIGNAL */
  input  wire                        allow_i,      // this angle counts this word
  input  wire                        scan_i,       // read this bin
  input  wire                        scan_bank_i,
  input  wire  [BIN_WIDTH-1:0]       scan_bin_i,
  input  wire                        scanned_i,    // a bin has been read: else 0 comes out
  output logic [VOTE_WIDTH-1:0]      votes_o
);
  localparam int FRACTION = accelerator_pkg::FRACTION;
  localparam int TRIG = accelerator_pkg::TRIG_WIDTH;
  localparam int RHO_WIDTH = BIN_WIDTH + FRACTION;
  localparam logic signed [TRIG-1:0] COS = $signed(accelerator_pkg::COS_TABLE[ANGLE*TRIG +: TRIG]);
  localparam logic signed [TRIG-1:0] SIN = $signed(accelerator_pkg::SIN_TABLE[ANGLE*TRIG +: TRIG]);
  localparam int COSINE = 32'(COS);
  localparam int SINE = 32'(SIN);
  localparam logic [3:0] ADMIT = accelerator_pkg::ADMIT_TABLE[ANGLE*4 +: 4];
  // rho of the first pixel, from the first bin, plus half for rounding.
  localparam int FIRST_RHO = (REACH << FRACTION) + (1 << (FRACTION - 1)) -
                             (WIDTH / 2) * COSINE - (HEIGHT / 2) * SINE;

  // One step on in the line, or from its end to the beginning of the next.
  localparam int STEP = PPC * COSINE;
  localparam int LINE_STEP = SINE - (WIDTH - PPC) * COSINE;
  logic [RHO_WIDTH-1:0] rho_q;
  always_ff @(posedge clk_i) begin
    if (rst_i || (valid_i && position_i.last_row && position_i.last_word))
      rho_q <= RHO_WIDTH'(FIRST_RHO);
    else if (valid_i)
      rho_q <= rho_q + (position_i.last_word ? RHO_WIDTH'(LINE_STEP) : RHO_WIDTH'(STEP));
  end

  logic [PPC*VOTE_WIDTH-1:0] votes;
  for (genvar p = 0; p < PPC; p++) begin : g_pixel
    /* verilator lint_off UNUSEDSIGNAL */  // the fraction is rounded away
    logic [RHO_WIDTH-1:0] rho;
    /* verilator lint_on UNUSEDSIGNAL */
    assign rho = rho_q + RHO_WIDTH'(p * COSINE);
    logic vote;
    assign vote = valid_i & allow_i & edges_i[p*4+3] & ADMIT[edges_i[p*4 +: 2]];
    vote_memory #(.DEPTH(2 * REACH + 1), .VOTE_WIDTH(VOTE_WIDTH)) u_memory (
      .clk_i(clk_i), .rst_i(rst_i), .vote_i(vote), .vote_bank_i(position_i.bank),
      .vote_lane_i(1'b1), .vote_address_i(rho[FRACTION +: BIN_WIDTH]),
      .scan_i(scan_i), .scan_bank_i(scan_bank_i), .scan_address_i(scan_bin_i),
      .scan_votes_o(votes[p*VOTE_WIDTH +: VOTE_WIDTH])
    );
  end

  always_comb begin
    votes_o = '0;
    if (scanned_i)
      for (int p = 0; p < PPC; p++) votes_o = votes_o + votes[p*VOTE_WIDTH +: VOTE_WIDTH];
  end
endmodule
`default_nettype wire
