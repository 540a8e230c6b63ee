# SPDX-License-Identifier: Apache-2.0
"""File lists by which other tools read the RTL: dtof.core (FuseSoC), Bender.yml and hdl/dtof_no_srams.f,
written from hdl/dtof.f and readouts.toml by scripts/generate.py."""

import json
import re
from pathlib import Path

from dtof_synth.errors import FlowError, found_in
from dtof_synth.readouts import Table

ROOT = Path(__file__).resolve().parent.parent
WRITTEN = "Written by scripts/generate.py from hdl/dtof.f"
OWN_SRAMS = "own_srams"  # flag of FuseSoC: the stand-ins of the SRAMs are left out
OWN_SRAMS_BENDER = "tech_override"  # the same as a target of Bender
# Beside the parameters of the arrays, those of dtof_subsystem and of the bench.
READOUT = "dtof_pkg::READOUT_*: {}"
SUBSYSTEM = {
    "CLOCK_WAITS": "1: the array's clock waits for lines, behind a clock gate that works",
    "SOURCE_WAITS": "0: TDCs that cannot wait; where there is no room, whole acquisitions are dropped",
    "BUFFER_LINES": "lines that the line buffer holds",
    "RASTER_ORDER": "1: results come row by row, for a memory of all of them",
    "PARITY": "1: words of all SRAMs have parity bits",
    "SELF_TEST": "1: built-in self-test, which gives every column pseudo-random timestamps and compares a checksum",
}
BENCH = {"ACQUISITIONS": "of the example's frame"}


def version_in(text: str) -> str:
    """The project's version, from the text of CMakeLists.txt."""
    return found_in("CMakeLists.txt", r"^project\(dtof_readout VERSION (\S+)", text)[1]


def version() -> str:
    return version_in((ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))


def split(text: str) -> tuple[list[str], list[str], list[str]]:
    """The files of hdl/dtof.f in three lists: package, technology, all others."""
    files = [line for line in text.splitlines() if re.fullmatch(r"[a-z_/0-9]+\.sv", line)]
    part = lambda folder: [name for name in files if name.startswith(folder)]  # noqa: E731
    package, technology = [name for name in files if name.endswith("_pkg.sv")], part("technology/behavioural/")
    rest = [name for name in files if name not in package and not name.startswith("technology/")]
    if not package or not technology or not rest:
        raise FlowError("hdl/dtof.f has no package, no technology or nothing else")
    return package, technology, rest


def without_srams(listing: str) -> str:
    package, _, rest = split(listing)
    return "\n".join([
        "// SPDX-License-Identifier: Apache-2.0",
        f"// {WRITTEN}: all RTL without the technology folder, for a process's own dtof_sram_1rw.sv, dtof_sram_1r1w.sv and dtof_clock_gate.sv:",
        "//   verilator --lint-only -f dtof_no_srams.f my_srams/dtof_sram_1rw.sv my_srams/dtof_sram_1r1w.sv my_srams/dtof_clock_gate.sv --top-module dtof_subsystem",
        "+incdir+common",
        *package,
        *rest,
        "",
    ])  # fmt: skip


def entries(names: list[str], indent: int) -> list[str]:
    """File names below hdl/ as list entries relative to the root."""
    return [f"{' ' * indent}- hdl/{name}" for name in names]


def parameters(table: Table) -> dict[str, str]:
    """Names and help texts of the free parameters of dtof_subsystem."""
    numbers = [(readout.number, readout.title) for readout in table.readouts.values() if readout.number is not None]
    numbers += [(top.readout, next(readout.title for readout in table.readouts.values() if readout.top == top.name))
                for top in table.tops.values() if top.readout is not None]  # fmt: skip
    names = dict.fromkeys(name for top in table.tops.values() if top.name == "dtof_array" or top.readout is not None
                          for name in (*top.parameters, *top.schedule))  # fmt: skip
    return ({"READOUT": READOUT.format(", ".join(f"{number} {title}" for number, title in numbers))}
            | {name: table.parameters[name].help for name in names} | SUBSYSTEM)  # fmt: skip


