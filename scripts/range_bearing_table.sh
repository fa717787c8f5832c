#!/bin/sh
# SPDX-FileCopyrightText: 2026 The Colonnade authors
# SPDX-License-Identifier: BSD-3-Clause
# scripts/range_bearing_table.sh MRCLAM_FOLDER OUTPUT [BUILD]: the robots of a UTIAS MRCLAM data set
# through Colonnade and MRPT's kf-slam with one set of sigmas; one line of Markdown for each run.
# SETTINGS: see mrclam_logs.sh.
set -eu
. "$(dirname "$0")/mrclam_logs.sh"
figures() {  # ROBOT NAME TRAJECTORY LANDMARKS SUMMARY FINAL_TRAJECTORY
  smoothed="{}"
  [ -z "${6:-}" ] || smoothed=$("$colonnade" evaluate "$6" --ground-truth "$out/robot$1_ground_truth.tum" \
    --landmarks "$4" --truth-landmarks "$out/robot$1_landmarks.csv" --gate 2 --json)
  "$colonnade" evaluate "$3" --ground-truth "$out/robot$1_ground_truth.tum" \
    --json |
    python3 -c '
import json, math, sys
robot, name, landmarks, truth, summary, smoothed = sys.argv[1:]
T, smoothed = json.load(sys.stdin), json.loads(smoothed)
T = T.get("trajectory", T)
final = "%.3f" % smoothed.get("trajectory", smoothed)["ate_rmse_m"] if smoothed else ""
error = "|"
if landmarks:
    rows = lambda f: [l.split(",") for l in open(f).read().split("\n")[1:] if l]
    true = {int(r[0]): (float(r[2]), float(r[3])) for r in rows(truth)}
    here = {int(r[0]): (float(r[2]), float(r[3])) for r in rows(landmarks)}
    ids = sorted(set(true) & set(here))
    if name.startswith("c"):
        kind = smoothed["landmarks"]["pillar"]
        error = "%d | rmse %s" % (len(here), kind["position_rmse_m"] and round(kind["position_rmse_m"], 3))
    elif len(ids) > 1:  # rigid fit of the map onto the truth, by identity
        n = len(ids)
        c = [sum(here[i][k] for i in ids) / n for k in (0, 1)]
        d = [sum(true[i][k] for i in ids) / n for k in (0, 1)]
        s = [((here[i][0]-c[0], here[i][1]-c[1]), (true[i][0]-d[0], true[i][1]-d[1])) for i in ids]
        a = math.atan2(sum(p[0]*q[1]-p[1]*q[0] for p, q in s), sum(p[0]*q[0]+p[1]*q[1] for p, q in s))
        e = [math.hypot(math.cos(a)*p[0]-math.sin(a)*p[1]-q[0], math.sin(a)*p[0]+math.cos(a)*p[1]-q[1]) for p, q in s]
        error = "%d | %.3f / %.3f" % (n, sum(e) / n, max(e))
right = ""
if summary:
    right = "%.1f %%" % (100 * json.load(open(summary))["association"]["right_share"])
print("| %s | %s | %.3f | %s | %.1f | %s | %s |" % (robot, name, T["ate_rmse_m"], final, T["heading_rmse_deg"], error, right))
' "$1" "$2" "$4" "$out/robot$1_landmarks.csv" "$5" "$smoothed"
}
echo "| robot | method | ATE [m] | ATE of trajectory_final [m] | heading [deg] | landmarks | their error, mean / largest [m] | right associations |"
echo "|---|---|---|---|---|---|---|---|"
for robot in $robots; do
  log=$out/robot$robot.rawlog
  for method in a b c; do
    case $method in
      a) name="a) range and bearing" set="RangeBearing.use_ids=true" ;;
      b) name="b) bearing only" set="RangeBearing.bearing_only=true" ;;
      c) name="c) identities hidden" set="RangeBearing.use_ids=false" ;;
    esac
    folder=$out/$robot$method
    [ -e "$folder" ] || "$colonnade" run "$log" $settings -o "$folder" --set $set >"$folder.txt" 2>&1
    figures $robot "$name" "$folder/trajectory.tum" "$folder/landmarks.csv" "$folder/summary.json" \
      "$folder/trajectory_final.tum"
  done
  "$build/tests/slam/kf_slam_log" "$log" "$out/$robot.tum" "$out/$robot.csv" 0.05 0.6
  figures $robot "e) MRPT kf-slam" "$out/$robot.tum" "$out/$robot.csv" ""
  [ -e "$out/${robot}d" ] ||
    "$colonnade" baseline dead-reckoning "$log" -o "$out/${robot}d" >"$out/${robot}d.txt" 2>&1
  figures $robot "d) dead reckoning" "$out/${robot}d/trajectory.tum" "" ""
done
