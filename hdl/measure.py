#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Colonnade authors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures resources and clock rates of the RTL with yosys and nextpnr-ice40 into measured.json.

measure.py                 measures whatever is not of the committed RTL; about 10 minutes of one core for all
measure.py NAME ...        only these entries, again
measure.py --check         says which entry is not of this RTL, exit 1; needs no tool
"""
import hashlib
import json
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
TARGET = HERE / "measured.json"
FILES = [HERE / "rtl" / line for line in (HERE / "rtl/files.f").read_text().split("\n")
         if line and not line.startswith("//")] + [HERE / "measure/image_stage.sv"]

# Figure 67's and figure 53's configuration: 120x120, one pixel per clock, twelve angles, one threshold.
CANNY = {"WORDS": 120, "PASSES": 0}
SHARED = {"WIDTH": 120, "HEIGHT": 120, "REACH": 86}
WHAT = {
    "canny": ("canny", CANNY, "Canny, one threshold"),
    "canny_hysteresis": ("canny", {**CANNY, "PASSES": 2}, "Canny, two passes of hysteresis"),
    "hough": ("hough_parallel", {}, "Hough, the thesis' twelve angles"),
    "hough_generic": ("hough_shared", SHARED, "Hough, 180 angles in 20 shared memories"),
    "accelerator": ("accelerator", {"PASSES": 4}, "all with four passes of hysteresis, queues and buses"),
    "image_stage": ("image_stage", {}, "Canny, one threshold, and Hough, the thesis' twelve angles"),
}
SYNTHESIS = [(design, family) for design in ("canny", "hough", "hough_generic", "accelerator")
             for family in ("xc6s", "xc7")]
OPERATIONS = ["canny", "hough", "hough_generic"]
RATES = ["canny", "canny_hysteresis", "image_stage"]
SEEDS = range(1, 6)
# Mapped module by module: flattened, the angles side by side take yosys more than four minutes.
HIERARCHICAL = ["hough_generic"]


def fingerprint():
    digest = hashlib.sha256()
    for path in FILES:
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def run(command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"measure.py: {command[0]} failed:\n{done.stdout[-2000:]}")
    return done.stdout


def yosys(design, passes):
    top, parameters, _ = WHAT[design]
    chosen = " ".join(f"-set {name} {value}" for name, value in parameters.items())
    return run(["yosys", "-Q", "-T", "-e", "implicitly declared", "-p",
                f"read_verilog -sv {' '.join(map(str, FILES))}; " +
                (f"chparam {chosen} {top}; " if chosen else "") + passes.format(top=top)])


def cells(report):
    """name -> number, of the last statistics in a report."""
    last = report.rsplit("Number of cells:", 1)[1]
    return {name: int(number) for name, number in re.findall(r"^ +(\S+) +(\d+)$", last, re.M)}


def synthesis(design, family):
    flatten = "" if design in HIERARCHICAL else " -flatten"
    count = cells(yosys(design, f"synth_xilinx -family {family} -top {{top}}{flatten}; stat"))

    def total(pattern):
        return sum(number for name, number in count.items() if re.fullmatch(pattern, name))
    return {"lut": total(r"LUT\d"), "shift_register_lut": total(r"SRL.*"), "inverter": total("INV"),
            "flip_flop": total(r"FD.*"), "carry": total(r"CARRY4"),
            "lut_memory": total(r"RAM\d+[MX].*"), "block_memory_half": total(r"RAMB8.*|RAMB18.*"),
            "block_memory_whole": total(r"RAMB16.*|RAMB36.*"), "dsp": total(r"DSP.*")}


def operations(design):
    """Counted as the thesis' tool does: operators of whole words, before mapping."""
    count = cells(yosys(design, "hierarchy -top {top}; proc; flatten; opt -full; wreduce; memory_dff; "
                                "opt; stat -width"))

    def total(pattern, bits=False):
        found = 0
        for name, number in count.items():
            match = re.fullmatch(pattern + r"_(\d+)(?:_.*)?", name)
            if match:
                found += number * (int(match.group(1)) if bits else 1)
        return found
    return {"adders_subtractors": total(r"\$(?:add|sub|neg|alu)"), "multipliers": total(r"\$mul"),
            "register_bits": total(r"\$(?:s|a)?dff(?:e|ce)?", bits=True),
            "comparators": total(r"\$(?:lt|le|gt|ge|eq|ne)"), "multiplexers": total(r"\$p?mux")}


def rate(design):
    with tempfile.TemporaryDirectory() as folder:
        netlist = folder + "/netlist.json"
        yosys(design, f"synth_ice40 -top {{top}} -json {netlist}")
        found = []
        for seed in SEEDS:
            report = run(["nextpnr-ice40", "--hx8k", "--package", "ct256", "--json", netlist, "--freq", "200",
                          "--timing-allow-fail", "--pcf-allow-unconstrained", "--seed", str(seed)])
            found.append(float(re.findall(r"Max frequency for clock .*?: ([\d.]+) MHz", report)[-1]))
        used = {name.lower(): [int(a), int(b)] for name, a, b in
                re.findall(r"ICESTORM_(LC|RAM): +(\d+)/ *(\d+)", report)}
    return {"part": "iCE40 HX8K", "seeds_mhz": found, "median_mhz": statistics.median(found),
            "logic_cells": used["lc"], "block_memories": used["ram"]}


def plan():
    """name -> (kind, design, how to measure)."""
    entries = {f"{d}.{f}": ("synthesis", d, lambda d=d, f=f: synthesis(d, f)) for d, f in SYNTHESIS}
    entries |= {f"{d}.operations": ("operations", d, lambda d=d: operations(d)) for d in OPERATIONS}
    entries |= {f"{d}.ice40": ("rate", d, lambda d=d: rate(d)) for d in RATES}
    return entries


def main():
    entries, rtl = plan(), fingerprint()
    measured = json.loads(TARGET.read_text()) if TARGET.exists() else {"entries": {}}

    def is_stale(name):
        entry = measured["entries"].get(name, {})
        return entry.get("rtl_sha256") != rtl or entry.get("parameters") != WHAT[entries[name][1]][1]
    stale = [name for name in entries if is_stale(name)]
    if sys.argv[1:] == ["--check"]:
        for name in stale:
            print(f"measured.json: {name} is not of this RTL; run hdl/measure.py")
        return 1 if stale else 0
    unknown = [name for name in sys.argv[1:] if name not in entries]
    if unknown:
        sys.exit(f"measure.py: no entry {unknown[0]}; there are: {' '.join(entries)}")
    tools = {"yosys": run(["yosys", "-V"]).split()[1],
             "nextpnr-ice40": run(["nextpnr-ice40", "--version"]).split("Version ")[1].strip().rstrip(")")}
    for name in sys.argv[1:] or stale:
        kind, design, how = entries[name]
        result = {"kind": kind, "design": design, "what": WHAT[design][2], "parameters": WHAT[design][1], "rtl_sha256": rtl,
                  "tools": tools} | how()
        print(name, {key: value for key, value in result.items() if key not in ("tools", "rtl_sha256")}, flush=True)
        measured["entries"][name] = result
        measured["entries"] = {key: measured["entries"][key] for key in entries if key in measured["entries"]}
        TARGET.write_text(json.dumps(measured, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
