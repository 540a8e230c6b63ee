# SPDX-License-Identifier: Apache-2.0
"""Power from activity: a small array's netlist is simulated on a scene, and every transition of every net is counted.

Icarus Verilog simulates the netlist beside its RTL, compares both (simulation.py), and writes the changes of all nets
between cells. A transition of a net costs half of C V^2 (pins and wire load behind it) and the internal energy of the driving cell, both
from the Liberty. Glitches do not occur, because the models have no delay. The clock is charged separately: the tree's loads in every clock
(scene_power.py), loads behind a clock gate in the clocks that the gate passes. An SRAM is charged per access.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from . import netlist, sram_model
from .errors import FlowError
from .library import Library
from .liberty import Group

INSTANCE = "p"  # p0, p1, ... are the modules and macros below a module
NET = "n"  # n17 is the net of bit 17
STREAMING, OTHER = "streaming", "other"


def name_for_counting(design: dict) -> None:
    """Gives nets and cells names that the simulator writes unchanged: a net its number, a module or macro its position."""
    own = [name for name, module in netlist.modules(design).items() if module["cells"]]
    for name in own:
        module = netlist.modules(design)[name]
        ports = {bit for port in module["ports"].values() for bit in port["bits"]}
        bits = sorted({bit for cell in module["cells"].values() for pin in cell["connections"].values()
                       for bit in pin if isinstance(bit, int)} - ports)
        module["netnames"] = {f"{NET}{bit}": {"hide_name": 0, "bits": [bit], "attributes": {}} for bit in bits}
        renamed, number = {}, 0
        for instance, cell in module["cells"].items():
            if cell["type"] in own or cell["type"].startswith("sram_"):
                instance, number = f"{INSTANCE}{number}", number + 1
            renamed[instance] = cell
        module["cells"] = renamed


@dataclass
class Scope:
    """A module instance of the netlist: transitions of each of its bits, by phase."""

    module: str
    transitions: dict[str, dict[int, int]] = field(default_factory=dict)
    accesses: dict[str, dict[tuple[str, str], int]] = field(default_factory=dict)  # (instance; read, write, or part that was written)


@dataclass
class Activity:
    """Result of a simulation. `clocks`: clocks by phase."""

    scopes: dict[str, Scope]
    clocks: dict[str, int]


def scopes_of(design: dict) -> dict[str, str]:
    """Module of every instance below the top, by the instance's path in the waveform; the top's path is ""."""
    found = {"": next(name for name, module in netlist.modules(design).items()
                      if module is netlist.top(design))}

    def enter(module: dict, above: str) -> None:
        for instance, cell in module["cells"].items():
            inner = netlist.modules(design).get(cell["type"], {})
            if inner.get("cells"):
                found[above + instance] = cell["type"]
                enter(inner, f"{above}{instance}.")

    enter(netlist.top(design), "")
    return found


class _Counter:
    """Counts transitions in a VCD of the listed scopes. A rising edge of the clock ends a clock; its phase was known before the edge."""

    def __init__(self, design: dict, root: str, is_streaming: Callable[[dict[str, int]], bool]):
        self.design, self.root, self.is_streaming = design, root, is_streaming
        self.names = scopes_of(design)
        self.activity = Activity({path: Scope(module) for path, module in self.names.items()}, {})
        self.signals: dict[str, list[tuple[Scope, list[int]]]] = {}  # VCD code: bits from the left
        self.values: dict[str, str] = {}
        self.port_codes: dict[str, tuple[str, int]] = {}  # of the top: code, width
        self.macros = [(self.activity.scopes[path], instance, cell)
                       for path, module in self.names.items()
                       for instance, cell in netlist.modules(design)[module]["cells"].items()
                       if cell["type"].startswith("sram_")]
        self.bit_values: dict[tuple[int, int], str] = {}  # (scope, bit), of the bits that macros look at

    def declare(self, path: list[str], code: str, name: str) -> None:
        if path[:len(self.root.split("."))] != self.root.split("."):
            return
        below = ".".join(path[len(self.root.split(".")):])
        if below not in self.names:
            return
        scope = self.activity.scopes[below]
        module = netlist.modules(self.design)[scope.module]
        if name in module["ports"]:
            bits = list(reversed(module["ports"][name]["bits"]))
            if below == "":
                self.port_codes[name] = (code, len(bits))
        elif re.fullmatch(rf"{NET}\d+", name):
            bits = [int(name[len(NET):])]
        else:
            raise FlowError(f"waveform: {'.'.join(path)} has the unknown net {name}")
        self.signals.setdefault(code, []).append((scope, bits))

    def change(self, code: str, new: str, phase: str) -> None:
        old = self.values.get(code)
        self.values[code] = new
        if old is None:
            return
        for scope, bits in self.signals[code]:
            counts = scope.transitions.setdefault(phase, {})
            if len(bits) == 1:
                if old != new and old in "01" and new in "01":
                    counts[bits[0]] = counts.get(bits[0], 0) + 1
                continue
            for before, after, bit in zip(old, new, bits):
                if before != after and before in "01" and after in "01" and isinstance(bit, int):
                    counts[bit] = counts.get(bit, 0) + 1

    def value(self, scope: Scope, bit: int | str) -> str:
        return bit if isinstance(bit, str) else self.bit_code[(id(scope), bit)](self.values)

    def index_bits(self) -> None:
        """Builds an index of the bits to which the macros' enables are connected."""
        wanted = {(id(scope), bit) for scope, _, cell in self.macros for pin in ("en_i", "we_i", "re_i", "wparts_i")
                  for bit in cell["connections"].get(pin, []) if isinstance(bit, int)}
        self.bit_code = {}
        for code, places in self.signals.items():
            for scope, bits in places:
                for index, bit in enumerate(bits):
                    if (id(scope), bit) in wanted:
                        self.bit_code[(id(scope), bit)] = \
                            lambda values, code=code, index=index: values.get(code, "x")[index]

    def count_accesses(self, phase: str) -> None:
        for scope, instance, cell in self.macros:
            pins = cell["connections"]
            write = self.value(scope, pins["we_i"][0]) == "1"
            if "en_i" in pins:
                enabled = self.value(scope, pins["en_i"][0]) == "1"
                done = [("write" if write else "read")] if enabled else []
            else:
                done = (["read"] if self.value(scope, pins["re_i"][0]) == "1" else []) + (["write"] if write else [])
            counts = scope.accesses.setdefault(phase, {})
            for kind in done:
                counts[(instance, kind)] = counts.get((instance, kind), 0) + 1
            if "write" in done and "wparts_i" in pins:
                written = sum(self.value(scope, bit) == "1" for bit in pins["wparts_i"])
                counts[(instance, "part")] = counts.get((instance, "part"), 0) + written

    def ports(self) -> dict[str, int]:
        """Known ports of the top, as numbers."""
        found = {}
        for name, (code, _) in self.port_codes.items():
            text = self.values.get(code, "x")
            if set(text) <= {"0", "1"}:
                found[name] = int(text, 2)
        return found


