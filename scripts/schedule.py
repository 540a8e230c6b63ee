#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the engine's schedule into docs/reference/blocks/pool_control.md: in which clocks of a step each command is
given, found by simulating both products' arrays in Icarus Verilog, and what the command means, taken from
hdl/pool/dtof_pool_pkg.sv. --check only says whether the page is stale."""

import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from dtof_synth import program
from dtof_synth.configuration import Configuration, load

ROOT = Path(__file__).resolve().parent.parent
HDL = ROOT / "hdl"
COMMANDS = HDL / "pool" / "dtof_pool_pkg.sv"
PAGE = ROOT / "docs" / "reference" / "blocks" / "pool_control.md"
BEGIN = "<!-- schedule: written by scripts/schedule.py -->\n"
END = "<!-- end of schedule -->\n"
PRODUCTS = ("poolpointer", "poolpointer_lean")
PRIOR = "poolpointer_prior"  # as the first product, with some commands more
STRUCTS = ("pool_column_command_t", "pool_engine_command_t")  # in the order in which the bench prints them
OPERATIONS = {"decode": "a group", "choose": "a pixel", "decide": "a pixel"}  # and what a step is
STRUCT = re.compile(r"typedef struct packed \{\n(.*?)\n *\} (\w+);", re.DOTALL)
FIELD = re.compile(r"^ *(\w+)(?: \[(\d+):0\])? (\w+);(?: +// (.*))?$")
WITH = "with "  # so begins the meaning of what goes with a command and is none itself
SMALL = {"SRAM_NUM": 2, "ENGINE_COLUMNS": 2}
GROUPS = 3  # one between others
# Frames without acquisitions: one operation after the other. The second one has a last frame to begin from.
BENCH = """
module schedule_bench;
  logic clk = 1'b0, rst_n = 1'b0, start = 1'b0;
  wire done;
  dtof_pool_pointer_array #(PARAMETERS) u_array (
      .clk_i(clk), .rst_ni(rst_n), .sram_cfg_i('0), .sram_cfg_o(), .start_i(start), .acq_num_i(ACQ_WIDTH'd0),
      .gate_begin_i('0), .gate_end_i('0), .coarse_end_i(ACQ_WIDTH'd0), .track_end_i(ACQ_WIDTH'd0),
      .smooth_i(1'b1), .prior_i(1'b1), .template_i('0), .busy_o(), .done_o(done), .state_o(), .error_o(), .tdc_ready_o(), .tdc_valid_i(1'b0),
      .tdc_timestamp_i('0), .result_tvalid_o(), .result_tready_i(1'b1), .result_tdata_o(), .result_tlast_o());
  always #1 clk = !clk;
  always @(negedge clk) begin
    $display("%b%b%b %b %0d %b", u_array.u_control.u_sequencer.decoding, u_array.u_control.u_sequencer.choosing,
             u_array.u_control.u_sequencer.deciding, u_array.u_control.u_sequencer.back_q, u_array.u_control.u_sequencer.t_q,
             {u_array.u_control.u_sequencer.columns, u_array.u_control.u_sequencer.command});
  end
  initial begin
    #4 rst_n = 1'b1;
    repeat (2) begin
      @(posedge clk) start <= 1'b1;
      @(posedge clk) start <= 1'b0;
      @(negedge done);
    end
    $finish;
  end
