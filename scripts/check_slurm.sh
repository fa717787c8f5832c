#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Colonnade authors
# SPDX-License-Identifier: BSD-3-Clause
# Runs a small campaign as a job array on a real one-node Slurm on the loopback, and compares its
# table with the one the program makes by itself. Needs root: it installs Debian's slurm-wlm and
# munge and starts their daemons with a configuration of its own in a scratch folder. Not part of
# test.sh. check_slurm.sh [PROGRAM]
set -euo pipefail
cd "$(dirname "$0")/.."
program=$(realpath "${1:-build/release/apps/colonnade/colonnade}")
if ! command -v slurmctld slurmd sbatch munged >/dev/null; then
  apt-get install -y --no-install-recommends slurm-wlm munge >/dev/null
fi

scratch=$(mktemp -d)
chmod 755 "$scratch"
pids=()
finish() {
  for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; done
  for pid in "${pids[@]}"; do wait "$pid" 2>/dev/null || true; done
  rm -rf "$scratch"
}
trap finish EXIT

# munged insists on a key and a socket that only its user can write.
mkdir -p "$scratch"/munge "$scratch"/state "$scratch"/spool
chmod 755 "$scratch/munge"
head -c 128 /dev/urandom >"$scratch/munge/key"
chmod 400 "$scratch/munge/key"
munged --foreground --force --key-file="$scratch/munge/key" --socket="$scratch/munge/socket" \
  --pid-file="$scratch/munge/pid" --log-file="$scratch/munge/log" \
  --seed-file="$scratch/munge/seed" &
pids+=($!)
# 127.0.0.1 has a port free where the kernel says so.
free_port() { python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'; }
cat >"$scratch/slurm.conf" <<CONF
ClusterName=loopback
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$scratch/munge/socket
CredType=cred/munge
StateSaveLocation=$scratch/state
SlurmdSpoolDir=$scratch/spool
SlurmctldPidFile=$scratch/slurmctld.pid
SlurmdPidFile=$scratch/slurmd.pid
SlurmctldLogFile=$scratch/slurmctld.log
SlurmdLogFile=$scratch/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=2
MpiDefault=none
ReturnToService=2
JobCompType=jobcomp/none
AccountingStorageType=accounting_storage/none
NodeName=$(hostname -s) NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF=$scratch/slurm.conf
slurmctld -D &
pids+=($!)
slurmd -D &
pids+=($!)
for _ in $(seq 120); do
  state=$(sinfo --noheader --format=%T 2>/dev/null || true)
  if [ "$state" = idle ]; then break; fi
  sleep 0.5
done
if [ "$state" != idle ]; then
  tail -n 20 "$scratch"/*.log
  echo "check_slurm: the node did not come up: $state" >&2
  exit 1
fi

cat >"$scratch/hall.world" <<'WORLD'
room hall -1 -1  4 -1  4 1  -1 1  hallway=0
pilaster wall=hall.1 at_m=2.6
camera width_px=160 height_px=120 rate_hz=5
start 0 0 heading_deg=0
drive 1.6 0 speed_m_per_s=0.8
WORLD
cat >"$scratch/hall.campaign" <<'CAMPAIGN'
world hall hall.world
world slow hall.world camera.rate_hz=4
seeds 1..2
configuration default
configuration plain_ekf Filter.invariant=false
CAMPAIGN

"$program" campaign "$scratch/hall.campaign" -o "$scratch/slurm" --slurm
mapfile -t jobs < <("$scratch/slurm/submit.sh")
echo "submitted: array ${jobs[0]}, table ${jobs[1]}"
for _ in $(seq 600); do
  if [ -z "$(squeue --noheader 2>/dev/null)" ]; then break; fi
  sleep 1
done
scontrol show job "${jobs[0]}" | grep -oE 'ArrayTaskId=[0-9]+|JobState=[A-Z]+|ExitCode=[0-9:]+' | paste - - -
failed=0
if scontrol show job "${jobs[0]}" | grep -oE 'JobState=[A-Z]+' | grep -qv COMPLETED; then failed=1; fi
if ! scontrol show job "${jobs[1]}" | grep -q JobState=COMPLETED; then failed=1; fi
tail -n +1 "$scratch"/slurm/slurm/task-*.txt

"$program" campaign "$scratch/hall.campaign" -o "$scratch/local" --jobs 1 >/dev/null
# All columns but those of timing, which stand last, behind the NEES at the end of the run.
untimed() {
  awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "nees_at_100") last = i }
           { line = $1; for (i = 2; i <= last; ++i) line = line "," $i; print line }' "$1"
}
if [ $failed -ne 0 ] || ! diff <(untimed "$scratch/slurm/campaign.csv") <(untimed "$scratch/local/campaign.csv"); then
  tail -n 20 "$scratch"/*.log "$scratch"/slurm/slurm/*.txt
  echo "check_slurm: failed" >&2
  exit 1
fi
grep -A6 '^## Accuracy' "$scratch/slurm/campaign.md"
echo "check_slurm: $(($(wc -l <"$scratch/slurm/campaign.csv") - 1)) runs, the same table by Slurm and without"
