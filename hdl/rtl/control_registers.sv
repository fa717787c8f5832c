// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
`default_nettype none

/// The registers of REGISTERS.md behind AXI4-Lite: one write and one read at a time.
module control_registers #(
  parameter logic [31:0] SIZE = '0,
  parameter logic [31:0] SHAPE = '0
) (
  input  wire                            clk_i,
  input  wire                            rst_i,
  input  wire  [7:0]                     s_axil_awaddr,
  input  wire                            s_axil_awvalid,
  output logic                           s_axil_awready,
  input  wire  [31:0]                    s_axil_wdata,
  input  wire  [3:0]                     s_axil_wstrb,
  input  wire                            s_axil_wvalid,
  output logic                           s_axil_wready,
  output logic [1:0]                     s_axil_bresp,
  output logic                           s_axil_bvalid,
  input  wire                            s_axil_bready,
  input  wire  [7:0]                     s_axil_araddr,
  input  wire                            s_axil_arvalid,
  output logic                           s_axil_arready,
  output logic [31:0]                    s_axil_rdata,
  output logic [1:0]                     s_axil_rresp,
  output logic                           s_axil_rvalid,
  input  wire                            s_axil_rready,
  output logic                           irq_o,
  output logic                           admit_o,
  output stream_pkg::parameters_t        parameters_o,
  input  wire                            begin_i,        // a frame begins
  input  wire                            busy_i,         // a frame is coming in
  input  wire                            idle_i,         // nothing is on its way
  input  wire  [3:0]                     faults_i,
  input  wire                            done_i,         // a packet has ended
  input  wire  [31:0]                    frames_i,
  input  wire  [31:0]                    cycles_i,
  input  wire  [31:0]                    tail_cycles_i
);
  logic write, read;
  assign write = s_axil_awvalid && s_axil_wvalid && !s_axil_bvalid && !s_axil_awready;
  assign read = s_axil_arvalid && !s_axil_rvalid && !s_axil_arready;
  assign s_axil_wready = s_axil_awready;
  assign s_axil_bresp = 2'b00;
  assign s_axil_rresp = 2'b00;

  // A write lands one clock after it is accepted; bytes without strobe keep what they were.
  logic [31:0] mask;
  for (genvar i = 0; i < 4; i++) begin : g_mask
    assign mask[i*8 +: 8] = {8{s_axil_wstrb[i]}};
  end
  logic auto_q, start_q, done_q, global_q;
  logic [1:0] enable_q, pending_q;
  logic [4:0] status_q;
  logic parameter_write;
  stream_pkg::parameters_t parameters_q;
  assign parameters_o = parameters_q;
  assign admit_o = auto_q | start_q;
  assign irq_o = global_q && (pending_q & enable_q) != '0;
  assign parameter_write = s_axil_awready && s_axil_awaddr >= accelerator_pkg::REG_THRESHOLDS;
  logic late_write;  // counts for the next frame only
  assign late_write = parameter_write && (busy_i || begin_i);

  logic [31:0] thresholds, votes, verticals, control;
  /* verilator lint_off UNUSEDSIGNAL */  // the bits between the fields
  logic [31:0] merged_thresholds, merged_votes, merged_verticals;
  /* verilator lint_on UNUSEDSIGNAL */
  always_comb begin
    control = '0;
    control[accelerator_pkg::CONTROL_START_LSB] = start_q;
    control[accelerator_pkg::CONTROL_DONE_LSB] = done_q;
    control[accelerator_pkg::CONTROL_IDLE_LSB] = idle_i;
    control[accelerator_pkg::CONTROL_AUTO_RESTART_LSB] = auto_q;
  end
  assign thresholds = {6'd0, parameters_q.high, 6'd0, parameters_q.low};
  assign votes = {5'd0, parameters_q.inclined_votes, 5'd0, parameters_q.vertical_votes};
  assign verticals = {16'd0, parameters_q.vertical_to, parameters_q.vertical_from};
  assign merged_thresholds = (thresholds & ~mask) | (s_axil_wdata & mask);
  assign merged_votes = (votes & ~mask) | (s_axil_wdata & mask);
  assign merged_verticals = (verticals & ~mask) | (s_axil_wdata & mask);

  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      s_axil_awready <= 1'b0;
      s_axil_bvalid <= 1'b0;
      s_axil_arready <= 1'b0;
      s_axil_rvalid <= 1'b0;
      {auto_q, start_q, done_q, global_q, enable_q, pending_q, status_q} <= '0;
      parameters_q <= '0;
      parameters_q.enable <= '1;
    end else begin
      s_axil_awready <= write;
      s_axil_bvalid <= s_axil_awready | (s_axil_bvalid & ~s_axil_bready);
      s_axil_arready <= read;
      s_axil_rvalid <= s_axil_arready | (s_axil_rvalid & ~s_axil_rready);

      if (begin_i) begin
        start_q <= 1'b0;
        parameters_q.frame_id <= parameters_q.frame_id + 1'b1;
      end
      if (done_i) done_q <= 1'b1;
      else if (s_axil_arready && s_axil_araddr == accelerator_pkg::REG_CONTROL) done_q <= 1'b0;
      pending_q <= pending_q | {faults_i != '0 || late_write, done_i};
      status_q <= status_q | {late_write, faults_i};

      if (s_axil_awready) begin
        unique case (s_axil_awaddr)
          accelerator_pkg::REG_CONTROL: if (s_axil_wstrb[0]) begin
            auto_q <= s_axil_wdata[accelerator_pkg::CONTROL_AUTO_RESTART_LSB];
            start_q <= s_axil_wdata[accelerator_pkg::CONTROL_START_LSB];
          end
          accelerator_pkg::REG_GIER: if (s_axil_wstrb[0]) global_q <= s_axil_wdata[0];
          accelerator_pkg::REG_IER: if (s_axil_wstrb[0]) enable_q <= s_axil_wdata[1:0];
          accelerator_pkg::REG_ISR: if (s_axil_wstrb[0])
            pending_q <= (pending_q ^ s_axil_wdata[1:0]) | {faults_i != '0, done_i};
          accelerator_pkg::REG_STATUS: if (s_axil_wstrb[0])
            status_q <= (status_q & ~s_axil_wdata[4:0]) | {1'b0, faults_i};
          accelerator_pkg::REG_THRESHOLDS:
            {parameters_q.high, parameters_q.low} <= {merged_thresholds[25:16], merged_thresholds[9:0]};
          accelerator_pkg::REG_VOTES:
            {parameters_q.inclined_votes, parameters_q.vertical_votes} <=
                {merged_votes[26:16], merged_votes[10:0]};
          accelerator_pkg::REG_VERTICALS:
            {parameters_q.vertical_to, parameters_q.vertical_from} <= merged_verticals[15:0];
          accelerator_pkg::REG_FIRST_ROW:
            parameters_q.first_row <= (parameters_q.first_row & ~mask[15:0]) | (s_axil_wdata[15:0] & mask[15:0]);
          accelerator_pkg::REG_FRAME_ID:
            parameters_q.frame_id <= (parameters_q.frame_id & ~mask[15:0]) | (s_axil_wdata[15:0] & mask[15:0]);
          default: ;
        endcase
        for (int i = 0; i < 6; i++)
          if (s_axil_awaddr == accelerator_pkg::REG_ENABLE0 + 8'(4 * i))
            for (int b = 0; b < 32; b++)
              if (32 * i + b < 180 && mask[b]) parameters_q.enable[(32*i+b)%180] <= s_axil_wdata[b];
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (s_axil_arready) begin
      s_axil_rdata <= '0;
      unique case (s_axil_araddr)
        accelerator_pkg::REG_CONTROL: s_axil_rdata <= control;
        accelerator_pkg::REG_GIER: s_axil_rdata[0] <= global_q;
        accelerator_pkg::REG_IER: s_axil_rdata[1:0] <= enable_q;
        accelerator_pkg::REG_ISR: s_axil_rdata[1:0] <= pending_q;
        accelerator_pkg::REG_ID: s_axil_rdata <= accelerator_pkg::ID;
        accelerator_pkg::REG_VERSION: s_axil_rdata <= accelerator_pkg::VERSION;
        accelerator_pkg::REG_SIZE: s_axil_rdata <= SIZE;
        accelerator_pkg::REG_SHAPE: s_axil_rdata <= SHAPE;
        accelerator_pkg::REG_STATUS: s_axil_rdata[4:0] <= status_q;
        accelerator_pkg::REG_FRAMES: s_axil_rdata <= frames_i;
        accelerator_pkg::REG_CYCLES: s_axil_rdata <= cycles_i;
        accelerator_pkg::REG_TAIL_CYCLES: s_axil_rdata <= tail_cycles_i;
        accelerator_pkg::REG_THRESHOLDS: s_axil_rdata <= thresholds;
        accelerator_pkg::REG_VOTES: s_axil_rdata <= votes;
        accelerator_pkg::REG_VERTICALS: s_axil_rdata <= verticals;
        accelerator_pkg::REG_FIRST_ROW: s_axil_rdata[15:0] <= parameters_q.first_row;
        accelerator_pkg::REG_FRAME_ID: s_axil_rdata[15:0] <= parameters_q.frame_id;
        default: ;
      endcase
      for (int i = 0; i < 6; i++)
        if (s_axil_araddr == accelerator_pkg::REG_ENABLE0 + 8'(4 * i))
          for (int b = 0; b < 32; b++)
            if (32 * i + b < 180) s_axil_rdata[b] <= parameters_q.enable[(32*i+b)%180];
    end
  end
endmodule
`default_nettype wire
