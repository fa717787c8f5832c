// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// line_packet: what it offers stays until it is taken; a packet is the head, every line that came,
// their number, the clocks; TLAST stands on its last word alone.
  logic f_started_q = 1'b0;
  always_ff @(posedge clk_i) f_started_q <= 1'b1;
  always_comb assume (rst_i == !f_started_q);
  // The scan holds a line until it is taken, begins when idle, ends with no line left and once; what
  // belongs to the frame does not change on the way.
  logic f_line_waits_q = 1'b0, f_scanning_q = 1'b0, f_busy_q = 1'b0;
  logic [31:0] f_line_q;
  logic [19:0] f_frame_q;
  always_ff @(posedge clk_i) begin
    f_line_waits_q <= line_valid_i && !line_ready_o && !rst_i;
    f_line_q <= line_i;
    f_frame_q <= {frame_id_i, faults_i};
    f_busy_q <= state_q != Idle && !rst_i;
    if (rst_i || end_i) f_scanning_q <= 1'b0;
    else if (begin_i) f_scanning_q <= 1'b1;
  end
  always_comb begin
    if (f_line_waits_q) assume (line_valid_i && line_i == f_line_q);
    if (f_busy_q) assume ({frame_id_i, faults_i} == f_frame_q);
    if (begin_i) assume (state_q == Idle && !f_scanning_q && !line_valid_i && f_started_q);
    if (end_i) assume (f_scanning_q && !line_valid_i);
    if (line_valid_i) assume (f_scanning_q);
  end
  logic f_offered_q = 1'b0, f_last_q;
  logic [31:0] f_data_q;
  logic [15:0] f_lines_q = '0;
  always_ff @(posedge clk_i) begin
    f_offered_q <= m_axis_tvalid && !m_axis_tready && !rst_i;
    {f_last_q, f_data_q} <= {m_axis_tlast, m_axis_tdata};
    if (state_q == Idle) f_lines_q <= '0;
    else if (line_valid_i && line_ready_o) f_lines_q <= f_lines_q + 1'b1;
  end
  always_comb if (f_started_q) begin
    assert (state_q == Idle || state_q == Head || state_q == Lines || state_q == Count || state_q == Clocks);
    if (f_offered_q) assert (m_axis_tvalid && m_axis_tdata == f_data_q && m_axis_tlast == f_last_q);
    if (line_ready_o && line_valid_i) assert (m_axis_tvalid && m_axis_tdata == line_i);
    if (state_q != Idle) assert (count_q == f_lines_q);
    if (state_q == Count) assert (m_axis_tdata[15:0] == f_lines_q && m_axis_tdata[19:16] == faults_i);
    if (state_q == Head) assert (count_q == '0);
    if (state_q == Head || state_q == Lines) assert (f_scanning_q || ended_q);
    if (state_q == Idle || state_q == Count || state_q == Clocks) assert (!f_scanning_q);
    if (ended_q) assert (!f_scanning_q);
    assert (m_axis_tlast == (state_q == Clocks));
  end
