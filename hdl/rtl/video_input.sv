// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// AXI4-Stream video in, words in raster order out. Frames follow each other without a gap; where no
/// frame waits, blank lines push the former one through. Whatever comes in, whole frames go out: short
/// lines and frames are filled with 0, what is too much is dropped, and faults_o says so.
module video_input #(
  parameter int PPC = 1,
  parameter int WORDS = 120,   // of a line
  parameter int HEIGHT = 120,
  parameter int BLANK_LINES = 7
) (
  input  wire                   clk_i,
  input  wire                   rst_i,
  input  wire                   s_axis_tvalid,
  output logic                  s_axis_tready,
  input  wire  [PPC*8-1:0]      s_axis_tdata,
  input  wire                   s_axis_tuser,   // start of frame
  input  wire                   s_axis_tlast,   // end of line
  input  wire                   admit_i,        // another frame may begin
  input  wire                   room_i,         // another word may move
  output logic                  begin_o,        // a frame begins in this clock, of bank bank_o
  output logic                  bank_o,
  output logic                  finish_o,       // its last word moves
  output logic                  busy_o,         // between the two
  output logic [3:0]            faults_o,       // line short, line long, frame short, no start of frame
  output logic                  valid_o,
  output stream_pkg::position_t position_o,
  output logic [PPC*8-1:0]      pixels_o
);
  localparam int WORD_WIDTH = $clog2(WORDS);
  localparam int ROW_WIDTH = $clog2(HEIGHT);
  localparam int BLANK_WIDTH = $clog2(BLANK_LINES + 1);

  typedef enum logic [1:0] {Between, Frame, Blank} state_e;
  state_e state_q;
  logic [WORD_WIDTH-1:0] word_q;
  logic [ROW_WIDTH-1:0] row_q;
  logic [BLANK_WIDTH-1:0] blank_q;   // blank lines still to come
  logic next_bank_q;
  logic skip_q;                      // drop the rest of a line that is too long
  logic fill_line_q, fill_frame_q;   // the source owes the rest
  logic last_word, last_row;
  assign last_word = word_q == WORD_WIDTH'(WORDS - 1);
  assign last_row = row_q == ROW_WIDTH'(HEIGHT - 1);

  logic starts, takes, fills, drops, blanks, interrupted;
  assign starts = state_q == Between && s_axis_tvalid && s_axis_tuser && admit_i && room_i;
  assign interrupted = state_q == Frame && s_axis_tvalid && s_axis_tuser && !(fill_line_q && last_row);
  assign fills = state_q == Frame && room_i && (fill_line_q || fill_frame_q);
  assign takes = state_q == Frame && room_i && !fill_line_q && !fill_frame_q && !skip_q &&
                 s_axis_tvalid && !s_axis_tuser;
  assign drops = s_axis_tvalid && !s_axis_tuser && (skip_q || state_q == Between);
  assign blanks = room_i && (state_q == Blank || (state_q == Between && blank_q != '0 && !starts));
  assign s_axis_tready = starts || takes || drops;

  logic moves;  // a word of a frame
  assign moves = starts || takes || fills;
  logic long_line, short_line;
  assign long_line = (starts || takes) && last_word && !s_axis_tlast;
  assign short_line = (starts || takes) && !last_word && s_axis_tlast;
  assign begin_o = starts;
  assign bank_o = next_bank_q;
  assign finish_o = moves && last_word && last_row;
  assign busy_o = state_q == Frame;
  assign faults_o = {drops && !skip_q, interrupted && !fill_frame_q, long_line, short_line};

  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      state_q <= Between;
      word_q <= '0;
      row_q <= '0;
      blank_q <= '0;
      next_bank_q <= 1'b0;
      skip_q <= 1'b0;
      fill_line_q <= 1'b0;
      fill_frame_q <= 1'b0;
    end else begin
      if (moves || blanks) word_q <= last_word ? '0 : word_q + 1'b1;
      if (moves && last_word) row_q <= last_row ? '0 : row_q + 1'b1;
      if (starts) next_bank_q <= ~next_bank_q;
      if (long_line) skip_q <= 1'b1;
      else if (s_axis_tvalid && (s_axis_tuser || (drops && s_axis_tlast))) skip_q <= 1'b0;
      if (short_line) fill_line_q <= 1'b1;
      else if (moves && last_word) fill_line_q <= 1'b0;
      if (finish_o) fill_frame_q <= 1'b0;
      else if (interrupted) fill_frame_q <= 1'b1;
      if (finish_o) blank_q <= BLANK_WIDTH'(BLANK_LINES);
      else if (blanks && state_q == Between) blank_q <= blank_q - 1'b1;
      unique case (state_q)
        Between: if (starts) state_q <= Frame;
          else if (blanks) state_q <= Blank;
        Frame: if (finish_o) state_q <= Between;
        default: if (blanks && last_word) state_q <= Between;
      endcase
    end
  end

  always_ff @(posedge clk_i) begin
    valid_o <= (moves || blanks) && !rst_i;
    pixels_o <= starts || takes ? s_axis_tdata : '0;
    position_o.active <= moves;
    position_o.bank <= starts ? next_bank_q : ~next_bank_q;
    position_o.first_row <= moves && row_q == '0;
    position_o.last_row <= moves && last_row;
    position_o.first_word <= word_q == '0;
    position_o.last_word <= last_word;
  end
endmodule
`default_nettype wire
