#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Colonnade authors
# SPDX-License-Identifier: BSD-3-Clause
"""Line and toggle coverage of the RTL, by module: coverage.py [-o FILE.json]

Builds three designs with verilator --coverage and runs bench/coverage.cpp on each; a point counts as
covered when one of the designs reaches it. Four minutes of one core.
"""
import collections
import json
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
DESIGNS = [  # small, so that they compile soon and frames are many; frames
    ({"WIDTH": 48, "HEIGHT": 40, "PPC": 1, "PASSES": 2, "SET": 0, "BANKS": 0}, 60),
    ({"WIDTH": 64, "HEIGHT": 32, "PPC": 2, "PASSES": 1, "SET": 0, "BANKS": 0}, 40),
    ({"WIDTH": 64, "HEIGHT": 32, "PPC": 4, "PASSES": 0, "SET": 0, "BANKS": 3}, 40),
]


def points(design, frames, folder):
    files = [str(HERE / "rtl" / line) for line in (HERE / "rtl/files.f").read_text().split("\n")
             if line and not line.startswith("//")]
    defines = " ".join(f"-DCOVERED_{name}={design[name]}" for name in ("WIDTH", "HEIGHT", "PPC"))
    subprocess.run(["verilator", "--cc", "--exe", "--build", "-j", "1", "--prefix", "VCovered", "--top-module",
                    "accelerator", "--coverage-line", "--coverage-toggle", "--Mdir", folder,
                    "-CFLAGS", f"-std=c++20 -O0 -I{HERE / 'bench'} {defines}",
                    *[f"-G{name}={value}" for name, value in design.items()],
                    str(HERE / "lint/waivers.vlt"), *files, str(HERE / "bench/coverage.cpp")],
                   check=True, stdout=subprocess.DEVNULL)
    data = pathlib.Path(folder) / "coverage.dat"
    subprocess.run([f"{folder}/VCovered", str(data), str(frames)], check=True)
    for line in data.read_text(errors="replace").split("\n"):
        match = re.match(r"C '(.*)' (\d+)$", line)
        if not match:
            continue
        fields = dict(part.split("\x02", 1) for part in match.group(1).split("\x01") if "\x02" in part)
        kind = fields["page"].split("/")[0]
        module = pathlib.Path(fields["f"]).stem
        yield (kind, module, fields["l"], fields["n"], fields["o"]), int(match.group(2))


def main():
    hits = collections.Counter()
    for design, frames in DESIGNS:
        with tempfile.TemporaryDirectory() as folder:
            for point, count in points(design, frames, folder):
                hits[point] += count
    table = collections.defaultdict(lambda: {"line": [0, 0], "toggle": [0, 0]})
    for (kind, module, *_), count in hits.items():
        entry = table[module]["toggle" if "toggle" in kind else "line"]
        entry[0] += count > 0
        entry[1] += 1
    total = {kind: [sum(m[kind][i] for m in table.values()) for i in (0, 1)] for kind in ("line", "toggle")}
    for name, entry in [*sorted(table.items()), ("all", total)]:
        print(f"{name:20}" + "".join(f"  {kind} {a:5} of {b:5} {100 * a / max(b, 1):5.1f} %"
                                     for kind, (a, b) in entry.items()))
    missed = sorted({(p[1], int(p[2]), p[4]) for p, count in hits.items() if count == 0 and "toggle" not in p[0]})
    for module, line, what in missed:
        print(f"never reached: {module}.sv:{line} {what}")
    if sys.argv[1:2] == ["-o"]:
        pathlib.Path(sys.argv[2]).write_text(json.dumps({"modules": table, "all": total}, indent=1) + "\n")


if __name__ == "__main__":
    main()