endmodule
"""


class ScheduleError(Exception):
    pass


@dataclass(frozen=True)
class Field:
    name: str
    meaning: str
    width: int
    place: int  # of its highest bit in what the bench prints

    @property
    def is_command(self) -> bool:
        return not self.meaning.startswith(WITH)


def structs(text: str) -> dict[str, list[tuple[str, str, int, str]]]:
    """Fields of every struct by type: name, width and meaning."""
    found: dict[str, list[tuple[str, str, int, str]]] = {}
    for body, name in STRUCT.findall(text):
        found[name] = []
        for line in body.splitlines():
            match = FIELD.match(line)
            if match is None or (match[1] == "logic" and not match[4]):
                raise ScheduleError(f"{COMMANDS.name}: '{line.strip()}' is no field with its meaning")
            found[name].append((match[1], match[3], int(match[2] or 0) + 1, match[4] or ""))
    return found


def all_fields(known: dict[str, list[tuple[str, str, int, str]]]) -> list[Field]:
    fields: list[Field] = []

    def add(struct: str) -> None:
        for kind, name, width, meaning in known[struct]:
            if kind == "logic":
                place = fields[-1].place + fields[-1].width if fields else 0
                fields.append(Field(name, meaning, width, place))
            else:
                add(kind)

    for struct in STRUCTS:
        add(struct)
    return fields


def simulated(configuration: Configuration) -> list[list[str]]:
    """Simulates a frame. Returns, for every clock, operation, pass, clock of the step, and commands."""
    parameters = configuration.rtl_parameters() | SMALL | {"PIXELS_PER_SRAM": GROUPS * configuration["GROUP_SIZE"]}
    bench_text = BENCH.replace("PARAMETERS", ", ".join(f".{name}({value})" for name, value in parameters.items()))
    bench_text = bench_text.replace("ACQ_WIDTH'", f"{parameters['ACQ_WIDTH']}'")
    with tempfile.TemporaryDirectory() as folder:
        bench, program = Path(folder) / "bench.sv", Path(folder) / "bench.vvp"
        bench.write_text(bench_text)
        said = ""
        for command in (["iverilog", "-g2012", "-f", "dtof.f", "-s", "schedule_bench", "-o", str(program), str(bench)],
                        ["vvp", "-n", str(program)]):
            result = subprocess.run(command, cwd=HDL, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            said = result.stdout
            if result.returncode != 0:
                raise ScheduleError(f"{command[0]} fails:\n{said}")
    return [words for line in said.splitlines() if len(words := line.split()) == 4]


@dataclass
class Schedule:
    clocks: dict[tuple[str, Field], set[int]]  # of an operation's step in which a command is given
    passes: dict[tuple[str, Field], set[str]]  # in which it is
    length: dict[str, int]  # clocks of a step


def schedule(configuration: Configuration, fields: list[Field]) -> Schedule:
    found = Schedule({}, {}, {})
    bits = fields[-1].place + fields[-1].width
    for working, back, clock, given in simulated(configuration):
        if working not in ("100", "010", "001"):
            continue
        if len(given) != bits or set(given) - {"0", "1"}:
            raise ScheduleError(f"{COMMANDS.name} has {bits} bits, the simulation {given}")
        operation = list(OPERATIONS)[working.index("1")]
        found.length[operation] = max(found.length.get(operation, 0), int(clock) + 1)
        for field in fields:
            if field.is_command and given[field.place] == "1":
                found.clocks.setdefault((operation, field), set()).add(int(clock))
                found.passes.setdefault((operation, field), set()).add(back)
    return found


def ranges(clocks: set[int]) -> str:
    """Text of a set of clocks: "0, 8, 16, 24", "7 to 38" or "0, 4, ..., 28"."""
    runs: list[list[int]] = []
    for clock in sorted(clocks):
        if runs and clock == runs[-1][-1] + 1:
            runs[-1].append(clock)
        else:
            runs.append([clock])
    texts = [str(run[0]) if len(run) == 1 else f"{run[0]} to {run[-1]}" for run in runs]
    apart = {after[0] - before[0] for before, after in zip(runs, runs[1:])}
    if len(runs) > 5 and len(apart) == 1 and all(len(run) == 1 for run in runs):
        texts = [*texts[:2], "...", texts[-1]]
    return ", ".join(texts)


def tables(fields: list[Field], plain: Schedule, lean: Schedule, first: Schedule) -> str:
    """`first`: `plain` with a prior."""
    lines = []
    pass_name = {frozenset("0"): "first", frozenset("1"): "second", frozenset("01"): "both"}
    for operation, step in OPERATIONS.items():
        chain = operation != "decode"
        given = [field for field in fields if (operation, field) in first.clocks]
        given.sort(key=lambda field: min(first.clocks[operation, field]))  # noqa: B023
        lines += [f"{operation.capitalize()}, {step}: {first.length[operation]} clocks, lean {lean.length[operation]}.", "",
                  f"| command | clock | lean | {'pass | ' if chain else ''}what it says |",
                  f"|---|---|---|{'---|' if chain else ''}---|"]  # fmt: skip
        for field in given:
            key = (operation, field)
            which = f"{pass_name[frozenset(first.passes[key])]} | " if chain else ""
            lines.append(f"| `{field.name}` | {ranges(first.clocks[key])} | {ranges(lean.clocks.get(key, set()))} | {which}"
                         f"{field.meaning}{'' if key in plain.clocks else ' (PRIOR = 1)'} |")
        lines.append("")
    never = [field.name for field in fields if field.is_command
             and all((operation, field) not in first.clocks for operation in OPERATIONS)]
    if never:
        raise ScheduleError(f"{', '.join(never)}: never commanded")
    lines += ["What goes with a command:", "", "| field | meaning |", "|---|---|"]
    meanings = {f"| `{field.name}` | {field.meaning} |": None for field in fields if not field.is_command}
    return "\n".join([*lines, *meanings]) + "\n"


def main() -> int:
    if sys.argv[1:] not in ([], ["--check"]):
        print(f"{__doc__}\nusage: schedule.py [--check]", file=sys.stderr)
        return 2
    try:
        fields = all_fields(structs(COMMANDS.read_text(encoding="utf-8")))
        configurations = load(ROOT / "configurations.toml")
        written = tables(fields, *(schedule(configurations[name], fields) for name in (*PRODUCTS, PRIOR)))
        page = PAGE.read_text(encoding="utf-8")
        if page.count(BEGIN) != 1 or page.count(END) != 1:
            raise ScheduleError(f"{PAGE.name} has no place for the schedule")
        new = page[:page.index(BEGIN) + len(BEGIN)] + written + page[page.index(END):]
    except (ScheduleError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    if "--check" in sys.argv:
        if page != new:
            print(f"error: {PAGE.relative_to(ROOT)} is stale: run scripts/schedule.py", file=sys.stderr)
        return 0 if page == new else 1
    PAGE.write_text(new, encoding="utf-8")
    return 0


if __name__ == "__main__":
    program.run(main)
