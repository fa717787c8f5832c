#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Colonnade authors
# SPDX-License-Identifier: BSD-3-Clause
# Proofs for all time (k-induction) with yosys-smtbmc and z3. The properties in MODULE.svh are put
# inside a copy of the module. Each proof is followed by a mutated design that must fail it.
# prove.sh [MODULE ...]      exit 1: a proof fails or a mutated design passes; 2: a tool gave no answer
set -euo pipefail
cd "$(dirname "$0")"
for tool in yosys yosys-smtbmc z3; do
  command -v "$tool" >/dev/null || { echo "skipped: no $tool (scripts/packages.txt)"; exit 77; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
wanted=" $* "

# solved MODULE DEPTH [-i]: 0 if the properties hold, 1 if the solver has a counterexample; anything else is
# an error of the tools and ends it all
solved() {
  local log=$work/$1.log
  yosys-smtbmc --unroll --noprogress -s "${COLONNADE_SOLVER:-z3}" ${3:-} -t "$2" "$work/$1.smt2" >"$log" 2>&1 || true
  if grep -q "Status: PASSED" "$log"; then return 0; fi
  if grep -q "Status: FAILED" "$log" && grep -q "Assert failed in\|Temporal induction failed" "$log"; then return 1; fi
  tail -n 20 "$log" >&2
  echo "$1: no answer from the solver" >&2
  exit 2
}

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
    prep -flatten -nordff -top $name; async2sync; dffunmap; write_smt2 -wires $work/$name.smt2" || {
    echo "$name: no model of it" >&2
    exit 2
  }
  solved "$name" "$depth" && solved "$name" "$depth" -i
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
prove line_taps "-set WORDS 20" 3 's/(WORDS - 1) ? .0 : read_address_q/(WORDS) ? 0 : read_address_q/' \
  "addresses inside the memory, never written where read"
for angle in 0 43 88 135; do
  prove angle_votes "-set ANGLE $angle -set WIDTH 32 -set HEIGHT 32 -set REACH 24" 2 's/localparam int LINE_STEP = SINE - /localparam int LINE_STEP = SINE + 1 - /' \
    "theta $((angle - 90)): rho exact, no vote outside the memory (32x32)"
done
