#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the timing diagrams of docs/user/subsystem.md from a simulation of dtof_subsystem (examples/timing_bench.sv, Icarus
Verilog), and counts the clocks of a frame of every read-out for its table.

Each diagram is written twice to docs/user/timing/: as WaveDrom's JSON, which other tools read, and as the SVG that the page
shows. --check only says what is stale.
"""

import json
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from html import escape
from pathlib import Path

from dtof_synth import program, readouts
from dtof_synth.errors import FlowError

ROOT = Path(__file__).resolve().parent.parent
HDL = ROOT / "hdl"
FOLDER = "docs/user/timing"
PAGE = "docs/user/bare_arrays.md"  # with the clocks of a frame
BEGIN = "<!-- frame clocks: written by scripts/timing_diagrams.py -->\n"
END = "<!-- end of frame clocks -->\n"
BENCH = "timing_bench"
BUFFER = "u_subsystem.u_line_path.u_line_buffer"
FRAME = {"NP": 10, "COLUMNS": 8, "ROWS": 16, "ACQUISITIONS": 64}


@dataclass(frozen=True)
class Lane:
    label: str
    signal: str  # from the bench
    width: int = 1
    lsb: int = 0  # of the bits that are shown
    valid: str = ""  # while these are 1, or 0 behind a !, the lane says something; joined by &
    hexadecimal: bool = True


@dataclass(frozen=True)
class Diagram:
    number: int  # the bench's
    name: str
    title: str
    lanes: tuple[Lane, ...]


SOURCE = (Lane("s_axis_tvalid_i", "line_valid"), Lane("s_axis_tready_o", "line_ready"),
          Lane("s_axis_tdata_i", "line", 16, valid="line_valid"), Lane("s_axis_tlast_i", "line_last"))  # fmt: skip
ARRAY = (Lane("array: clk_i rests", f"{BUFFER}.wait_o"), Lane("array: tdc_valid_i", f"{BUFFER}.line_valid_o"), Lane("array: tdc_ready_o", f"{BUFFER}.line_ready_i"),
         Lane("array: tdc_timestamp_i", f"{BUFFER}.line_o", 16, valid=f"{BUFFER}.line_valid_o"))  # fmt: skip
LEVEL = Lane("STATUS.LEVEL", f"{BUFFER}.level_o", 3, hexadecimal=False)
DIAGRAMS = (
    Diagram(1, "registers", "START is written, STATUS read, an offset refused", (
        Lane("psel_i", "psel"), Lane("penable_i", "penable"), Lane("pwrite_i", "pwrite", valid="psel"),
        Lane("paddr_i", "paddr", 12, valid="psel"), Lane("pwdata_i", "pwdata", 32, valid="psel&pwrite"), Lane("pready_o", "pready"),
        Lane("prdata_o", "prdata", 32, valid="penable&pready&!pwrite"), Lane("pslverr_o", "pslverr"),
        Lane("array: start_i", "u_subsystem.begin_frame"))),
    Diagram(2, "lines", "An acquisition of four lines with a gap", (*SOURCE, LEVEL, *ARRAY)),
    Diagram(3, "results", "Four results, of which the sink lets the second wait", (
        Lane("m_axis_tvalid_o", "result_valid"), Lane("m_axis_tready_i", "result_ready"),
        Lane("ROW", "result", 12, lsb=32, valid="result_valid", hexadecimal=False),
        Lane("COLUMN", "result", 12, lsb=44, valid="result_valid", hexadecimal=False),
        Lane("m_axis_tuser_o", "result_first", valid="result_valid"),
        Lane("m_axis_tlast_o", "result_last", valid="result_valid"), Lane("irq_o", "irq"))),
)  # fmt: skip


def simulated(folder: str, parameters: dict[str, int]) -> str:
    """Output of the bench; a waveform is left in the folder."""
    program = f"{folder}/bench.vvp"
    settings = [f"-P{BENCH}.{name}={value}" for name, value in parameters.items()]
    try:
        subprocess.run(["iverilog", "-g2012", "-s", BENCH, *settings, "-o", program, "-f", "dtof.f", f"../examples/{BENCH}.sv"],
                       cwd=HDL, check=True)  # fmt: skip
        text = subprocess.run(["vvp", "-n", program], cwd=folder, check=True, capture_output=True, text=True).stdout
    except subprocess.CalledProcessError as error:
        raise FlowError(f"Icarus Verilog: {BENCH} fails with {parameters}") from error
    if "FAIL" in text:
        raise FlowError(f"{BENCH} with {parameters}: {text.strip()}")
    return text


@dataclass
class Waveform:
    """Values of signals at the rising edge of each clock, by their names in the bench."""

    names: dict[str, list[str]] = field(default_factory=dict)  # of an identifier
    clocks: list[dict[str, str]] = field(default_factory=list)


def waveform(vcd: str) -> Waveform:
    wave = Waveform()
    scope: list[str] = []
    values: dict[str, str] = {}
    tokens = iter(vcd.splitlines())
    for line in tokens:
        words = line.split()
        if line.startswith("$scope"):
            scope.append(words[2])
        elif line.startswith("$upscope"):
            scope.pop()
        elif line.startswith("$var"):
            wave.names.setdefault(words[3], []).append(".".join([*scope[1:], words[4]]))
        elif line.startswith("$enddefinitions"):
            break
    clock = next(identifier for identifier, names in wave.names.items() if "clk" in names)
    pending: dict[str, str] = {}
    for line in [*tokens, "#end"]:
        if line.startswith("#"):
            if pending.get(clock) == "1":
                # The edge samples what stood before it.
                wave.clocks.append({name: value for identifier, value in values.items() for name in wave.names[identifier]})
            values |= pending
            pending = {}
        elif line[:1] == "b":
            value, identifier = line[1:].split()
            pending[identifier] = value
        elif line[:1] in ("0", "1", "x", "z"):
            pending[line[1:]] = line[0]
    return wave


def wavedrom(diagram: Diagram, wave: Waveform) -> dict:
    """A diagram in WaveDrom's format: a letter per clock, a dot for an unchanged value."""
    clocks = [clock for clock in wave.clocks if int(clock["diagram"], 2) == diagram.number]
    if not clocks:
        raise FlowError(f"{BENCH} has no diagram {diagram.number}")
    lanes: list[dict[str, str | list[str]]] = [{"name": "clk_i", "wave": "p" + "." * (len(clocks) - 1)}]
    for lane in diagram.lanes:
        letters, before = "", ""
        data: list[str] = []
        for clock in clocks:
            if lane.signal not in clock:
                raise FlowError(f"{BENCH} has no signal {lane.signal}")
            bits = clock[lane.signal].zfill(lane.lsb + lane.width)
            bits = bits[len(bits) - lane.lsb - lane.width:len(bits) - lane.lsb]
            shown = all(clock[name.lstrip("!")] == ("0" if name[0] == "!" else "1") for name in lane.valid.split("&") if name)
            if not shown or not set(bits) <= {"0", "1"}:
                now = "x"
            elif lane.width == 1:
                now = bits
            else:
                now = "=" + (f"{int(bits, 2):X}" if lane.hexadecimal else str(int(bits, 2)))
            letters += "." if now == before else now[0]
            if now != before and now[0] == "=":
                data.append(now[1:])
            before = now
        lanes.append({"name": lane.label, "wave": letters} | ({"data": data} if data else {}))
    return {"head": {"text": diagram.title, "tock": 0}, "signal": lanes}


