// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// Hough transform for large angle sets: BANKS memories, each shared by every BANKS-th angle, that take
/// turns with an edge pixel. Neighbouring angles are in different banks, so an edge, which votes at a
/// run of them, takes the turns of its own direction only; beyond one edge pixel in as many clocks
/// room_o falls. All angles are read side by side, as in hough_parallel.
module hough_shared #(
  parameter int WIDTH = 320,
  parameter int HEIGHT = 240,
  parameter int PPC = 1,
  parameter int ANGLES = 180,
  parameter logic [1439:0] ANGLE_SET = accelerator_pkg::FULL_SET,
  parameter int BANKS = 20,
  parameter int REACH = 201
) (
  input  wire                          clk_i,
  input  wire                          rst_i,
  /* verilator lint_off UNUSEDSIGNAL */  // the other fields are for other stages
  input  stream_pkg::parameters_t parameters0_i,
  input  stream_pkg::parameters_t parameters1_i,
  /* verilator lint_on UNUSEDSIGNAL */
  input  wire                          valid_i,
  input  stream_pkg::position_t   position_i,
  input  wire  [PPC*4-1:0]             edges_i,
  output logic                         cleared_o,
  output logic                         room_o,
  input  wire                          packet_idle_i,   // the former packet has ended
  output logic                         scan_bank_o,
  output logic                         begin_o,
  output logic                         end_o,
  output logic                         line_valid_o,
  input  wire                          line_ready_i,
  output logic [31:0]                  line_o
);
  localparam int VOTE_WIDTH = $clog2(2 * (WIDTH > HEIGHT ? WIDTH : HEIGHT) + 1);
  localparam int BIN_WIDTH = $clog2(2 * REACH + 1);
  localparam int SLOTS = (ANGLES + BANKS - 1) / BANKS;

  // The slots of any bank that admit each direction.
  logic [4*SLOTS-1:0] admitting;
  for (genvar d = 0; d < 4; d++) begin : g_direction
    for (genvar s = 0; s < SLOTS; s++) begin : g_slot
      logic [BANKS-1:0] admits;
      for (genvar m = 0; m < BANKS; m++) begin : g_angle
        if (s * BANKS + m < ANGLES)
          assign admits[m] = accelerator_pkg::ADMIT_TABLE[32'(ANGLE_SET[(s*BANKS+m)*8 +: 8])*4 + d];
        else assign admits[m] = 1'b0;
      end
      assign admitting[d*SLOTS+s] = admits != '0;
    end
  end

  logic pixel_valid, pixel_bank, row_counts, complete, complete_bank;
  logic [1:0] direction;
  logic signed [11:0] x, y;
  logic [SLOTS-1:0] slot;
  edge_queue #(.WIDTH(WIDTH), .HEIGHT(HEIGHT), .PPC(PPC), .SLOTS(SLOTS)) u_queue (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid_i), .position_i(position_i), .edges_i(edges_i),
    .first_row_i(position_i.bank ? parameters1_i.first_row : parameters0_i.first_row),
    .admitting_i(admitting), .room_o(room_o), .valid_o(pixel_valid), .bank_o(pixel_bank),
    .row_counts_o(row_counts), .direction_o(direction), .x_o(x), .y_o(y), .slot_o(slot),
    .complete_o(complete), .complete_bank_o(complete_bank)
  );

  logic [ANGLES-1:0] vertical0, vertical1, vertical, enable, scan_vertical_q;
  angle_classes #(.ANGLES(ANGLES), .ANGLE_SET(ANGLE_SET)) u_classes (
    .clk_i(clk_i), .rst_i(rst_i), .verticals0_i({parameters0_i.vertical_to, parameters0_i.vertical_from}),
    .verticals1_i({parameters1_i.vertical_to, parameters1_i.vertical_from}),
    .vertical0_o(vertical0), .vertical1_o(vertical1)
  );
  assign vertical = pixel_bank ? vertical1 : vertical0;
  assign enable = pixel_bank ? parameters1_i.enable[ANGLES-1:0] : parameters0_i.enable[ANGLES-1:0];
  always_ff @(posedge clk_i) scan_vertical_q <= scan_bank_o ? vertical1 : vertical0;

  logic scan, scanned;
  logic [BIN_WIDTH-1:0] scan_bin;
  /* verilator lint_off UNUSEDSIGNAL */  // the last slot may be empty
  logic [BANKS*SLOTS*VOTE_WIDTH-1:0] bank_votes;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [ANGLES*VOTE_WIDTH-1:0] votes;
  always_comb begin
    votes = '0;
    if (scanned)
      for (int a = 0; a < ANGLES; a++)
        votes[a*VOTE_WIDTH +: VOTE_WIDTH] = bank_votes[((a%BANKS)*SLOTS+a/BANKS)*VOTE_WIDTH +: VOTE_WIDTH];
  end
  for (genvar m = 0; m < BANKS; m++) begin : g_bank
    logic [SLOTS-1:0] allow;
    always_comb begin
      allow = '0;
      if (pixel_valid)
        for (int s = 0; s < SLOTS; s++)
          allow[s] = s * BANKS + m < ANGLES && enable[(s*BANKS+m)%ANGLES] &&
                     (row_counts || vertical[(s*BANKS+m)%ANGLES]);
    end
    angle_votes_shared #(
      .FIRST(m), .STRIDE(BANKS), .ANGLES(ANGLES), .ANGLE_SET(ANGLE_SET), .SLOTS(SLOTS), .REACH(REACH),
      .VOTE_WIDTH(VOTE_WIDTH)
    ) u_votes (
      .clk_i(clk_i), .rst_i(rst_i), .allow_i(allow), .valid_i(pixel_valid),
      .bank_i(pixel_bank), .direction_i(direction),
      .x_i(x), .y_i(y), .slot_i(slot), .scan_i(scan), .scan_bank_i(scan_bank_o),
      .scan_bin_i(scan_bin), .votes_o(bank_votes[m*SLOTS*VOTE_WIDTH +: SLOTS*VOTE_WIDTH])
    );
  end

  // A pixel votes three clocks after it has left the queue, its vote is written two clocks later, as
  // peak_scan takes up the request; it reads in the next clock.
  logic [3:0] complete_q, complete_bank_q;
  always_ff @(posedge clk_i) begin
    complete_bank_q <= {complete_bank_q[2:0], complete_bank};
    if (rst_i) complete_q <= '0;
    else complete_q <= {complete_q[2:0], complete};
  end

  peak_scan #(
    .ANGLES(ANGLES), .ANGLE_SET(ANGLE_SET), .REACH(REACH), .VOTE_WIDTH(VOTE_WIDTH)
  ) u_scan (
    .clk_i(clk_i), .rst_i(rst_i), .cleared_o(cleared_o), .request_i(complete_q[3]),
    .request_bank_i(complete_bank_q[3]), .packet_idle_i(packet_idle_i), .vertical_i(scan_vertical_q),
    .vertical_votes_i(scan_bank_o ? parameters1_i.vertical_votes : parameters0_i.vertical_votes),
    .inclined_votes_i(scan_bank_o ? parameters1_i.inclined_votes : parameters0_i.inclined_votes),
    .scan_o(scan), .scan_bank_o(scan_bank_o), .scan_bin_o(scan_bin), .scanned_o(scanned),
    .votes_i(votes),
    .begin_o(begin_o), .end_o(end_o), .line_valid_o(line_valid_o), .line_ready_i(line_ready_i),
    .line_o(line_o)
  );
endmodule
`default_nettype wire
