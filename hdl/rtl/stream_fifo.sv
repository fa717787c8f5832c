// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// A queue. There is no ready on the way in: the source must watch room_o, which says that MARGIN
/// more may come after it has fallen.
module stream_fifo #(
  parameter int WIDTH = 8,
  parameter int DEPTH = 64,   // a power of two
  parameter int MARGIN = 16
) (
  input  wire              clk_i,
  input  wire              rst_i,
  output logic             room_o,
  input  wire              valid_i,
  input  wire  [WIDTH-1:0] data_i,
  output logic             valid_o,
  input  wire              ready_i,
  output logic [WIDTH-1:0] data_o
);
  localparam int POINTER_WIDTH = $clog2(DEPTH);
  (* ram_style = "block", no_rw_check *)
  logic [WIDTH-1:0] memory [DEPTH];
  logic [POINTER_WIDTH-1:0] read_q, write_q;
  logic [POINTER_WIDTH:0] count_q;
  logic take;
  assign take = count_q != '0 && (!valid_o || ready_i);
  always_ff @(posedge clk_i) begin
    if (valid_i) memory[write_q] <= data_i;
    if (take) data_o <= memory[read_q];
  end
  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      read_q <= '0;
      write_q <= '0;
      count_q <= '0;
      valid_o <= 1'b0;
      room_o <= 1'b0;
    end else begin
      if (valid_i) write_q <= write_q + 1'b1;
      if (take) read_q <= read_q + 1'b1;
      count_q <= count_q + (POINTER_WIDTH+1)'(valid_i) - (POINTER_WIDTH+1)'(take);
      valid_o <= take | (valid_o & ~ready_i);
      room_o <= count_q < (POINTER_WIDTH+1)'(DEPTH - MARGIN - 2);
    end
  end
endmodule
`default_nettype wire
