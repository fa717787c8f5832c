#!/bin/sh
# SPDX-FileCopyrightText: 2026 The Colonnade authors
# SPDX-License-Identifier: BSD-3-Clause
# scripts/shared_map_table.sh MRCLAM_FOLDER OUTPUT [BUILD]: one map for all robots of a UTIAS MRCLAM
# data set, each going on in the map of those before, from a start nobody knows; a table of Markdown
# with the log's identities and one with hidden ones.
# SETTINGS: see mrclam_logs.sh.
set -eu
. "$(dirname "$0")/mrclam_logs.sh"
for use_ids in true false; do
  echo
  echo "RangeBearing.use_ids=$use_ids:"
  echo
  echo "| robot | ATE online / afterwards [m] | landmarks in the map |"
  echo "|---|---|---|"
  map=""
  for robot in 1 5 3 4 2; do
    log=$out/robot$robot.rawlog
    run=$out/$robot-$use_ids
    [ -e "$run" ] || "$colonnade" run "$log" $settings -o "$run" ${map:+--start anywhere --map "$map"} \
      --ground-truth "$out/robot${robot}_ground_truth.tum" --set RangeBearing.use_ids=$use_ids >"$run.txt" 2>&1
    map=$run/map.colonnade
    python3 - "$run" "$robot" <<'PYTHON'
import json, sys
run, robot = sys.argv[1:]
s = json.load(open(run + "/summary.json"))
final = s.get("trajectory_final", {}).get("ate_rmse_m")
print("| %s | %.3f / %s | %d |" % (robot, s["trajectory"]["ate_rmse_m"], "-" if final is None else "%.3f" % final,
                                  sum(1 for line in open(run + "/landmarks.csv")) - 1))
PYTHON
  done
done