def count(lines: Iterable[str], design: dict, root: str,
          is_streaming: Callable[[dict[str, int]], bool]) -> Activity:
    """Counts the transitions in a VCD. `root`: path of the netlist's instance. `is_streaming` is called with the top's ports before every
    rising edge of clk_i."""
    counter = _Counter(design, root, is_streaming)
    widths: dict[str, int] = {}
    path: list[str] = []
    lines = iter(lines)
    for line in lines:
        words = line.split()
        if not words:
            continue
        if words[0] == "$scope":
            path.append(words[2])
        elif words[0] == "$upscope":
            path.pop()
        elif words[0] == "$var":
            widths[words[3]] = int(words[2])
            counter.declare(path, words[3], words[4])
        elif words[0] == "$enddefinitions":
            break
    if "clk_i" not in counter.port_codes:
        raise FlowError(f"waveform: there is no {root}.clk_i")
    counter.index_bits()
    clock = counter.port_codes["clk_i"][0]
    phase = OTHER
    for line in lines:
        first = line[0]
        if first in "01xz":
            code, new = line[1:].rstrip(), first
        elif first == "b":
            text, code = line[1:].split()
            new = text.rjust(widths[code], text[0] if text[0] in "xz" else "0")
        else:
            continue
        if code not in counter.signals:
            continue
        if code == clock and new == "1" and counter.values.get(clock) == "0":
            # What stands before the edge is what the edge does.
            phase = STREAMING if is_streaming(counter.ports()) else OTHER
            counter.activity.clocks[phase] = counter.activity.clocks.get(phase, 0) + 1
            counter.count_accesses(phase)
        counter.change(code, new, phase)
    return counter.activity