def svg(source: dict) -> str:
    """SVG drawing of the part of WaveDrom's JSON that wavedrom() writes."""
    clock, height, gap, left, top, slope = 44, 18, 12, 176, 34, 3
    clocks = len(source["signal"][0]["wave"])
    width, total = left + clocks * clock + 12, top + len(source["signal"]) * (height + gap) + 18
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{total}" viewBox="0 0 {width} {total}" '
        'font-family="DejaVu Sans, sans-serif" font-size="11">',
        f'<rect width="{width}" height="{total}" fill="#ffffff"/>',
        f'<text x="{left}" y="20" font-size="13">{escape(source["head"]["text"])}</text>',
    ]
    bottom = total - 18
    for i in range(clocks + 1):
        x = left + i * clock
        out.append(f'<path d="M{x} {top - 4}V{bottom}" stroke="#c8c8c8" stroke-dasharray="2 3"/>')
    for i in range(clocks):
        out.append(f'<text x="{left + i * clock + clock / 2:g}" y="{total - 4}" text-anchor="middle" fill="#606060">{i}</text>')
    for row, lane in enumerate(source["signal"]):
        high = top + row * (height + gap)
        low = high + height
        out.append(f'<text x="{left - 8}" y="{low - 5}" text-anchor="end">{escape(lane["name"])}</text>')
        # Stretches of one value: letter, first clock, number of clocks.
        stretches: list[list] = []
        for i, letter in enumerate(lane["wave"]):
            if letter == "." and lane["wave"][0] != "p":
                stretches[-1][2] += 1
            else:
                stretches.append([letter, i, 1])
        texts, level = iter(lane.get("data", [])), None
        for letter, first, count in stretches:
            x, end = left + first * clock, left + (first + count) * clock
            if lane["wave"][0] == "p":
                out.append(f'<path d="M{x} {low}V{high}H{x + clock // 2}V{low}H{end}" fill="none" stroke="#000000"/>')
            elif letter in "01":
                y = high if letter == "1" else low
                begin = f"M{x} {level}L{x + slope} {y}" if level is not None and level != y else f"M{x} {y}"
                out.append(f'<path d="{begin}H{end}" fill="none" stroke="#000000"/>')
                level = y
            else:
                middle = (high + low) // 2
                shape = f"M{x} {middle}L{x + slope} {high}H{end - slope}L{end} {middle}L{end - slope} {low}H{x + slope}Z"
                fill = "#e4e4e4" if letter == "x" else "#ffffff"
                out.append(f'<path d="{shape}" fill="{fill}" stroke="#000000"/>')
                if letter == "=":
                    out.append(f'<text x="{(x + end) / 2:g}" y="{low - 5}" text-anchor="middle">{escape(next(texts))}</text>')
                level = None
    return "\n".join([*out, "</svg>", ""])


