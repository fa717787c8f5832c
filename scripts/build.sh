#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Colonnade authors
# SPDX-License-Identifier: BSD-3-Clause
# build.sh PRESET [TARGET ...]: installs what is missing, configures and builds.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=$1
shift
scripts/install.sh
cmake --preset "$preset" >/dev/null
# About 0.6 GB of memory for each compiler.
jobs=$(nproc)
memory_jobs=$(($(awk '/MemAvailable/ {print $2}' /proc/meminfo) / 700000))
[ "$memory_jobs" -lt "$jobs" ] && jobs=$((memory_jobs > 0 ? memory_jobs : 1))
targets=()
[ $# -gt 0 ] && targets=(--target "$@")
cmake --build --preset "$preset" -j "$jobs" "${targets[@]}"
