#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Colonnade authors
# SPDX-License-Identifier: BSD-3-Clause
# Installs what is missing, builds, and maps the corridor in rawlogs/.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/build.sh release colonnade_program
build/release/apps/colonnade/colonnade run rawlogs/corridor.rawlog \
  --ground-truth rawlogs/corridor_ground_truth.tum "$@"
