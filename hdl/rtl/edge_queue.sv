// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// Picks the edges out of the raster: words with edges wait in a queue and leave pixel by pixel, each
/// held for SLOTS clocks; the end of a frame comes out in its place.
module edge_queue #(
  parameter int WIDTH = 320,
  parameter int HEIGHT = 240,
  parameter int PPC = 1,
  parameter int SLOTS = 9,
  parameter int SLOT_WIDTH = $clog2(SLOTS + 1)
) (
  input  wire                        clk_i,
  input  wire                        rst_i,
  input  wire                        valid_i,
  input  stream_pkg::position_t position_i,
  /* verilator lint_off UNUSEDSIGNAL */  // which sign the gradient has does not matter to lines
  input  wire  [PPC*4-1:0]           edges_i,
  /* verilator lint_on UNUSEDSIGNAL */
  input  wire  [15:0]                first_row_i,   // of the bank in position_i
  output logic                       room_o,
  output logic                       valid_o,
  output logic                       bank_o,
  output logic                       row_counts_o,
  output logic [1:0]                 direction_o,
  output logic signed [11:0]         x_o,
  output logic signed [11:0]         y_o,
  output logic [SLOT_WIDTH-1:0]      slot_o,
  output logic                       complete_o,      // the frame's last pixel has left
  output logic                       complete_bank_o
);
  localparam int PIXELS = PPC * 3;
  localparam int ENTRY = 3 + 24 + PIXELS;
  logic [10:0] word_q;
  logic [11:0] row_q, row;
  assign row = position_i.first_row ? 12'd0 : row_q;
  logic [PIXELS-1:0] pixels;
  logic any;
  always_comb begin
    any = 1'b0;
    for (int p = 0; p < PPC; p++) begin
      pixels[p*3 +: 3] = {edges_i[p*4+3], edges_i[p*4 +: 2]};
      any = any | edges_i[p*4+3];
    end
  end
  logic push_q, active;
  logic [ENTRY-1:0] push_entry_q;
  assign active = valid_i && position_i.active;
  always_ff @(posedge clk_i) begin
    if (active) begin
      word_q <= position_i.last_word ? '0 : (position_i.first_word ? 11'd1 : word_q + 1'b1);
      row_q <= position_i.last_word ? row + 1'b1 : row;
    end
    push_q <= active && !rst_i && (any || (position_i.last_row && position_i.last_word));
    push_entry_q <= {position_i.last_row && position_i.last_word, position_i.bank,
                     {4'd0, row} >= first_row_i,
                     12'((position_i.first_word ? 0 : 32'(word_q)) * PPC - WIDTH / 2),
                     row - 12'(HEIGHT / 2), pixels};
  end

  logic entry_valid, entry_ready;
  logic [ENTRY-1:0] entry;
  stream_fifo #(.WIDTH(ENTRY), .DEPTH(256), .MARGIN(112)) u_fifo (
    .clk_i(clk_i), .rst_i(rst_i), .room_o(room_o), .valid_i(push_q), .data_i(push_entry_q),
    .valid_o(entry_valid), .ready_i(entry_ready), .data_o(entry)
  );

  // The pixels of the entry that still have to go; the first goes now.
  logic begun_q;
  logic [PPC-1:0] edge_bits, left_q, left, lowest, others;
  logic [SLOT_WIDTH-1:0] slot_q;
  logic last_slot;
  always_comb begin
    for (int p = 0; p < PPC; p++) edge_bits[p] = entry[p*3+2];
  end
  assign left = begun_q ? left_q : edge_bits;
  assign lowest = left & (~left + 1'b1);
  assign others = left & ~lowest;
  assign last_slot = slot_q == SLOT_WIDTH'(SLOTS - 1);
  assign entry_ready = entry_valid && (left == '0 || (others == '0 && last_slot));
  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      begun_q <= 1'b0;
      slot_q <= '0;
    end else if (entry_valid) begin
      begun_q <= !entry_ready;
      slot_q <= last_slot || left == '0 ? '0 : slot_q + 1'b1;
    end
    left_q <= last_slot ? others : left;
    valid_o <= entry_valid && left != '0 && !rst_i;
    slot_o <= slot_q;
    bank_o <= entry[ENTRY-2];
    row_counts_o <= entry[ENTRY-3];
    y_o <= entry[PIXELS +: 12];
    x_o <= entry[PIXELS+12 +: 12];
    direction_o <= '0;
    for (int p = 0; p < PPC; p++)
      if (lowest[p]) begin
        direction_o <= entry[p*3 +: 2];
        x_o <= entry[PIXELS+12 +: 12] + 12'(p);
      end
    complete_o <= entry_ready && entry[ENTRY-1] && !rst_i;
    complete_bank_o <= entry[ENTRY-2];
  end
endmodule
`default_nettype wire
