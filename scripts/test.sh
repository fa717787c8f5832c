#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Colonnade authors
# SPDX-License-Identifier: BSD-3-Clause
# Installs what is missing, builds and passes the tests. test.sh [PRESET] [ctest options]
set -euo pipefail
cd "$(dirname "$0")/.."
preset=release
case "${1:-}" in dev | release | asan-ubsan | coverage) preset=$1; shift ;; esac
if [ -z "${COLONNADE_DATA:-}" ] && [ -d ../shared/data ]; then
  COLONNADE_DATA=$(cd ../shared/data && pwd)
  export COLONNADE_DATA
fi
scripts/build.sh "$preset"
ctest --preset "$preset" -j "$(nproc)" "$@"
