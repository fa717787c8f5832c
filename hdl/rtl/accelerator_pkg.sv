// SPDX-FileCopyrightText: 2026 The Colonnade authors
// SPDX-License-Identifier: BSD-3-Clause
// Made by hdl/generate.py from hdl/accelerator.toml; edit those.
/// Registers, the line word and the sine table.
package accelerator_pkg;
  localparam logic [31:0] ID = 32'h434F4C4E;
  localparam logic [31:0] VERSION = 32'h00010000;

  localparam logic [7:0] REG_CONTROL = 8'h00;
  localparam logic [7:0] REG_GIER = 8'h04;
  localparam logic [7:0] REG_IER = 8'h08;
  localparam logic [7:0] REG_ISR = 8'h0C;
  localparam logic [7:0] REG_ID = 8'h10;
  localparam logic [7:0] REG_VERSION = 8'h14;
  localparam logic [7:0] REG_SIZE = 8'h18;
  localparam logic [7:0] REG_SHAPE = 8'h1C;
  localparam logic [7:0] REG_STATUS = 8'h20;
  localparam logic [7:0] REG_FRAMES = 8'h24;
  localparam logic [7:0] REG_CYCLES = 8'h28;
  localparam logic [7:0] REG_TAIL_CYCLES = 8'h2C;
  localparam logic [7:0] REG_THRESHOLDS = 8'h30;
  localparam logic [7:0] REG_VOTES = 8'h34;
  localparam logic [7:0] REG_VERTICALS = 8'h38;
  localparam logic [7:0] REG_FIRST_ROW = 8'h3C;
  localparam logic [7:0] REG_FRAME_ID = 8'h40;
  localparam logic [7:0] REG_ENABLE0 = 8'h50;
  localparam logic [7:0] REG_ENABLE1 = 8'h54;
  localparam logic [7:0] REG_ENABLE2 = 8'h58;
  localparam logic [7:0] REG_ENABLE3 = 8'h5C;
  localparam logic [7:0] REG_ENABLE4 = 8'h60;
  localparam logic [7:0] REG_ENABLE5 = 8'h64;

  localparam int CONTROL_START_LSB = 0;
  localparam int CONTROL_DONE_LSB = 1;
  localparam int CONTROL_IDLE_LSB = 2;
  localparam int CONTROL_AUTO_RESTART_LSB = 7;
  localparam int SHAPE_PIXELS_LSB = 0;  // 8 bits
  localparam int SHAPE_ANGLES_LSB = 8;  // 8 bits
  localparam int SHAPE_PASSES_LSB = 16;  // 8 bits
  localparam int SHAPE_SHARED_LSB = 24;
  localparam int STATUS_LINE_SHORT_LSB = 0;
  localparam int STATUS_LINE_LONG_LSB = 1;
  localparam int STATUS_FRAME_SHORT_LSB = 2;
  localparam int STATUS_NO_START_LSB = 3;
  localparam int STATUS_LATE_WRITE_LSB = 4;

  localparam int FRACTION = 12;  // bits of the sine table
  localparam int TRIG_WIDTH = 14;
  localparam int ALL_ANGLES = 180;
  // Entry i is theta = i - 90 degrees, entry 0 in the lowest bits.
  localparam logic [2519:0] COS_TABLE =
      2520'h11c08f035811e05941ac07cc23a0a042c70c383540e643df109046912b84f214d857916f05fe19006821b0c7041d107831f0880020f887b22dc8f224b496826849da2848a4929fcab52ba4b1d2d40b822ed0be4304cc4231bcc9c331ccf2346cd4435acd9236dcddb37f8e213908e613a00e9e3ae8ed63bc0f093c84f383d34f613dd0f863e5cfa63ed4fc23f38fd83f84fea3fc0ff63fe8ffe3ffd0003ffcffe3fe8ff63fc0fea3f84fd83f38fc23ed4fa63e5cf863dd0f613d34f383c84f093bc0ed63ae8e9e3a00e613908e2137f8ddb36dcd9235acd44346ccf2331cc9c31bcc42304cbe42ed0b822d40b1d2ba4ab529fca4928489da268496824b48f222dc87b20f88001f087831d107041b0c68219005fe16f057914d84f212b846910903df0e643540c382c70a0423a07cc1ac059411e035808f011c000;
  localparam logic [2519:0] SIN_TABLE =
      2520'h3ffcffe3fe8ff63fc0fea3f84fd83f38fc23ed4fa63e5cf863dd0f613d34f383c84f093bc0ed63ae8e9e3a00e613908e2137f8ddb36dcd9235acd44346ccf2331cc9c31bcc42304cbe42ed0b822d40b1d2ba4ab529fca4928489da268496824b48f222dc87b20f88001f087831d107041b0c68219005fe16f057914d84f212b846910903df0e643540c382c70a0423a07cc1ac059411e035808f011c000fee7f71fcabee2fa6fe54f837dc6f5ffd39f3cbcacf19fc21ef73b97ed4bb0eeb2ba87e913a02e70397ee4f78fce2f387de0fb800df0b785dd2770edb4f698d97f626d7bb5b7d60754bd45f4e3d2c347ed13341ccfb73bece47364cce730ecb972bcca5726ec927225c80b1dfc6fb19fc603162c51b12ac4430f7c37f0c8c2cf09fc23307ac1a705ac12f03ec0cb028c07f016c04300ac01b002c007000;
  localparam logic [719:0] ADMIT_TABLE =
      720'h44444444444444446666666666666666666622222222222222222333333333333333333331111111111111111111111111111111119999999999999999999988888888888888888cccccccccccccccccccc44444444444444444;

  // Angle sets: 8 bits for each angle, theta + 90, the first in the lowest bits.
  localparam int THESIS_ANGLES = 12;
  localparam logic [1439:0] THESIS_SET =
      1440'h8786855d5c5b5a59582d2c2b;
  localparam int RUN_ANGLES = 126;
  localparam logic [1439:0] RUN_SET =
      1440'hb2b0aeacaaa8a6a4a2a09e9c9a98969492908e8c8a88868482807e7d7c7b7a797877767574737271706f6e6d6c6b6a696867666564636261605f5e5d5c5b5a595857565554535251504f4e4d4c4b4a494847464544434241403f3e3d3c3b3a393837363432302e2c2a28262422201e1c1a18161412100e0c0a0806040200;
  localparam int FULL_ANGLES = 180;
  localparam logic [1439:0] FULL_SET =
      1440'hb3b2b1b0afaeadacabaaa9a8a7a6a5a4a3a2a1a09f9e9d9c9b9a999897969594939291908f8e8d8c8b8a898887868584838281807f7e7d7c7b7a797877767574737271706f6e6d6c6b6a696867666564636261605f5e5d5c5b5a595857565554535251504f4e4d4c4b4a494847464544434241403f3e3d3c3b3a393837363534333231302f2e2d2c2b2a292827262524232221201f1e1d1c1b1a191817161514131211100f0e0d0c0b0a09080706050403020100;

  localparam int LINE_VOTES_LSB = 0;
  localparam int LINE_VOTES_WIDTH = 11;
  localparam int LINE_RHO_LSB = 11;
  localparam int LINE_RHO_WIDTH = 12;
  localparam int LINE_THETA_LSB = 23;
  localparam int LINE_THETA_WIDTH = 8;
  localparam int LINE_CLASS_LSB = 31;
  localparam int LINE_CLASS_WIDTH = 1;

  /// A line word of its fields.
  function automatic logic [31:0] line_word(input logic class_i, input logic [7:0] theta_i, input logic [11:0] rho_i, input logic [10:0] votes_i);
    line_word = {class_i, theta_i, rho_i, votes_i};
  endfunction
endpackage
