# SPDX-FileCopyrightText: 2026 The Colonnade authors
# SPDX-License-Identifier: BSD-3-Clause
# Read by the scripts that run a UTIAS MRCLAM data set: MRCLAM_FOLDER OUTPUT [BUILD] of their command
# line, and the log of each robot in OUTPUT, made where there is none. SETTINGS in the environment are
# further options of every run, such as "--set RangeBearing.estimate_sensor=true".
out=$2 build=${3:-build/release} settings=${SETTINGS:-}
colonnade=$build/apps/colonnade/colonnade
robots="1 2 3 4 5"
mkdir -p "$out"
for robot in $robots; do
  [ -e "$out/robot$robot.rawlog" ] ||
    "$colonnade" import mrclam "$1" --robot "$robot" -o "$out/robot$robot.rawlog" >"$out/import$robot.txt" 2>&1
done
