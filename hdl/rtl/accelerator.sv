// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// The image stage on its bus: AXI4-Stream video in; edge map and line packets out; AXI4-Lite
/// registers. Two frames may be on their way: one coming in, the former one's lines going out.
module accelerator #(
  parameter int WIDTH = 120,     // pixels, a multiple of PPC, at least 16 PPC, at most 1023
  parameter int HEIGHT = 120,    // at least 16, at most 1023
  parameter int PPC = 1,         // pixels per clock: 1, 2 or 4
  parameter int PASSES = 2,      // of hysteresis, at most 6; 0: one threshold
  parameter int SET = 0,         // angles: 0 thesis, 1 run, 2 full (accelerator.toml)
  parameter int BANKS = 0        // 0: memories for every angle; else that many, shared
) (
  input  wire               clk,
  input  wire               rst,
  input  wire               s_axis_tvalid,
  output logic              s_axis_tready,
  input  wire  [PPC*8-1:0]  s_axis_tdata,
  input  wire               s_axis_tuser,
  input  wire               s_axis_tlast,
  output logic              m_axis_edges_tvalid,
  input  wire               m_axis_edges_tready,
  output logic [PPC*8-1:0]  m_axis_edges_tdata,
  output logic              m_axis_edges_tuser,
  output logic              m_axis_edges_tlast,
  output logic              m_axis_lines_tvalid,
  input  wire               m_axis_lines_tready,
  output logic [31:0]       m_axis_lines_tdata,
  output logic              m_axis_lines_tlast,
  input  wire  [7:0]        s_axil_awaddr,
  input  wire               s_axil_awvalid,
  output logic              s_axil_awready,
  input  wire  [31:0]       s_axil_wdata,
  input  wire  [3:0]        s_axil_wstrb,
  input  wire               s_axil_wvalid,
  output logic              s_axil_wready,
  output logic [1:0]        s_axil_bresp,
  output logic              s_axil_bvalid,
  input  wire               s_axil_bready,
  input  wire  [7:0]        s_axil_araddr,
  input  wire               s_axil_arvalid,
  output logic              s_axil_arready,
  output logic [31:0]       s_axil_rdata,
  output logic [1:0]        s_axil_rresp,
  output logic              s_axil_rvalid,
  input  wire               s_axil_rready,
  output logic              irq
);
  // Queues have room for what is on its way to them with up to six passes.
  if ((PPC != 1 && PPC != 2 && PPC != 4) || WIDTH % PPC != 0 || WIDTH < 16 * PPC || WIDTH > 1023 ||
      HEIGHT < 16 || HEIGHT > 1023 || PASSES < 0 || PASSES > 6 || SET < 0 || SET > 2 || BANKS < 0)
    $error("accelerator: a parameter is out of its range");
  localparam int WORDS = WIDTH / PPC;
  localparam int ANGLES = SET == 0 ? accelerator_pkg::THESIS_ANGLES
                        : SET == 1 ? accelerator_pkg::RUN_ANGLES : accelerator_pkg::FULL_ANGLES;
  localparam logic [1439:0] ANGLE_SET = SET == 0 ? accelerator_pkg::THESIS_SET
                        : SET == 1 ? accelerator_pkg::RUN_SET : accelerator_pkg::FULL_SET;
  localparam int MARGIN = 48 + 8 * PASSES;  // words between video_input and the edge queue, at most

  // The snapshots of the two banks are taken when a frame begins.
  logic begins, bank, finishes, busy, admit, cleared, hough_room, edges_room, room, begin_q, bank_q;
  logic [3:0] faults;
  stream_pkg::parameters_t parameters, parameters0_q, parameters1_q;
  logic [3:0] faults0_q, faults1_q;
  logic [31:0] clock_q, start0_q, start1_q, finish0_q, finish1_q, cycles_q, tail_cycles_q;
  logic [15:0] begun_q, done_q;
  logic scan_begins, scan_ends, scan_bank, packet_idle, packet_done;
  always_ff @(posedge clk) begin
    if (begins && !bank) parameters0_q <= parameters;
    if (begins && bank) parameters1_q <= parameters;
    // faults of the frame that is coming in: the bank of the last one that began
    if (begins && !bank) faults0_q <= faults;
    else if (busy && !bank_q) faults0_q <= faults0_q | faults;
    if (begins && bank) faults1_q <= faults;
    else if (busy && bank_q) faults1_q <= faults1_q | faults;
    if (begins && !bank) start0_q <= clock_q;
    if (begins && bank) start1_q <= clock_q;
    if (finishes && !bank_q) finish0_q <= clock_q;
    if (finishes && bank_q) finish1_q <= clock_q;
    if (begins) bank_q <= bank;
    if (packet_done) begin
      cycles_q <= clock_q - (scan_bank ? start1_q : start0_q) + 1'b1;
      tail_cycles_q <= clock_q - (scan_bank ? finish1_q : finish0_q);
    end
    if (rst) begin
      clock_q <= '0;
      {begun_q, done_q} <= '0;
      begin_q <= 1'b0;
    end else begin
      clock_q <= clock_q + 1'b1;
      begun_q <= begun_q + 16'(begins);
      done_q <= done_q + 16'(packet_done);
      begin_q <= scan_begins;
    end
  end
  logic [15:0] on_the_way;
  assign on_the_way = begun_q - done_q;
  assign room = edges_room && hough_room;

  logic word_valid, edge_valid;
  stream_pkg::position_t word_position, edge_position;
  logic [PPC*8-1:0] pixels;
  logic [PPC*4-1:0] edges;
  video_input #(.PPC(PPC), .WORDS(WORDS), .HEIGHT(HEIGHT), .BLANK_LINES(6 + PASSES)) u_input (
    .clk_i(clk), .rst_i(rst), .s_axis_tvalid(s_axis_tvalid), .s_axis_tready(s_axis_tready),
    .s_axis_tdata(s_axis_tdata), .s_axis_tuser(s_axis_tuser), .s_axis_tlast(s_axis_tlast),
    .admit_i(admit && cleared && on_the_way < 16'd2), .room_i(room), .begin_o(begins),
    .bank_o(bank), .finish_o(finishes), .busy_o(busy), .faults_o(faults), .valid_o(word_valid),
    .position_o(word_position), .pixels_o(pixels)
  );
  canny #(.PPC(PPC), .WORDS(WORDS), .PASSES(PASSES)) u_canny (
    .clk_i(clk), .rst_i(rst), .low_i({parameters1_q.low, parameters0_q.low}),
    .high_i({parameters1_q.high, parameters0_q.high}), .valid_i(word_valid),
    .position_i(word_position), .pixels_i(pixels), .valid_o(edge_valid),
    .position_o(edge_position), .edges_o(edges)
  );

  stream_fifo #(.WIDTH(PPC * 4 + 2), .DEPTH(128), .MARGIN(MARGIN)) u_edges (
    .clk_i(clk), .rst_i(rst), .room_o(edges_room), .valid_i(edge_valid && edge_position.active),
    .data_i({edge_position.first_row && edge_position.first_word, edge_position.last_word, edges}),
    .valid_o(m_axis_edges_tvalid), .ready_i(m_axis_edges_tready), .data_o(edges_out)
  );
  logic [PPC*4+1:0] edges_out;
  assign {m_axis_edges_tuser, m_axis_edges_tlast} = edges_out[PPC*4+1:PPC*4];
  always_comb begin
    for (int p = 0; p < PPC; p++) m_axis_edges_tdata[p*8 +: 8] = {4'd0, edges_out[p*4 +: 4]};
  end

  localparam int REACH = rho_reach(WIDTH / 2, HEIGHT / 2);
  logic line_valid, line_ready;
  logic [31:0] line;
  if (BANKS == 0) begin : g_parallel
    hough_parallel #(
      .WIDTH(WIDTH), .HEIGHT(HEIGHT), .PPC(PPC), .ANGLES(ANGLES), .ANGLE_SET(ANGLE_SET), .REACH(REACH)
    ) u_hough (
      .clk_i(clk), .rst_i(rst), .parameters0_i(parameters0_q), .parameters1_i(parameters1_q),
      .valid_i(edge_valid), .position_i(edge_position), .edges_i(edges), .cleared_o(cleared),
      .room_o(hough_room), .packet_idle_i(packet_idle), .scan_bank_o(scan_bank), .begin_o(scan_begins), .end_o(scan_ends),
      .line_valid_o(line_valid), .line_ready_i(line_ready), .line_o(line)
    );
  end else begin : g_shared
    hough_shared #(
      .WIDTH(WIDTH), .HEIGHT(HEIGHT), .PPC(PPC), .ANGLES(ANGLES), .ANGLE_SET(ANGLE_SET),
      .BANKS(BANKS), .REACH(REACH)
    ) u_hough (
      .clk_i(clk), .rst_i(rst), .parameters0_i(parameters0_q), .parameters1_i(parameters1_q),
      .valid_i(edge_valid), .position_i(edge_position), .edges_i(edges), .cleared_o(cleared),
      .room_o(hough_room), .packet_idle_i(packet_idle), .scan_bank_o(scan_bank), .begin_o(scan_begins), .end_o(scan_ends),
      .line_valid_o(line_valid), .line_ready_i(line_ready), .line_o(line)
    );
  end

  line_packet u_packet (
    .clk_i(clk), .rst_i(rst), .begin_i(begin_q), .end_i(scan_ends), .line_valid_i(line_valid),
    .line_ready_o(line_ready), .line_i(line),
    .frame_id_i(scan_bank ? parameters1_q.frame_id : parameters0_q.frame_id),
    .faults_i(scan_bank ? faults1_q : faults0_q),
    .clocks_i(clock_q - (scan_bank ? start1_q : start0_q)), .idle_o(packet_idle),
    .done_o(packet_done), .m_axis_tvalid(m_axis_lines_tvalid), .m_axis_tready(m_axis_lines_tready),
    .m_axis_tdata(m_axis_lines_tdata), .m_axis_tlast(m_axis_lines_tlast)
  );

  control_registers #(
    .SIZE({16'(HEIGHT), 16'(WIDTH)}),
    .SHAPE((32'(PPC) << accelerator_pkg::SHAPE_PIXELS_LSB) | (32'(ANGLES) << accelerator_pkg::SHAPE_ANGLES_LSB) |
           (32'(PASSES) << accelerator_pkg::SHAPE_PASSES_LSB) |
           (32'(BANKS != 0) << accelerator_pkg::SHAPE_SHARED_LSB))
  ) u_registers (
    .clk_i(clk), .rst_i(rst), .s_axil_awaddr(s_axil_awaddr), .s_axil_awvalid(s_axil_awvalid),
    .s_axil_awready(s_axil_awready), .s_axil_wdata(s_axil_wdata), .s_axil_wstrb(s_axil_wstrb),
    .s_axil_wvalid(s_axil_wvalid), .s_axil_wready(s_axil_wready), .s_axil_bresp(s_axil_bresp),
    .s_axil_bvalid(s_axil_bvalid), .s_axil_bready(s_axil_bready), .s_axil_araddr(s_axil_araddr),
    .s_axil_arvalid(s_axil_arvalid), .s_axil_arready(s_axil_arready), .s_axil_rdata(s_axil_rdata),
    .s_axil_rresp(s_axil_rresp), .s_axil_rvalid(s_axil_rvalid), .s_axil_rready(s_axil_rready),
    .irq_o(irq), .admit_o(admit), .parameters_o(parameters), .begin_i(begins),
    .busy_i(busy), .idle_i(on_the_way == '0 && packet_idle), .faults_i(faults),
    .done_i(packet_done), .frames_i({begun_q, done_q}), .cycles_i(cycles_q),
    .tail_cycles_i(tail_cycles_q)
  );

  /// The least whole number not below the distance of a corner from the centre, plus one.
  function automatic int rho_reach(input int x, input int y);
    rho_reach = 1;
    while ((rho_reach - 1) * (rho_reach - 1) < x * x + y * y) rho_reach = rho_reach + 1;
  endfunction
endmodule
`default_nettype wire
