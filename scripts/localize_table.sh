#!/bin/sh
# SPDX-FileCopyrightText: 2026 The Colonnade authors
# SPDX-License-Identifier: BSD-3-Clause
# scripts/localize_table.sh MRCLAM_FOLDER OUTPUT [BUILD]: every robot of a UTIAS MRCLAM data set
# localised in the map of every robot, from a start nobody knows; two tables of Markdown, with the
# log's identities and with hidden ones.
# SETTINGS: see mrclam_logs.sh.
set -eu
. "$(dirname "$0")/mrclam_logs.sh"
for robot in $robots; do
  log=$out/robot$robot.rawlog
  [ -e "$out/map$robot" ] || "$colonnade" run "$log" $settings -o "$out/map$robot" >"$out/map$robot.txt" 2>&1
done
for use_ids in true false; do
  echo
  echo "RangeBearing.use_ids=$use_ids; ATE [m] online / afterwards, seconds until the place was found:"
  echo
  echo "| map of | 1 | 2 | 3 | 4 | 5 |"
  echo "|---|---|---|---|---|---|"
  for map in $robots; do
    row="| $map |"
    for robot in $robots; do
      run=$out/$map-$robot-$use_ids
      [ -e "$run" ] || "$colonnade" run "$out/robot$robot.rawlog" $settings -o "$run" --localize --start anywhere \
        --map "$out/map$map/map.colonnade" --ground-truth "$out/robot${robot}_ground_truth.tum" \
        --set RangeBearing.use_ids=$use_ids >"$run.txt" 2>&1 || true
      row="$row $(python3 - "$run" <<'PYTHON'
import json, sys
run = sys.argv[1]
stamps = [line.split(",") for line in open(run + "/events.csv").read().split("\n")[1:] if line]
found = [float(event[0]) for event in stamps if event[2] == "place found"]
s = json.load(open(run + "/summary.json"))
if not found:
    print("not found")
else:
    poses = [line for line in open(run + "/trajectory_final.tum") if line[0] != "#"]
    first = float(poses[0].split()[0])
    print("%.3f / %.3f, %.0f" % (s["trajectory"]["ate_rmse_m"], s["trajectory_final"]["ate_rmse_m"],
                                 found[0] - first))
PYTHON
) |"
    done
    echo "$row"
  done
done
