#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Save file for GTKWave beside a waveform of `make wave`: the signals in the groups of the documented pipeline.

`wave_groups.py WAVEFORM.fst`: reads the signals' names (fst2vcd, of Debian's gtkwave) and writes WAVEFORM.gtkw. The
stages are those of the RTL's names (..._t1, ..._s2; docs/reference/architecture.md), of the array and of its first
column, so that a new signal finds its group by its name. A waveform without stages, memory or streams is an error.
"""

import re
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from dtof_synth import program

HEXADECIMAL = "@22"
BINARY = "@28"
GROUP = "@800200"
CLOSED_GROUP = "@c00200"
GROUP_END = "@1000200"
CLOSED_GROUP_END = "@1401200"

STAGE = re.compile(r"_([ts])(\d+)(?:_[qdio])?$")
OTHER_COLUMN = re.compile(r"^g_(?:column|quad|pair|engine)\[(?!0\])\d+\]$")
FRAME = ("start_i", "acq_num_i", "gate_begin_i", "gate_end_i", "busy_o", "done_o", "state_o", "error_o")
MEMORY_PORTS = ("read_en_i", "read_addr_i", "read_data_o", "write_en_i", "write_addr_i", "write_parts_i", "write_data_i")


@dataclass(frozen=True)
class Signal:
    scopes: tuple[str, ...]
    name: str
    bits: str  # "[9:0]", or empty for a single bit
    code: str  # the file's identifier: signals that are one net share it

    @property
    def path(self) -> str:
        return ".".join((*self.scopes, self.name + self.bits))


def read_signals(header: Iterable[str]) -> list[Signal]:
    """The signals of a VCD header, in its order, without parameters."""
    scopes: list[str] = []
    signals = []
    for line in header:
        words = line.split()
        if line.startswith("$enddefinitions"):
            break
        if line.startswith("$scope"):
            scopes.append(words[2])
        elif line.startswith("$upscope"):
            scopes.pop()
        elif line.startswith("$var") and words[1] != "parameter":
            bits = "".join(words[5:-1])
            if bits == "[0:0]":  # GTKWave calls a bus of one bit by its name alone
                bits = ""
            signals.append(Signal(tuple(scopes), words[4], bits, words[3]))
    return signals


def each_net_once(signals: Iterable[Signal]) -> list[Signal]:
    """The outermost name of each net. A net has a name in every module that it crosses."""
    first: dict[str, Signal] = {}
    for signal in signals:
        first.setdefault(signal.code, signal)
    return list(first.values())


def groups(signals: list[Signal]) -> dict[str, list[Signal]]:
    """The signals of each group of the save file, in the order of the pipeline."""
    top = [s for s in signals if len(s.scopes) == 1]
    inside = [s for s in signals if not any(OTHER_COLUMN.match(scope) for scope in s.scopes)]
    found = {"Clock and reset": [s for s in top if s.name in ("clk_i", "rst_ni")],
             "Frame": [s for s in top if s.name in FRAME],
             "TDC stream": [s for s in top if s.name.startswith("tdc_")]}
    stages: dict[tuple[str, int], list[Signal]] = {}
    memories: dict[tuple[str, ...], list[Signal]] = {}
    engine = []
    for signal in inside:
        if stage := STAGE.search(signal.name):
            stages.setdefault((stage[1], int(stage[2])), []).append(signal)
        elif signal.scopes[-1].endswith("_sram") and signal.name in MEMORY_PORTS:
            memories.setdefault(signal.scopes, []).append(signal)
        elif signal.scopes[-1] == "u_sequencer" and signal.name.endswith(("_i", "_o", "_q")):
            engine.append(signal)
    for (pipeline, number), members in sorted(stages.items(), key=lambda item: (item[0][0] != "t", item[0][1])):
        what = "Stream" if pipeline == "t" else "Scan"
        found[f"{what} {pipeline.upper()}{number}"] = each_net_once(members)
    for scopes, members in memories.items():
        found["Memory " + ".".join(scope.removeprefix("u_") for scope in scopes[-2:])] = members
    if engine:
        found["Engine"] = [s for s in each_net_once(engine) if s.name not in ("clk_i", "rst_ni")]
    found["Result stream"] = [s for s in top if s.name.startswith("result_")]
    return found


def missing(found: dict[str, list[Signal]]) -> list[str]:
    """Groups that a read-out's waveform must have and this waveform lacks."""
    lacking = [name for name, members in found.items() if not members]
    if not any(name.startswith("Stream T") for name in found):
        lacking.append("Stream T1")
    if not any(name.startswith("Memory") for name in found):
        lacking.append("Memory")
    return lacking


def save_file(waveform: Path, found: dict[str, list[Signal]]) -> str:
    """Text of the save file. It names the waveform without a folder, so that both files can move together. Stages of the scan are
    collapsed, since a frame begins with the stream."""
    lines = ["[*] Written by scripts/wave_groups.py", f'[dumpfile] "{waveform.name}"', f'[savefile] "{waveform.stem}.gtkw"']
    for name, members in found.items():
        folded = name.startswith("Scan")
        lines += [CLOSED_GROUP if folded else GROUP, f"-{name}"]
        for signal in members:
            lines += [HEXADECIMAL if signal.bits else BINARY, signal.path]
        lines += [CLOSED_GROUP_END if folded else GROUP_END, f"-{name}"]
    return "\n".join(lines) + "\n"


def read_header(waveform: Path) -> list[str]:
    """Header of the waveform as VCD. Stops fst2vcd before it writes the values."""
    with subprocess.Popen(["fst2vcd", str(waveform)], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as tool:
        assert tool.stdout is not None
        header = []
        for line in tool.stdout:
            header.append(line)
            if line.startswith("$enddefinitions"):
                break
        tool.kill()
    return header


def main() -> int:
    if len(sys.argv) != 2:
        print("usage: wave_groups.py WAVEFORM.fst", file=sys.stderr)
        return 2
    waveform = Path(sys.argv[1])
    header = read_header(waveform) if waveform.is_file() else []
    if not header:
        print(f"error: {waveform}: no waveform that fst2vcd reads", file=sys.stderr)
        return 1
    found = groups(read_signals(header))
    if lacking := missing(found):
        print(f"error: {waveform}: no signals for {', '.join(lacking)}", file=sys.stderr)
        return 1
    target = waveform.with_suffix(".gtkw")
    target.write_text(save_file(waveform, found), encoding="utf-8")
    print(f"{target}: {sum(map(len, found.values()))} signals in {len(found)} groups; open it with: gtkwave {target}")
    return 0


if __name__ == "__main__":
    program.run(main)
