#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The Colonnade authors
# SPDX-License-Identifier: BSD-3-Clause
# Verilator with all warnings over the parameter sets in use; waivers.vlt holds the exceptions.
set -euo pipefail
cd "$(dirname "$0")/../rtl"
mapfile -t files < <(grep -v '^//' files.f)
for parameters in "-GPPC=1 -GPASSES=0" "-GPPC=2" "-GPPC=4 -GPASSES=1" \
  "-GWIDTH=320 -GHEIGHT=240 -GPASSES=4 -GSET=1 -GBANKS=18" "-GWIDTH=640 -GHEIGHT=480 -GPASSES=4 -GSET=1 -GBANKS=18" \
  "-GWIDTH=640 -GHEIGHT=480 -GPPC=4 -GSET=2 -GBANKS=20"; do
  # shellcheck disable=SC2086
  verilator --lint-only -Wall --top-module accelerator $parameters ../lint/waivers.vlt "${files[@]}"
done