def frame_clocks() -> str:
    """Table with the clocks of a frame for each read-out."""
    table = readouts.load()
    size = f"{FRAME['COLUMNS']} columns of {FRAME['ROWS']} pixels, {FRAME['ACQUISITIONS']} acquisitions, NP = {FRAME['NP']}"
    lines = [
        f"Clocks of a frame of {size}, with a source that never pauses and a sink that",
        "never waits (`FRAME_CYCLES`, simulated by `make timing-diagrams`):",
        "",
        "| read-out | clocks | clocks that take lines | other clocks |",
        "|---|---:|---:|---:|",
    ]
    for name, readout in table.readouts.items():
        if not readout.top:
            continue
        number = readout.number if readout.number is not None else table.tops[readout.top].readout
        if name not in (table.tops[readout.top].name, "poolpointer") and readout.number is None:
            continue  # a variant of the same hardware
        if number is None:
            raise FlowError(f"readouts.toml: {name} has no number")
        with tempfile.TemporaryDirectory() as folder:
            text = simulated(folder, FRAME | {"DIAGRAMS": 0, "READOUT": number})
        found = re.search(r"^cycles (\d+) lines (\d+)$", text, re.MULTILINE)
        if not found:
            raise FlowError(f"{BENCH} prints no clocks for READOUT = {number}")
        cycles, taken = int(found.group(1)), int(found.group(2))
        if cycles < taken:
            raise FlowError(f"{readout.title}: a frame of {cycles} clocks cannot take {taken} lines")
        lines.append(f"| {readout.title} | {cycles:,} | {taken:,} | {cycles - taken:,} |")
    return "\n".join(lines) + "\n"


def page(text: str, table: str) -> str:
    if text.count(BEGIN) != 1 or text.count(END) != 1:
        raise FlowError(f"{PAGE} has no place for the clocks of a frame")
    head, rest = text.split(BEGIN)
    return f"{head}{BEGIN}\n{table}\n{END}{rest.split(END)[1]}"


def files() -> dict[str, str]:
    with tempfile.TemporaryDirectory() as folder:
        simulated(folder, {})
        wave = waveform((Path(folder) / "dump.vcd").read_text(encoding="utf-8"))
    sources = {diagram.name: wavedrom(diagram, wave) for diagram in DIAGRAMS}
    written = {PAGE: page((ROOT / PAGE).read_text(encoding="utf-8"), frame_clocks())}
    for name, source in sources.items():
        written[f"{FOLDER}/{name}.json"] = json.dumps(source, indent=2) + "\n"
        written[f"{FOLDER}/{name}.svg"] = svg(source)
    return written


def main() -> int:
    if sys.argv[1:] not in ([], ["--check"]):
        print(f"{__doc__}\nusage: timing_diagrams.py [--check]", file=sys.stderr)
        return 2
    stale = {name: text for name, text in files().items()
             if not (ROOT / name).exists() or (ROOT / name).read_text(encoding="utf-8") != text}  # fmt: skip
    if "--check" in sys.argv:
        for name in stale:
            print(f"error: {name} is stale: run make timing-diagrams", file=sys.stderr)
        return 1 if stale else 0
    (ROOT / FOLDER).mkdir(parents=True, exist_ok=True)
    for name, text in stale.items():
        (ROOT / name).write_text(text, encoding="utf-8")
        print(f"{name} written")
    return 0


if __name__ == "__main__":
    try:
        program.run(main)
    except FlowError as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(1)
