// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
/// What travels beside the pixels: between video_input and the last stage, words of PPC pixels move
/// in raster order, a word whenever `valid` is high, lines of blank words between frames while the
/// stages still hold rows of the former one. There is no ready: video_input throttles.
package stream_pkg;
  localparam int POSITION_WIDTH = 6;  // bits of position_t
  typedef struct packed {
    logic active;      // the line belongs to a frame
    logic bank;        // which of the two snapshots of the parameters the frame uses
    logic first_row;
    logic last_row;
    logic first_word;  // of its line, blank lines too
    logic last_word;
  } position_t;

  /// The run-time parameters, snapped at the start of a frame.
  typedef struct packed {
    logic [179:0] enable;
    logic [15:0]  frame_id;
    logic [15:0]  first_row;
    logic [7:0]   vertical_to;    // signed degrees
    logic [7:0]   vertical_from;  // signed degrees
    logic [10:0]  inclined_votes;
    logic [10:0]  vertical_votes;
    logic [9:0]   high;
    logic [9:0]   low;
  } parameters_t;
endpackage
