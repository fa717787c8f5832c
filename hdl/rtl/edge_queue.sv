// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// Picks the edges out of the raster: words with edges wait in a queue and leave pixel by pixel, each
/// once for every slot that admits its direction; the end of a frame comes out in its place.
module edge_queue #(
  parameter int WIDTH = 320,
  parameter int HEIGHT = 240,
  parameter int PPC = 1,
  parameter int SLOTS = 9
) (
  input  wire                        clk_i,
  input  wire                        rst_i,
  input  wire                        valid_i,
  input  stream_pkg::position_t position_i,
  /* verilator lint_off UNUSEDSIGNAL */  // which sign the gradient has does not matter to lines
  input  wire  [PPC*4-1:0]           edges_i,
  /* verilator lint_on UNUSEDSIGNAL */
  input  wire  [15:0]                first_row_i,       // of the bank in position_i
  input  wire  [4*SLOTS-1:0]         admitting_i,       // the slots that admit each direction, a constant
  output logic                       room_o,
  output logic                       valid_o,
  output logic                       bank_o,
  output logic                       row_counts_o,
  output logic [1:0]                 direction_o,
  output logic signed [11:0]         x_o,
  output logic signed [11:0]         y_o,
  output logic [SLOTS-1:0]           slot_o,            // one bit
  output logic                       complete_o,        // the frame's last pixel leaves with this or has left
  output logic                       complete_bank_o
);
  localparam int PIXELS = PPC * 3;
  localparam int ENTRY = 3 + 24 + PIXELS;
  logic [10:0] word_q;
  logic [11:0] row_q, row;
  assign row = position_i.first_row ? 12'd0 : row_q;
  logic [3:0] admitted;  // directions that vote at all
  logic [PIXELS-1:0] pixels;
  logic any;
  always_comb begin
    for (int d = 0; d < 4; d++) admitted[d] = admitting_i[d*SLOTS +: SLOTS] != '0;
    any = 1'b0;
    for (int p = 0; p < PPC; p++) begin
      pixels[p*3 +: 3] = {edges_i[p*4+3] & admitted[edges_i[p*4 +: 2]], edges_i[p*4 +: 2]};
      any = any | pixels[p*3+2];
    end
  end
  logic active, last;
  assign active = valid_i && position_i.active;
  assign last = position_i.last_row && position_i.last_word;
  always_ff @(posedge clk_i) begin
    if (active) begin
      word_q <= position_i.last_word ? '0 : (position_i.first_word ? 11'd1 : word_q + 1'b1);
      row_q <= position_i.last_word ? row + 1'b1 : row;
    end
  end

  logic entry_valid, entry_ready;
  logic [ENTRY-1:0] entry;
  stream_fifo #(.WIDTH(ENTRY), .DEPTH(256), .MARGIN(112)) u_fifo (
    .clk_i(clk_i), .rst_i(rst_i), .room_o(room_o), .valid_i(active && (any || last)),
    .data_i({last, position_i.bank, {4'd0, row} >= first_row_i,
             12'((position_i.first_word ? 0 : 32'(word_q)) * PPC - WIDTH / 2), row - 12'(HEIGHT / 2), pixels}),
    .valid_o(entry_valid), .ready_i(entry_ready), .data_o(entry)
  );

  // The pixels of the entry that still have to go, and the slots of the first of them.
  logic begun_q, slot_begun_q;
  logic [PPC-1:0] edge_bits, left_q, left, lowest, others;
  logic [SLOTS-1:0] slots_q, slots, slot;
  logic [1:0] direction;
  logic [11:0] place;  // in the word
  logic last_slot;
  always_comb begin
    direction = '0;
    place = '0;
    for (int p = 0; p < PPC; p++) begin
      edge_bits[p] = entry[p*3+2];
      if (lowest[p]) begin
        direction = entry[p*3 +: 2];
        place = 12'(p);
      end
    end
    slots = '0;
    for (int d = 0; d < 4; d++)
      if (direction == 2'(d)) slots = admitting_i[d*SLOTS +: SLOTS];
    if (slot_begun_q) slots = slots_q;
  end
  assign left = begun_q ? left_q : edge_bits;
  assign lowest = left & (~left + 1'b1);
  assign others = left & ~lowest;
  assign slot = slots & (~slots + 1'b1);
  assign last_slot = slots == slot;
  assign entry_ready = entry_valid && (left == '0 || (others == '0 && last_slot));
  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      {begun_q, slot_begun_q} <= '0;
    end else if (entry_valid) begin
      begun_q <= !entry_ready;
      slot_begun_q <= left != '0 && !last_slot;
    end
    left_q <= last_slot ? others : left;
    slots_q <= slots & ~slot;
    valid_o <= entry_valid && left != '0 && !rst_i;
    slot_o <= slot;
    bank_o <= entry[ENTRY-2];
    row_counts_o <= entry[ENTRY-3];
    y_o <= entry[PIXELS +: 12];
    x_o <= entry[PIXELS+12 +: 12] + place;
    direction_o <= direction;
    complete_o <= entry_ready && entry[ENTRY-1] && !rst_i;
    complete_bank_o <= entry[ENTRY-2];
  end
endmodule
`default_nettype wire