def fusesoc(table: Table, listing: str, includes: list[str]) -> str:
    """`includes`: the included files, from hdl/."""
    package, technology, rest = split(listing)
    for_fpga = [name.replace("/behavioural/", "/fpga/") for name in technology]
    chosen = parameters(table)
    described = [line for name, text in (chosen | BENCH).items() for line in (
        f"  {name}:", "    datatype: int", f"    description: {json.dumps(text, ensure_ascii=False)}", "    paramtype: vlogparam")]
    return "\n".join([
        "CAPI=2:",
        "# SPDX-License-Identifier: Apache-2.0",
        f"# {WRITTEN} and readouts.toml.",
        f"# --flag={OWN_SRAMS}: without the technology folder, for a core of one's own that has dtof_sram_1rw, dtof_sram_1r1w and dtof_clock_gate.",
        f"name: dtof:readout:dtof_array:{version()}",
        "description: Read-out of large SPAD arrays, TDC timestamps to depth codes",
        "filesets:",
        "  rtl:",
        "    files:",
        *entries([f"{name}: {{is_include_file: true, include_path: hdl/common}}" for name in includes], 6),
        *entries([*package, *rest], 6),
        "    file_type: systemVerilogSource",
        "  srams:",
        "    files:",
        *entries(technology, 6),
        "    file_type: systemVerilogSource",
        "  srams_fpga:",
        "    files:",
        *entries(for_fpga, 6),
        "    file_type: systemVerilogSource",
        "  bench:",
        "    files:",
        "      - examples/example_bench.sv",
        "    file_type: systemVerilogSource",
        "  waivers:",
        "    files:",
        "      - hdl/lint/verilator.vlt: {file_type: vlt}",
        "targets:",
        "  default: &default",
        f'    filesets: [rtl, "!{OWN_SRAMS}? (srams)"]',
        "    toplevel: dtof_subsystem",
        "  lint:",
        "    <<: *default",
        f'    filesets: [waivers, rtl, "!{OWN_SRAMS}? (srams)"]',
        "    default_tool: verilator",
        f"    parameters: [{', '.join(chosen)}]",
        "    tools:",
        "      verilator:",
        "        mode: lint-only",
        "        verilator_options: [-Wall]",
        "  sim:",
        f'    filesets: [rtl, "!{OWN_SRAMS}? (srams)", bench]',
        "    toplevel: example_bench",
        "    default_tool: icarus",
        f"    parameters: [READOUT, {', '.join(BENCH)}]",
        "    tools:",
        "      icarus:",
        "        iverilog_options: [-g2012]",
        "  synth:",
        "    <<: *default",
        f'    filesets: [rtl, "!{OWN_SRAMS}? (srams_fpga)"]',
        "    default_tool: yosys",
        # Memories and clock gate are those of hdl/technology/fpga, where no clock rests.
        f"    parameters: [{', '.join('CLOCK_WAITS=0' if name == 'CLOCK_WAITS' else name for name in chosen)}]",
        "    tools:",
        "      yosys:",
        "        arch: ice40",
        "        output_format: json",
        "parameters:",
        *described,
        "",
    ])  # fmt: skip


def bender(listing: str) -> str:
    package, technology, rest = split(listing)
    return "\n".join([
        "# SPDX-License-Identifier: Apache-2.0",
        f"# {WRITTEN}. -t {OWN_SRAMS_BENDER}: without the technology folder, for one's own dtof_sram_1rw, dtof_sram_1r1w and dtof_clock_gate.",
        "package:",
        "  name: dtof_readout",
        "",
        "export_include_dirs:",
        "  - hdl/common",
        "",
        "sources:",
        "  - include_dirs: [hdl/common]",
        "    files:",
        *entries(package, 6),
        f"  - target: not({OWN_SRAMS_BENDER})",
        "    files:",
        *entries(technology, 6),
        "  - include_dirs: [hdl/common]",
        "    files:",
        *entries(rest, 6),
        "",
    ])  # fmt: skip


def included(hdl: Path) -> list[str]:
    """Files that the RTL includes."""
    return sorted(str(file.relative_to(hdl)) for file in hdl.glob("common/*.svh"))
