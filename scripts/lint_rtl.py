#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Reads the RTL of every named configuration, the subsystem around every read-out, the FPGA demonstrator, the shuttle chip and the SoC example with
Verilator -Wall, Yosys and Icarus Verilog.

Also checks that illegal parameters stop elaboration with their sentence and the last legal ones do not
(hdl/lint/parameter_limits.csv), that no construct is used which a tool is known
to read wrongly, that hdl/dtof.f reads in all three tools as its head says, and that the SRAM stand-ins become
block RAM. Where slang is installed (make lint-slang), it reads the tops, too. Exits non-zero with the tool's message.
--quick, behind a build of the tests: Yosys alone reads the arrays of a thousand columns, at which the other tools work for a minute; Verilator
alone reads the other last legal parameters; and Verilator does not read again what the build has verilated with -Wall: the configurations
of dtof_array, of which Yosys reads no variant, and the subsystem of each read-out.
"""

import re
import subprocess
import tempfile
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import rtl_rules
import slang
from dtof_synth import program, readouts, statistics
from dtof_synth.configuration import Configuration, load
from dtof_synth.errors import FlowError

ROOT = Path(__file__).resolve().parent.parent
HDL = ROOT / "hdl"
SIZE = slang.TOPS
SUBSYSTEM = "dtof_subsystem"
IN_FRONT: dict[str, dict[str, int]] = {
    "dtof_axi_lite_to_apb": {"ADDR_WIDTH": 12}, "dtof_reset_synchroniser": {},
    "dtof_async_line_fifo": {"WIDTH": 12, "DEPTH": 2}}  # what stands in front of it
DEMONSTRATOR = "demonstrator"  # an FPGA around it, in fpga/
SOC = "soc"  # a chip around it, in examples/soc/
SHUTTLE = "dtof_shuttle_pads"  # a chip in open silicon, in shuttle/
# The cells that this chip names: the clock gate and the pads of IHP's library.
SHUTTLE_CELLS = """module sg13g2_lgcp_1 (input CLK, input GATE, output GCLK); assign GCLK = CLK & GATE; endmodule
module sg13g2_IOPadIn (inout pad, output p2c); assign p2c = pad; endmodule
module sg13g2_IOPadOut4mA (inout pad, input c2p); assign pad = c2p; endmodule
module sg13g2_IOPadVdd; endmodule
module sg13g2_IOPadVss; endmodule
module sg13g2_IOPadIOVdd; endmodule
module sg13g2_IOPadIOVss; endmodule
"""
PARAMETER_LIMITS = HDL / "lint" / "parameter_limits.csv"
MISREAD = [  # pattern in the RTL, and what is wrong with it
    (re.compile(r"\b(?:localparam|parameter)\b[^;=]*=\s*'1\b"),
     "a parameter is set to '1, which Yosys 0.23 folds to the value 1 where it has a type: write {WIDTH{1'b1}}"),
]
# A name that nobody has declared is an error in every file, and no wire of one bit; what a user's files declare stays theirs. No
# file but the benches has a delay, so that a `timescale of a user's files matters to none.
HEAD = re.compile(r"^// verilator lint_off TIMESCALEMOD\n`default_nettype none\n\n(?:module|package|bind) \w+", re.MULTILINE)
TAIL = "\n\n`default_nettype wire\n"
FIRST = re.compile(r"^(?:module|package|interface|bind) \w+", re.MULTILINE)
HARMLESS_SORRY: dict[str, str] = {}  # part of an Icarus line, and why it does no harm
BLOCK_RAM = {"ecp5": "DP16KD", "ice40": "SB_RAM40_4K"}


def source_files(file_list: Path = HDL / "dtof.f") -> list[str]:
    """RTL files of a file list, without comments and options."""
    lines = file_list.read_text().splitlines()
    return [line for line in lines if line.endswith(".sv") and not line.startswith("//")]


def verilator(top: str, parameters: dict[str, int]) -> list[str]:
    overrides = [f"-G{name}={value}" for name, value in parameters.items()]
    return ["verilator", "--lint-only", "-Wall", "-f", "dtof_lint.f", "-f", "dtof.f", "--top-module", top, *overrides]


def yosys(top: str, parameters: dict[str, int]) -> list[str]:
    """Elaborates the modules under `top` alone (-defer). The default of each module is what a user's command reads (check_file_list)."""
    numbers = {name: value if value >= 0 else f"32'h{value & 0xFFFFFFFF:x}" for name, value in parameters.items()}
    settings = " ".join(f"-chparam {name} {number}" for name, number in numbers.items())
    script = f"read_verilog -sv -defer -Icommon {' '.join(source_files())}; hierarchy -check -top {top} {settings}; proc; check -assert"
    return ["yosys", "-q", "-p", script]


