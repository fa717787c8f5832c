// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// The operators of one pixel: columns of three rows (upper row lowest) in, {sector, magnitude} six
/// clocks later.
module operators (
  input  wire         clk_i,
  input  wire  [23:0] left_i,
  /* verilator lint_off UNUSEDSIGNAL */  // no operator weighs the middle pixel
  input  wire  [23:0] middle_i,
  /* verilator lint_on UNUSEDSIGNAL */
  input  wire  [23:0] right_i,
  output logic [12:0] gradient_o
);
  // Nine pixels: a b c over d e f over g h i.
  logic [8:0] a, b, c, d, f, g, h, i;
  assign {g, d, a} = {1'b0, left_i[23:16], 1'b0, left_i[15:8], 1'b0, left_i[7:0]};
  assign {h, b} = {1'b0, middle_i[23:16], 1'b0, middle_i[7:0]};
  assign {i, f, c} = {1'b0, right_i[23:16], 1'b0, right_i[15:8], 1'b0, right_i[7:0]};

  // By direction: 0 along u, 1 along u+v, 2 along v, 3 along v-u. Directions 0 and 1 share
  // (f + i) - (a + d) and differ by c - g or h - b; 2 and 3 share (g + h) - (b + c) and differ by
  // i - a or d - f.
  logic [8:0] fi_q, ad_q, gh_q, bc_q;
  logic [35:0] single_q, single_d1_q;
  logic [9:0] shared01_q, shared23_q;
  logic [43:0] difference_q;
  logic [39:0] size_q;
  logic [3:0] negative_q;
  always_ff @(posedge clk_i) begin
    fi_q <= f + i;
    ad_q <= a + d;
    gh_q <= g + h;
    bc_q <= b + c;
    single_q <= {d - f, i - a, h - b, c - g};
    shared01_q <= {1'b0, fi_q} - {1'b0, ad_q};
    shared23_q <= {1'b0, gh_q} - {1'b0, bc_q};
    single_d1_q <= single_q;
    for (int k = 0; k < 4; k++) begin
      difference_q[k*11 +: 11] <= (k < 2 ? {shared01_q[9], shared01_q} : {shared23_q[9], shared23_q}) +
                                  {{2{single_d1_q[k*9+8]}}, single_d1_q[k*9 +: 9]};
      size_q[k*10 +: 10] <= difference_q[k*11+10] ? 10'd0 - difference_q[k*11 +: 10]
                                                  : difference_q[k*11 +: 10];
      negative_q[k] <= difference_q[k*11+10];
    end
  end

  // The largest; of equal ones 0 before 2 before 1 before 3.
  logic [9:0] axis_size_q, diagonal_size_q;
  // Compared by the sign of a difference, which is the end of a carry chain; `>` takes a table more.
  logic axis, diagonal, across;
  /* verilator lint_off UNUSEDSIGNAL */  // only the signs
  logic [10:0] axis_margin, diagonal_margin, margin;
  /* verilator lint_on UNUSEDSIGNAL */
  assign axis_margin = {1'b0, size_q[0 +: 10]} - {1'b0, size_q[20 +: 10]};
  assign diagonal_margin = {1'b0, size_q[10 +: 10]} - {1'b0, size_q[30 +: 10]};
  assign margin = {1'b0, axis_size_q} - {1'b0, diagonal_size_q};
  assign {axis, diagonal, across} = {axis_margin[10], diagonal_margin[10], margin[10]};
  logic axis_q, diagonal_q, axis_negative_q, diagonal_negative_q;
  always_ff @(posedge clk_i) begin
    axis_q <= axis;
    axis_size_q <= axis ? size_q[20 +: 10] : size_q[0 +: 10];
    axis_negative_q <= axis ? negative_q[2] : negative_q[0];
    diagonal_q <= diagonal;
    diagonal_size_q <= diagonal ? size_q[30 +: 10] : size_q[10 +: 10];
    diagonal_negative_q <= diagonal ? negative_q[3] : negative_q[1];
    if (across)
      gradient_o <= {diagonal_negative_q, diagonal_q, 1'b1, diagonal_size_q};
    else
      gradient_o <= {axis_negative_q, axis_q, 1'b0, axis_size_q};
  end
endmodule
`default_nettype wire
