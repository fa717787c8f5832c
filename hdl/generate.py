#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Colonnade authors
# SPDX-License-Identifier: BSD-3-Clause
"""Generates what hardware and software share from accelerator.toml.

generate.py            writes the files
generate.py --check    says which committed file differs, exit 1
"""
import math
import pathlib
import sys
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
EDGES = HERE.parent / "modules/edges/include/colonnade/edges"
NOTE = "Made by hdl/generate.py from hdl/accelerator.toml; edit those."
HEAD = ["SPDX-FileCopyrightText: 2026 The Colonnade authors", "SPDX-License-Identifier: BSD-3-Clause"]


def comment(mark):
    return [f"{mark} {line}" for line in HEAD + [NOTE]]


def angles(source):
    """(theta, cos, sin, admitted directions) of every whole degree."""
    scale = 1 << source["fraction_bits"]
    rows = []
    for theta in range(-90, 90):
        reach = [source["admit_axis_deg"], source["admit_diagonal_deg"]]
        admitted = 0
        for direction in range(4):
            apart = abs((theta - 45 * direction + 90) % 180 - 90)
            if apart <= reach[direction % 2]:
                admitted |= 1 << direction
        turn = math.radians(theta)
        rows.append((theta, math.floor(math.cos(turn) * scale + 0.5),
                     math.floor(math.sin(turn) * scale + 0.5), admitted))
    return rows


def sets(source):
    """(name, ascending theta in -90 .. 89) of each angle set."""
    for entry in source["set"]:
        if "angles" in entry:
            yield entry["name"], sorted(theta - 180 if theta >= 90 else theta for theta in entry["angles"])
        else:
            yield entry["name"], [theta for theta in range(-90, 90)
                                  if abs(theta) <= entry["fine_deg"] or theta % 2 == 0]


def expand(registers):
    """(name, offset) of each 32-bit word."""
    for register in registers:
        for i in range(register.get("count", 1)):
            suffix = str(i) if "count" in register else ""
            yield register["name"] + suffix, register["offset"] + 4 * i


def named_fields(registers):
    """(register_field, lowest bit, bits) of each field that has a name."""
    for register in registers:
        for name, low, width in register.get("fields", []):
            yield register["name"] + "_" + name.upper(), low, width


def camel(name):
    return "k" + "".join(part.capitalize() for part in name.lower().split("_"))


def packed(values, bits):
    """A SystemVerilog literal with values[0] in the lowest bits."""
    word = 0
    for i, value in enumerate(values):
        word |= (value & ((1 << bits) - 1)) << (i * bits)
    return f"{len(values) * bits}'h{word:x}"


def system_verilog(source):
    fraction = source["angles"]["fraction_bits"]
    table = angles(source["angles"])
    bits = fraction + 2
    lines = comment("//") + [
        "/// Registers, the line word and the sine table.", "package accelerator_pkg;",
        f"  localparam logic [31:0] ID = 32'h{source['identity']['id']:08X};",
        f"  localparam logic [31:0] VERSION = 32'h{source['identity']['version']:08X};", ""]
    for name, offset in expand(source["register"]):
        lines.append(f"  localparam logic [7:0] REG_{name} = 8'h{offset:02X};")
    lines.append("")
    for name, low, width in named_fields(source["register"]):
        lines.append(f"  localparam int {name}_LSB = {low};" + (f"  // {width} bits" if width > 1 else ""))
    lines += ["", f"  localparam int FRACTION = {fraction};  // bits of the sine table",
              f"  localparam int TRIG_WIDTH = {bits};", "  localparam int ALL_ANGLES = 180;",
              "  // Entry i is theta = i - 90 degrees, entry 0 in the lowest bits."]
    for name, column, width in (("COS", 1, bits), ("SIN", 2, bits), ("ADMIT", 3, 4)):
        literal = packed([row[column] for row in table], width)
        lines += [f"  localparam logic [{width * len(table) - 1}:0] {name}_TABLE =", f"      {literal};"]
    lines += ["", "  // Angle sets: 8 bits for each angle, theta + 90, the first in the lowest bits."]
    for name, members in sets(source):
        literal = packed([theta + 90 for theta in members], 8).split("'")[1]
        lines += [f"  localparam int {name.upper()}_ANGLES = {len(members)};",
                  f"  localparam logic [1439:0] {name.upper()}_SET =", f"      1440'{literal};"]
    low = 0
    lines.append("")
    for name, width in reversed(source["line"]["fields"]):
        lines.append(f"  localparam int LINE_{name.upper()}_LSB = {low};")
        lines.append(f"  localparam int LINE_{name.upper()}_WIDTH = {width};")
        low += width
    assert low == 32
    fields = source["line"]["fields"]
    lines += ["", "  /// A line word of its fields.",
              "  function automatic logic [31:0] line_word(" + ", ".join(
                  f"input logic {'' if width == 1 else f'[{width - 1}:0] '}{name}_i" for name, width in fields) + ");",
              "    line_word = {" + ", ".join(f"{name}_i" for name, _ in fields) + "};", "  endfunction"]
    return "\n".join(lines + ["endpackage", ""])


