#!/bin/sh
# SPDX-FileCopyrightText: 2026 The Colonnade authors
# SPDX-License-Identifier: BSD-3-Clause
# scripts/hidden_settings.sh MRCLAM_FOLDER OUTPUT [BUILD]: the robots of a UTIAS MRCLAM data set with
# hidden identities under several settings, a line of Markdown for each, and the mean of all.
# SETTINGS: see mrclam_logs.sh.
set -eu
. "$(dirname "$0")/mrclam_logs.sh"
echo "ATE [m] online / afterwards, right associations:"
echo
echo "| sigmas, hypotheses | 1 | 2 | 3 | 4 | 5 |"
echo "|---|---|---|---|---|---|"
for setting in "0.05 0.6 40" "0.05 1.0 40" "0.07 1.0 40" "0.1 1.0 40" "0.05 0.6 25" "0.07 0.8 60"; do
  set -- $setting
  row="| $1 m, $2 degrees, $3 |"
  for robot in $robots; do
    run=$out/$robot-$1-$2-$3
    [ -e "$run" ] || "$colonnade" run "$out/robot$robot.rawlog" $settings -o "$run" --ground-truth "$out/robot${robot}_ground_truth.tum" \
      --set RangeBearing.use_ids=false --set RangeBearing.range_sigma_m="$1" --set RangeBearing.bearing_sigma_deg="$2" \
      --set RangeBearing.hypotheses="$3" >"$run.txt" 2>&1
    row="$row $(python3 -c '
import json, sys
s = json.load(open(sys.argv[1] + "/summary.json"))
ate = [s[t]["ate_rmse_m"] for t in ("trajectory", "trajectory_final")]
right = s["association"]["right_share"]
open(sys.argv[2], "a").write("%r %r %r\n" % (*ate, right))
print("%.3f / %.3f, %.1f %%" % (*ate, 100 * right))' "$run" "$out/all.$$") |"
  done
  echo "$row"
done
python3 -c '
import sys
online, final, right = zip(*(map(float, line.split()) for line in open(sys.argv[1])))
mean = lambda v: sum(v) / len(v)
print("\nmean %.3f / %.3f, largest %.3f / %.3f, right %.1f %%" % (mean(online), mean(final), max(online), max(final), 100 * mean(right)))' "$out/all.$$"
rm "$out/all.$$"
