// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// stream_fifo with a source that keeps to room_o but has up to LATE words on their way: nothing is
/// lost, doubled or reordered, and what is offered stays until it is taken.
module stream_fifo_formal #(
  parameter int MARGIN = 1,
  parameter int LATE = 1
) (
  input wire       clk_i,
  input wire       rst_i,
  input wire       valid_i,
  input wire [1:0] data_i,
  input wire       ready_i
);
  logic room, valid_o;
  logic [1:0] data_o;
  stream_fifo #(.WIDTH(2), .DEPTH(4), .MARGIN(MARGIN)) dut (
    .clk_i(clk_i), .rst_i(rst_i), .room_o(room), .valid_i(valid_i), .data_i(data_i),
    .valid_o(valid_o), .ready_i(ready_i), .data_o(data_o)
  );

  // Reset first; after that the source sends only while there is room, or for LATE clocks longer.
  logic started_q = 1'b0;
  logic [LATE-1:0] had_room_q = '0;
  always_ff @(posedge clk_i) begin
    started_q <= 1'b1;
    had_room_q <= rst_i ? '0 : LATE'({had_room_q, room});
  end
  always_comb begin
    assume (rst_i == !started_q);
    if (valid_i) assume (started_q && had_room_q[LATE-1]);
  end

  // Follows one word, chosen freely, by the number of words before it.
  (* anyconst *) logic [4:0] chosen;
  logic [4:0] sent_q = '0, received_q = '0;
  logic [1:0] word_q;
  logic former_valid_q = 1'b0;
  logic [1:0] former_data_q;
  always_ff @(posedge clk_i) begin
    if (!rst_i) begin
      if (valid_i) sent_q <= sent_q + 1'b1;
      if (valid_i && sent_q == chosen) word_q <= data_i;
      if (valid_o && ready_i) received_q <= received_q + 1'b1;
    end
    former_valid_q <= valid_o && !ready_i && !rst_i;
    former_data_q <= data_o;
  end
  always_comb begin
    if (started_q) begin
      assert (sent_q - received_q <= 5'd5);  // four in the memory, one at the output
      if (valid_o) assert (sent_q != received_q);
      if (valid_o && received_q == chosen && 5'(sent_q - chosen) <= 5'd5 && sent_q != chosen)
        assert (data_o == word_q);
      if (former_valid_q) assert (valid_o && data_o == former_data_q);
    end
  end
endmodule
`default_nettype wire