def cpp_registers(source):
    lines = comment("//") + [
        "#pragma once", "", "#include <cstdint>", "", "namespace colonnade::registers {", "",
        f"inline constexpr std::uint32_t kIdentity = 0x{source['identity']['id']:08X};",
        f"inline constexpr std::uint32_t kInterface = 0x{source['identity']['version']:08X};", "",
        "// Byte offsets, see hdl/REGISTERS.md."]
    for name, offset in expand(source["register"]):
        lines.append(f"inline constexpr std::uint32_t {camel(name)} = 0x{offset:02X};")
    lines += ["", "// Fields of registers: a single bit as a mask, others by lowest bit and width."]
    for name, field_low, width in named_fields(source["register"]):
        if width == 1:
            lines.append(f"inline constexpr std::uint32_t {camel(name)} = 1U << {field_low};")
        else:
            lines.append(f"inline constexpr int {camel(name)}Lsb = {field_low};")
            lines.append(f"inline constexpr int {camel(name)}Width = {width};")
    lines += ["", "// Fields of a line word."]
    low = 0
    for name, width in reversed(source["line"]["fields"]):
        lines.append(f"inline constexpr int kLine{name.capitalize()}Lsb = {low};")
        lines.append(f"inline constexpr int kLine{name.capitalize()}Width = {width};")
        low += width
    return "\n".join(lines + ["", "}  // namespace colonnade::registers", ""])


def cpp_angles(source):
    table = angles(source["angles"])
    lines = comment("//") + [
        "#pragma once", "", "#include <array>", "", "namespace colonnade {", "",
        "/// One direction of lines: x cos(theta) + y sin(theta) = rho.", "struct AngleEntry {",
        "  int theta_deg;", "  int cosine;    ///< times 2^kAngleFraction, rounded",
        "  int sine;      ///< times 2^kAngleFraction, rounded",
        "  int admitted;  ///< bit d: pixels of gradient direction d vote", "};", "",
        f"inline constexpr int kAngleFraction = {source['angles']['fraction_bits']};",
        "inline constexpr int kFirstAngle_deg = -90;", "",
        "/// Entry i is theta = kFirstAngle_deg + i.", "// clang-format off",
        f"inline constexpr std::array<AngleEntry, {len(table)}> kAngleTable = {{{{"]
    lines += [f"    {{{theta}, {c}, {s}, {admitted}}}," for theta, c, s, admitted in table]
    lines += ["}};", "", "// Angle sets, ascending degrees."]
    for name, members in sets(source):
        lines.append(f"inline constexpr std::array<int, {len(members)}> {camel(name)}Set = {{")
        lines += ["    " + ", ".join(str(theta) for theta in members[i:i + 18]) + ","
                  for i in range(0, len(members), 18)]
        lines.append("};")
    return "\n".join(lines + ["// clang-format on", "", "}  // namespace colonnade", ""])


def documentation(source):
    lines = ["# Registers of the accelerator", "", f"<!-- {NOTE} -->", "",
             "32-bit words on AXI4-Lite. `ro` read only, `rw` read and write, `w1t` ones toggle, `w1c` ones clear.", "",
             "| offset | name | access | meaning |", "|---|---|---|---|"]
    for register in source["register"]:
        count = register.get("count", 1)
        offset = f"0x{register['offset']:02X}"
        if count > 1:
            offset += f" .. 0x{register['offset'] + 4 * (count - 1):02X}"
        meaning = register["meaning"].replace("|", "\\|")
        lines.append(f"| {offset} | {register['name']} | {register['access']} | {meaning} |")
    fields = ", ".join(f"{name} ({width})" for name, width in source["line"]["fields"])
    lines += ["", f"A line word, from bit 31 down: {fields}; theta (degrees, -90 to 89) and rho (pixels from the centre) are signed."]
    return "\n".join(lines + [""])


def main():
    source = tomllib.loads((HERE / "accelerator.toml").read_text())
    files = {HERE / "rtl/accelerator_pkg.sv": system_verilog(source),
             EDGES / "accelerator_registers.hpp": cpp_registers(source),
             EDGES / "angle_table.hpp": cpp_angles(source),
             HERE / "REGISTERS.md": documentation(source)}
    stale = [path for path, text in files.items() if not path.exists() or path.read_text() != text]
    if "--check" in sys.argv[1:]:
        for path in stale:
            print(f"{path.relative_to(HERE.parent)} differs from accelerator.toml; run hdl/generate.py")
        return 1 if stale else 0
    for path in stale:
        path.write_text(files[path])
    return 0


if __name__ == "__main__":
    sys.exit(main())