def internal_energies(library: Group, unit_ff: float) -> dict[tuple[str, str], float]:
    """Energy of one transition of each output pin, fJ: mean over its inputs and over rise and fall, in the middle of the table."""
    found = {}
    for cell in library.children("cell"):
        for pin in cell.children("pin"):
            values = []
            for power in pin.children("internal_power"):
                for table in power.groups:
                    rows = [value for name, value in table.attributes if name == "values"][0]
                    numbers = [float(text) for row in rows for text in row.split(",")]
                    values.append(numbers[len(numbers) // 2])
            if values and pin.get("direction") == "output":
                found[(cell.name, pin.name)] = sum(values) / len(values) * unit_ff
    return found


@dataclass
class Energy:
    """Energy of one scope in one phase, fJ."""

    nets: float = 0.0
    cells: float = 0.0
    sram: float = 0.0  # of the macros in it
    sram_reads: float = 0.0  # in sram
    gated_clock: float = 0.0  # gates' outputs and the registers behind them
    sram_saved: float = 0.0  # by write masks, not in sram

    @property
    def total(self) -> float:
        return self.nets + self.cells + self.sram + self.gated_clock


def energy(scope: Scope, phase: str, design: dict, library: Library, internal: dict[tuple[str, str], float],
           macro_pin_ff: float) -> Energy:
    module = netlist.modules(design)[scope.module]
    transitions = scope.transitions.get(phase, {})
    clocks = netlist.clock_nets(module)
    gated = clocks - netlist.port_clock_nets(module)
    load: dict[int, float] = {}
    result = Energy()
    for cell in module["cells"].values():
        kind = cell["type"]
        for pin, bits in cell["connections"].items():
            if cell["port_directions"].get(pin) == "output":
                for bit in bits:
                    of_output = transitions.get(bit, 0) * internal.get((kind, pin), 0.0)
                    if bit in gated:
                        result.gated_clock += of_output
                    else:
                        result.cells += of_output
                continue
            if kind in library.input_ff:
                pin_ff = library.input_ff[kind].get(pin, 0.0)
            elif kind.startswith("sram_"):
                pin_ff = macro_pin_ff
            else:
                continue  # a module's own pins are counted in it
            for bit in bits:
                if bit in gated:  # a clock is two transitions
                    result.gated_clock += transitions.get(bit, 0) / 2 * (
                        library.clock_energy_fj.get(kind, 0.0) + (pin_ff + library.wire_ff_per_sink) * library.voltage**2)
                elif isinstance(bit, int) and bit not in clocks:
                    load[bit] = load.get(bit, 0.0) + pin_ff + library.wire_ff_per_sink
    result.nets = sum(0.5 * ff * library.voltage**2 * transitions.get(bit, 0) for bit, ff in load.items())
    for (instance, kind), number in scope.accesses.get(phase, {}).items():
        macro = sram_model.macro(sram_model.Size.of_name(module["cells"][instance]["type"]))
        has_mask = macro.size.parts > 1
        if kind == "part":
            fj = number * 1000 * (macro.write_energy_of(1) - macro.write_energy_of(0))
            result.sram_saved -= fj
        elif kind == "write":
            fj = number * 1000 * macro.write_energy_of(0 if has_mask else 1)
            result.sram_saved += number * 1000 * macro.write_energy - fj
        else:
            fj = number * 1000 * macro.read_energy
        result.sram += fj
        result.sram_reads += fj if kind == "read" else 0.0
    return result


def toggle_rate(scope: Scope, phase: str, design: dict, clocks: int) -> float:
    """Transitions of a data net per clock, mean over the nets that cells of the module drive."""
    module = netlist.modules(design)[scope.module]
    driven = {bit for cell in module["cells"].values() for pin, bits in cell["connections"].items()
              if cell["port_directions"].get(pin) == "output" for bit in bits if isinstance(bit, int)}
    driven -= netlist.clock_nets(module)
    transitions = scope.transitions.get(phase, {})
    return sum(transitions.get(bit, 0) for bit in driven) / max(len(driven) * clocks, 1)
