// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// control_registers: every write and read that is accepted is answered once; answers stay until they
// are taken; a register reads back what its strobed bytes were given; no fault goes unseen.
  logic f_started_q = 1'b0;
  always_ff @(posedge clk_i) f_started_q <= 1'b1;
  always_comb assume (rst_i == !f_started_q);
  // The master holds what it offers.
  logic f_aw_waits_q = 1'b0, f_w_waits_q = 1'b0, f_ar_waits_q = 1'b0;
  logic [7:0] f_awaddr_q, f_araddr_q;
  logic [35:0] f_w_q;
  always_ff @(posedge clk_i) begin
    f_aw_waits_q <= s_axil_awvalid && !s_axil_awready && !rst_i;
    f_w_waits_q <= s_axil_wvalid && !s_axil_wready && !rst_i;
    f_ar_waits_q <= s_axil_arvalid && !s_axil_arready && !rst_i;
    {f_awaddr_q, f_araddr_q, f_w_q} <= {s_axil_awaddr, s_axil_araddr, s_axil_wdata, s_axil_wstrb};
  end
  always_comb begin
    if (f_aw_waits_q) assume (s_axil_awvalid && s_axil_awaddr == f_awaddr_q);
    if (f_w_waits_q) assume (s_axil_wvalid && {s_axil_wdata, s_axil_wstrb} == f_w_q);
    if (f_ar_waits_q) assume (s_axil_arvalid && s_axil_araddr == f_araddr_q);
  end
  logic f_b_waits_q = 1'b0, f_r_waits_q = 1'b0, f_written_q = 1'b0, f_read_q = 1'b0;
  logic [31:0] f_rdata_q, f_thresholds_q = '0, f_read_thresholds_q;
  logic [4:0] f_status_q = '0;
  always_ff @(posedge clk_i) begin
    f_b_waits_q <= s_axil_bvalid && !s_axil_bready && !rst_i;
    f_r_waits_q <= s_axil_rvalid && !s_axil_rready && !rst_i;
    f_rdata_q <= s_axil_rdata;
    f_written_q <= s_axil_awvalid && s_axil_awready && !rst_i;
    f_read_q <= s_axil_arvalid && s_axil_arready && !rst_i;
    f_read_thresholds_q <= f_thresholds_q;
    // What has been seen and not been cleared since; a write counts for the next frame from the clock
    // in which this one begins.
    if (rst_i) f_status_q <= '0;
    else f_status_q <= (f_status_q & ~(s_axil_awready && s_axil_awaddr == 8'h20 && s_axil_wstrb[0] ? s_axil_wdata[4:0] : 5'd0)) |
                       {s_axil_awready && s_axil_awaddr >= 8'h30 && (busy_i || begin_i), faults_i};
    if (rst_i) f_thresholds_q <= '0;
    else if (s_axil_awready && s_axil_awaddr == 8'h30)
      for (int i = 0; i < 32; i++)
        if (s_axil_wstrb[i/8] && i % 16 < 10) f_thresholds_q[i] <= s_axil_wdata[i];
  end
  always_comb if (f_started_q) begin
    if (s_axil_awready) assert (s_axil_awvalid && s_axil_wvalid && s_axil_wready && !s_axil_bvalid);
    if (s_axil_arready) assert (s_axil_arvalid && !s_axil_rvalid);
    assert (s_axil_bvalid == (f_written_q || f_b_waits_q));
    assert (s_axil_rvalid == (f_read_q || f_r_waits_q));
    if (f_r_waits_q) assert (s_axil_rdata == f_rdata_q);
    assert (thresholds == f_thresholds_q);
    if (f_read_q && f_araddr_q == 8'h30) assert (s_axil_rdata == f_read_thresholds_q);
    assert (status_q == f_status_q);
  end
