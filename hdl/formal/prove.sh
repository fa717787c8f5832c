#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Colonnade authors
# SPDX-License-Identifier: BSD-3-Clause
# Proofs for all time (k-induction) with yosys-smtbmc and z3. The properties in MODULE.svh are put
# inside a copy of the module. Each proof is followed by a mutated design that must fail it.
# prove.sh [MODULE ...]
set -euo pipefail
cd "$(dirname "$0")"
for tool in yosys yosys-smtbmc z3; do
  command -v "$tool" >/dev/null || { echo "skipped: no $tool (scripts/packages.txt)"; exit 77; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
wanted=" $* "

# holds MODULE PARAMETERS DEPTH [SED]: 0 if the properties hold for all time, 1 if one can fail
holds() {
  local name=$1 parameters=$2 depth=$3 mutation=${4:-}
  sed "/^endmodule/e cat $name.svh" "../rtl/$name.sv" >"$work/$name.sv"
  if [ -n "$mutation" ]; then
    sed -i "$mutation" "$work/$name.sv"
    if sed "/^endmodule/e cat $name.svh" "../rtl/$name.sv" | cmp -s - "$work/$name.sv"; then
      echo "$name: the mutation '$mutation' changes nothing" >&2
      exit 2
    fi
  fi
  local others=()
  if [ "$name" = angle_votes ]; then  # what its memory holds plays no part
    sed '/^  .* verilator no_inline_module/,/^endmodule/{/^endmodule/!d}
      s/^endmodule/assign scan_votes_o = 0;\n&/' ../rtl/vote_memory.sv >"$work/vote_memory.sv"
    others=("$work/vote_memory.sv")
  fi
  yosys -q -e 'implicitly declared' -p "
    read_verilog -sv -formal ../rtl/accelerator_pkg.sv ../rtl/stream_pkg.sv ${others[*]:-} $work/$name.sv
    ${parameters:+chparam $parameters $name}
    prep -flatten -nordff -top $name; async2sync; dffunmap; write_smt2 -wires $work/$name.smt2" || exit 2
  yosys-smtbmc --unroll --noprogress -s z3 -t "$depth" "$work/$name.smt2" >"$work/$name.log" &&
    yosys-smtbmc --unroll --noprogress -s z3 -i -t "$depth" "$work/$name.smt2" >>"$work/$name.log"
}

# prove MODULE PARAMETERS DEPTH MUTATION WHAT
prove() {
  [ "$wanted" = "  " ] || [[ $wanted == *" $1 "* ]] || return 0
  holds "$1" "$2" "$3" || { tail -n 20 "$work/$1.log"; echo "$1: FAILS"; exit 1; }
  if holds "$1" "$2" "$3" "$4"; then
    echo "$1: a mutated design passes ($4): the proof proves nothing"
    exit 1
  fi
  echo "$1: $5"
}

prove stream_fifo "-set WIDTH 2 -set DEPTH 4 -set MARGIN 1" 4 's/DEPTH - MARGIN - 2);$/DEPTH - MARGIN + 2);/' \
  "nothing lost, doubled or reordered, never too full, offers held"
prove video_input "-set WORDS 5 -set HEIGHT 3 -set BLANK_LINES 2" 4 's/if (short_line) fill_line_q <= 1.b1/if (short_line) word_q <= 0/' \
  "whole lines and frames in raster order from any source, counters in range"
prove line_packet "" 4 's/if (state_q != Clocks) clocks_q/clocks_q/' \
  "offers held, every line counted, TLAST on the last word alone"
prove control_registers "" 3 's/s_axil_rvalid & ~s_axil_rready/1'"'"'b0/' \
  "answers held and one for each request, registers read back, faults kept"
prove control_registers "" 3 's/status_q <= status_q | {/status_q <= {/' "status bits kept until they are cleared"
prove line_taps "-set WORDS 20" 3 's/position_i.last_word ? .0 : address_q/position_i.first_row ? '"'0"' : address_q/' \
  "addresses inside the memory, never written where read"
for angle in 0 43 88 135; do
  prove angle_votes "-set ANGLE $angle -set WIDTH 32 -set HEIGHT 32 -set REACH 24" 2 's/localparam int LINE_STEP = SINE - /localparam int LINE_STEP = SINE + 1 - /' \
    "theta $((angle - 90)): rho exact, no vote outside the memory (32x32)"
done