def icarus(top: str, parameters: dict[str, int]) -> list[str]:
    overrides = [f"-P{top}.{name}={value}" for name, value in parameters.items()]
    return ["iverilog", "-g2012", "-t", "null", "-f", "dtof.f", "-s", top, *overrides]


def run(command: list[str]) -> subprocess.CompletedProcess:
    return subprocess.run(command, cwd=HDL, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


TOOLS = (verilator, yosys, icarus)


def check_read(what: str, top: str, parameters: dict[str, int], tools: Sequence[Callable[[str, dict[str, int]], list[str]]] = TOOLS) -> list[str]:
    """Reads an array with these parameters in the tools; Icarus Verilog must not leave anything out."""
    failures = []
    for tool in tools:
        result = run(tool(top, parameters))
        if result.returncode != 0:
            failures.append(f"{tool.__name__} refuses {what}:\n{result.stdout}")
        elif tool is icarus:
            failures += [f"Icarus Verilog goes on, but says: {line}" for line in sorry(result.stdout)]
    return failures


def check_configuration(configuration: Configuration, quick: bool = False) -> list[str]:
    """The build verilates each configuration of dtof_array (dtof_verilate_named in cmake/verilate.cmake)."""
    built = quick and configuration.top == "dtof_array"
    tools = TOOLS if not built else (icarus,) if configuration.variant_of else (yosys, icarus)
    return check_read(f"configuration {configuration.name}", configuration.top, configuration.rtl_parameters() | SIZE[configuration.top], tools)


def check_around(top: str, files: list[str]) -> list[str]:
    """Reads a top module that contains the subsystem, from these files."""
    commands = {
        "Verilator": ["verilator", "--lint-only", "-Wall", "-f", "dtof_lint.f", "+incdir+common", *files, "--top-module", top],
        "Yosys": ["yosys", "-q", "-p", f"read_verilog -sv -defer -Icommon {' '.join(files)}; hierarchy -check -top {top}; proc; check -assert"],
        "Icarus Verilog": ["iverilog", "-g2012", "-t", "null", "-Icommon", "-s", top, *files],
    }  # fmt: skip
    failures = []
    for tool, command in commands.items():
        result = run(command)
        if result.returncode != 0 or sorry(result.stdout):
            failures.append(f"{tool} refuses the top {top}:\n{result.stdout}")
    return failures


def check_demonstrator() -> list[str]:
    """Reads the FPGA's top module with the FPGA's memories."""
    listed = [file.replace("/behavioural/", "/fpga/") for file in source_files()]
    files = [*listed, *sorted(f"../{file.relative_to(ROOT)}" for file in (ROOT / "fpga").glob("*.sv"))]
    return check_around(DEMONSTRATOR, files)


def check_shuttle() -> list[str]:
    """Reads the chip of shuttle/ with its pads and with the memories of IHP's process."""
    listed = [file.replace("/behavioural/", "/ihp130/") for file in source_files()]
    files = [*listed, *sorted(f"../{file.relative_to(ROOT)}" for folder in ("fpga", "shuttle") for file in (ROOT / folder).glob("*.sv"))]
    with tempfile.TemporaryDirectory() as folder:
        cells = Path(folder) / "cells.v"
        cells.write_text("/* verilator lint_off DECLFILENAME */\n" + SHUTTLE_CELLS, encoding="utf-8")
        return check_around(SHUTTLE, [str(cells), *files])


def check_soc() -> list[str]:
    """Reads the top of the SoC example by its file list."""
    return check_around(SOC, [*source_files(), *source_files(ROOT / "examples/soc/soc.f")])


def check_subsystem(readout: int, quick: bool = False) -> list[str]:
    """Reads the subsystem around a read-out with all options and, for one read-out, with as few as possible. The build verilates one around
    each read-out (tb_cpp/tests/subsystem)."""
    smallest = {"PIXELS_PER_SRAM": 1, "SRAM_NUM": 1, "BUFFER_LINES": 2, "CONFIDENCE_WIDTH": 0, "SELF_TEST": 1}
    others = [smallest, {"CLOCK_WAITS": 0}, {"SOURCE_WAITS": 0}, {"SOURCE_WAITS": 0, "BUFFER_LINES": 9}]
    chosen = [SIZE[SUBSYSTEM] | {"TIME_GATE": 1, "RASTER_ORDER": 1, "SELF_TEST": 1},
              *([SIZE[SUBSYSTEM] | other for other in others] if readout == 0 else [])]
    return [failure for number, settings in enumerate(chosen)
            for failure in check_read(f"{SUBSYSTEM} of READOUT {readout}", SUBSYSTEM, {"READOUT": readout} | settings,
                                      (yosys, icarus) if quick and number == 0 else TOOLS)]


def sorry(output: str) -> list[str]:
    """Messages of Icarus Verilog about omitted constructs and warnings, such as a port of another width, except known harmless ones."""
    return [line for line in output.splitlines()
            if ("sorry" in line or "warning:" in line) and not any(known in line for known in HARMLESS_SORRY)]


def check_misread(sources: dict[str, str]) -> list[str]:
    """Uses of constructs that a tool silently misinterprets."""
    return [f"{name}:{text.count(chr(10), 0, found.start()) + 1}: {why}"
            for name, text in sources.items() for pattern, why in MISREAD for found in pattern.finditer(text)]


def check_nettype(sources: dict[str, str]) -> list[str]:
    """Files that do not turn implicit nets off before their first module and on after their last one, or that set a time scale."""
    failures = []
    for name, text in sources.items():
        head, first = HEAD.search(text), FIRST.search(text)
        if head is None or first is None or head.end() != first.end() or not text.endswith(TAIL):
            failures.append(f"{name}: in front of the first module stand '// verilator lint_off TIMESCALEMOD' and '`default_nettype "
                            "none', a blank line behind them, and at the file's end, behind a blank line, '`default_nettype wire'")
        if "`timescale" in text and not name.startswith("examples/"):
            failures.append(f"{name}: a `timescale, which every file behind this one would have")
    return failures


def check_file_list() -> list[str]:
    """Runs the commands in the header of dtof.f as a user does."""
    head = (HDL / "dtof.f").read_text().splitlines()
    commands = [line[2:].strip() for line in head if re.match(r"// +(verilator|iverilog|yosys) ", line)]
    failures = [] if len(commands) == 3 else [f"hdl/dtof.f: its head has {len(commands)} commands instead of three"]
    for command in commands:
        result = run(["bash", "-c", command])
        if result.returncode != 0:
            failures.append(f"hdl/dtof.f does not read with '{command}':\n{result.stdout}")
    return failures


def block_rams(target: str, module: str, depth: int, width: int) -> tuple[int, dict[str, int]]:
    """(block RAMs, all cells by type) of an SRAM stand-in after synthesis for an FPGA family."""
    script = (
        f"read_verilog -sv technology/behavioural/{module}.sv; chparam -set DEPTH {depth} -set WIDTH {width} {module}; "
        f"synth_{target} -top {module}; tee -o /dev/stdout stat"
    )
    output = run(["yosys", "-Q", "-T", "-p", script]).stdout
    cells = statistics.cells(output)
    return cells.get(BLOCK_RAM[target], 0), cells


def check_block_rams() -> list[str]:
    """Every stand-in of some thousand bits becomes block RAM, with little logic around it."""
    failures = []
    for target in BLOCK_RAM:
        for module in ("dtof_sram_1r1w", "dtof_sram_1rw"):
            depth, width = 5120, 10
            try:
                found, cells = block_rams(target, module, depth, width)
            except FlowError as error:
                failures.append(f"{module} ({depth} x {width}) with synth_{target}: {error}")
                continue
            others = sum(cells.values()) - found
            if found == 0 or others > depth * width // 100:
                failures.append(f"{module} ({depth} x {width}) does not become block RAM with synth_{target}: {cells}")
    return failures


def parameter_limits() -> list[tuple[str, dict[str, int], str]]:
    """(top, settings, sentence) for every line of the table, and for READOUT beyond its limits. The sentence is empty for legal
    settings."""
    lines = [line for line in PARAMETER_LIMITS.read_text().splitlines() if not line.startswith("#")]
    rows = [line.split(",", 2) for line in lines[1:]]
    most = max(readout.number for readout in readouts.load().readouts.values() if readout.number is not None)
    return [*(("dtof_array", {"READOUT": number}, f"READOUT must be 0 to {most}") for number in (-1, most + 1)),
            *((top, {name: int(value) for name, value in re.findall(r"(\w+)=(-?\d+)", settings)}, sentence)
              for top, settings, sentence in rows)]


def subsystem_numbers() -> list[int]:
    """The values of the subsystem's READOUT."""
    table = readouts.load()
    arrays = [readout.number for readout in table.readouts.values() if readout.number is not None]
    return arrays + [top.readout for top in table.tops.values() if top.readout is not None]


def is_large(parameters: dict[str, int]) -> bool:
    """Whether Verilator and Icarus Verilog read an array for longer than all others together."""
    return parameters.get("SRAM_NUM", 0) >= 1000


def check_limit(top: str, settings: dict[str, int], sentence: str, quick: bool = False) -> list[str]:
    """Yosys refuses illegal settings before it elaborates the columns, Verilator behind that."""
    if not sentence:
        tools = TOOLS if not quick else (yosys,) if is_large(settings) else (verilator,)
        return check_read(f"the legal {settings} of {top}", top, SIZE[top] | settings, tools)
    parameters = SIZE[top] | settings
    result = run((yosys if quick and is_large(parameters) else verilator)(top, parameters))
    if result.returncode == 0 or not re.search(rf"{re.escape(f'{top}: {sentence}')}\.?\n", result.stdout):
        return [f"illegal {settings} of {top} do not stop elaboration with '{sentence}':\n{result.stdout}"]
    return []


def check_sentences(limits: list[tuple[str, dict[str, int], str]]) -> list[str]:
    """Checks that the table of limits has every requirement of the tops."""
    failures = []
    for top in SIZE:
        (source,) = HDL.glob(f"*/{top}.sv")
        required = set(re.findall(rf'"{top}: ([^"]+)"', source.read_text()))
        tried = {sentence for name, _, sentence in limits if name == top}
        failures += [f"{PARAMETER_LIMITS.name} has no settings against '{text}' of {top}" for text in required - tried]
    return failures


def main() -> int:
    quick = sys.argv[1:] == ["--quick"]
    configurations = load(ROOT / "configurations.toml").values()
    sources = {str(path.relative_to(ROOT)): path.read_text() for folder in ("hdl", "formal", "fpga", "examples")
               for path in sorted((ROOT / folder).rglob("*.sv"))}
    included = {path.name: path.read_text() for folder in ("hdl", "formal") for path in sorted((ROOT / folder).rglob("*.svh"))}
    limits = parameter_limits()
    illegal = [sentence for _, _, sentence in limits if sentence]
    failures = [*check_misread(sources), *check_nettype(sources), *rtl_rules.check(sources, included), *check_file_list(), *check_sentences(limits)]
    with ThreadPoolExecutor(max_workers=2) as pool:
        block_ram = pool.submit(check_block_rams)
        legal = pool.map(lambda one: check_configuration(one, quick), configurations)
        limit = pool.map(lambda row: check_limit(row[0], row[1], row[2], quick), limits)
        subsystem = pool.map(lambda number: check_subsystem(number, quick), subsystem_numbers())
        in_front = [text for top, settings in IN_FRONT.items() for text in check_read(top, top, settings)]
        failures += [text for group in (*legal, *limit, *subsystem, in_front, check_demonstrator(), check_shuttle(), check_soc(), block_ram.result()) for text in group]
    if slang.is_installed():
        failures += slang.check()
    for text in failures:
        print(text, file=sys.stderr)
    if not failures:
        print(f"slang: {len(SIZE)} tops clean" if slang.is_installed()
              else f"slang: {len(SIZE)} tops skipped, for it is not installed (make lint-slang installs it)")
        print(
            f"RTL lint: {len(configurations)} configurations, the subsystem of {len(subsystem_numbers())} read-outs, the "
            "demonstrator, the shuttle chip and the SoC example clean in Verilator, Yosys and Icarus Verilog; "
            f"{len(illegal)} illegal parameters refused, {len(limits) - len(illegal)} legal extremes taken; "
            f"stand-ins become block RAM ({', '.join(BLOCK_RAM)})"
            + ("; what the build has verilated is not read by Verilator again, legal extremes by one tool" if quick else "")
        )
    return 1 if failures else 0


if __name__ == "__main__":
    program.run(main)
