// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// Hough transform for large angle sets: BANKS memories, each shared by consecutive angles that take
/// turns with every edge pixel. Keeps up with one edge pixel in SLOTS clocks (room_o falls beyond
/// that); lines come out after all angles' bins have been read, one in each clock.
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
  localparam int BINS = 2 * REACH + 1;
  localparam int SLOTS = (ANGLES + BANKS - 1) / BANKS;
  localparam int SLOT_WIDTH = $clog2(SLOTS + 1);
  localparam int DEPTH = SLOTS * BINS;
  localparam int ADDRESS_WIDTH = $clog2(DEPTH);
  localparam int BANK_WIDTH = $clog2(BANKS + 1);

  logic pixel_valid, pixel_bank, row_counts, complete, complete_bank;
  logic [1:0] direction;
  logic signed [11:0] x, y;
  logic [SLOT_WIDTH-1:0] slot;
  edge_queue #(.WIDTH(WIDTH), .HEIGHT(HEIGHT), .PPC(PPC), .SLOTS(SLOTS)) u_queue (
    .clk_i(clk_i), .rst_i(rst_i), .valid_i(valid_i), .position_i(position_i), .edges_i(edges_i),
    .first_row_i(position_i.bank ? parameters1_i.first_row : parameters0_i.first_row),
    .room_o(room_o), .valid_o(pixel_valid), .bank_o(pixel_bank), .row_counts_o(row_counts),
    .direction_o(direction), .x_o(x), .y_o(y), .slot_o(slot), .complete_o(complete),
    .complete_bank_o(complete_bank)
  );

  // The scan: clear both roles of all memories after a reset, then a raster for each frame.
  typedef enum logic [2:0] {ClearFirst, ClearSecond, Idle, Rows, Flush, Drain} state_e;
  state_e state_q;
  logic [ADDRESS_WIDTH-1:0] address_q;
  logic [BANK_WIDTH-1:0] memory_q;
  logic [SLOT_WIDTH-1:0] scan_slot_q;
  logic [7:0] angle_q;
  logic [$clog2(BINS)-1:0] bin_q;
  logic [4:0] drain_q;
  logic pending_q, pending_bank_q, lines_room, last_bin, last_angle, steps;
  logic [5:0] complete_q, complete_bank_q;
  assign last_bin = 32'(bin_q) == BINS - 1;
  assign last_angle = 32'(angle_q) == ANGLES - 1;
  assign steps = (state_q == Rows || state_q == Flush) && lines_room;
  assign cleared_o = state_q != ClearFirst && state_q != ClearSecond;
  assign begin_o = state_q == Idle && pending_q && packet_idle_i;
  assign end_o = state_q == Drain && drain_q == '1 && !line_valid_o;
  always_ff @(posedge clk_i) begin
    complete_bank_q <= {complete_bank_q[4:0], complete_bank};
    if (rst_i) begin
      state_q <= ClearFirst;
      address_q <= '0;
      scan_bank_o <= 1'b0;
      {pending_q, pending_bank_q} <= '0;
      complete_q <= '0;
      {memory_q, scan_slot_q, angle_q, bin_q, drain_q} <= '0;
    end else begin
      complete_q <= {complete_q[4:0], complete};
      if (complete_q[5]) pending_bank_q <= complete_bank_q[5];
      pending_q <= complete_q[5] | (pending_q & ~begin_o);
      drain_q <= state_q == Drain ? drain_q + 5'(drain_q != '1) : '0;
      unique case (state_q)
        ClearFirst, ClearSecond: begin
          address_q <= 32'(address_q) == DEPTH - 1 ? '0 : address_q + 1'b1;
          if (32'(address_q) == DEPTH - 1) begin
            scan_bank_o <= 1'b1;
            state_q <= state_q == ClearFirst ? ClearSecond : Idle;
          end
        end
        Idle: begin
          {memory_q, scan_slot_q, angle_q, bin_q, address_q} <= '0;
          if (begin_o) begin
            scan_bank_o <= pending_bank_q;
            state_q <= Rows;
          end
        end
        Rows: if (steps) begin
          bin_q <= last_bin ? '0 : bin_q + 1'b1;
          address_q <= address_q + 1'b1;
          if (last_bin) begin
            angle_q <= last_angle ? '0 : angle_q + 1'b1;
            scan_slot_q <= scan_slot_q + 1'b1;
            if (32'(scan_slot_q) == SLOTS - 1) begin
              {scan_slot_q, address_q} <= '0;
              memory_q <= memory_q + 1'b1;
            end
            if (last_angle) state_q <= Flush;
          end
        end
        Flush: if (steps) begin  // two blank rows bring the last angle out
          bin_q <= last_bin ? '0 : bin_q + 1'b1;
          if (last_bin) angle_q <= 8'd1;
          if (last_bin && angle_q == 8'd1) state_q <= Drain;
        end
        default: if (end_o) state_q <= Idle;
      endcase
    end
  end

  logic [BANKS*VOTE_WIDTH-1:0] votes;
  for (genvar m = 0; m < BANKS; m++) begin : g_bank
    logic [2*SLOTS-1:0] allow_q;
    for (genvar s = 0; s < SLOTS; s++) begin : g_slot
      if (m * SLOTS + s < ANGLES) begin : g_used
        localparam logic signed [7:0] THETA = $signed(ANGLE_SET[(m*SLOTS+s)*8 +: 8] - 8'd90);
        logic vertical, enable;
        assign vertical = pixel_bank ? THETA >= $signed(parameters1_i.vertical_from) &&
                                       THETA <= $signed(parameters1_i.vertical_to)
                                     : THETA >= $signed(parameters0_i.vertical_from) &&
                                       THETA <= $signed(parameters0_i.vertical_to);
        assign enable = pixel_bank ? parameters1_i.enable[m*SLOTS+s] : parameters0_i.enable[m*SLOTS+s];
        always_ff @(posedge clk_i) allow_q[s*2 +: 2] <= {enable & vertical, enable};
      end else begin : g_unused
        assign allow_q[s*2 +: 2] = 2'b00;
      end
    end
    // One register beside the choice of the frame's parameters.
    logic valid_q, bank_q, row_counts_q;
    logic [1:0] direction_q;
    logic signed [11:0] x_q, y_q;
    logic [SLOT_WIDTH-1:0] slot_q;
    always_ff @(posedge clk_i) begin
      {valid_q, bank_q, row_counts_q} <= {pixel_valid & ~rst_i, pixel_bank, row_counts};
      {direction_q, x_q, y_q, slot_q} <= {direction, x, y, slot};
    end
    angle_votes_shared #(
      .FIRST(m * SLOTS), .ANGLES(ANGLES), .ANGLE_SET(ANGLE_SET), .SLOTS(SLOTS), .REACH(REACH),
      .VOTE_WIDTH(VOTE_WIDTH)
    ) u_votes (
      .clk_i(clk_i), .rst_i(rst_i), .allow_i(allow_q), .valid_i(valid_q), .bank_i(bank_q),
      .row_counts_i(row_counts_q), .direction_i(direction_q), .x_i(x_q), .y_i(y_q), .slot_i(slot_q),
      .scan_i(!cleared_o || (steps && state_q == Rows && memory_q == BANK_WIDTH'(m))),
      .scan_bank_i(scan_bank_o), .scan_address_i(address_q),
      .votes_o(votes[m*VOTE_WIDTH +: VOTE_WIDTH])
    );
  end

  logic raster_valid_q;
  stream_pkg::position_t raster_position_q;
  logic [BANK_WIDTH-1:0] memory_d1_q;
  logic [VOTE_WIDTH-1:0] raster_votes;
  always_ff @(posedge clk_i) begin
    raster_valid_q <= steps && !rst_i;
    memory_d1_q <= memory_q;
    raster_position_q.active <= state_q == Rows;
    raster_position_q.bank <= 1'b0;
    raster_position_q.first_row <= state_q == Rows && angle_q == '0;
    raster_position_q.last_row <= state_q == Rows && last_angle;
    raster_position_q.first_word <= bin_q == '0;
    raster_position_q.last_word <= last_bin;
  end
  always_comb begin
    raster_votes = '0;
    for (int m = 0; m < BANKS; m++)
      if (memory_d1_q == BANK_WIDTH'(m)) raster_votes = votes[m*VOTE_WIDTH +: VOTE_WIDTH];
  end
  raster_scan #(
    .ANGLES(ANGLES), .ANGLE_SET(ANGLE_SET), .REACH(REACH), .VOTE_WIDTH(VOTE_WIDTH)
  ) u_scan (
    .clk_i(clk_i), .rst_i(rst_i),
    .vertical_from_i(scan_bank_o ? parameters1_i.vertical_from : parameters0_i.vertical_from),
    .vertical_to_i(scan_bank_o ? parameters1_i.vertical_to : parameters0_i.vertical_to),
    .vertical_votes_i(scan_bank_o ? parameters1_i.vertical_votes : parameters0_i.vertical_votes),
    .inclined_votes_i(scan_bank_o ? parameters1_i.inclined_votes : parameters0_i.inclined_votes),
    .valid_i(raster_valid_q), .position_i(raster_position_q), .votes_i(raster_votes),
    .room_o(lines_room), .line_valid_o(line_valid_o), .line_ready_i(line_ready_i), .line_o(line_o)
  );
endmodule
`default_nettype wire
