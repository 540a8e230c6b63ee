# SPDX-License-Identifier: Apache-2.0
"""Power of dtof_subsystem around an array, from activity: its timed netlist is simulated with the RTL of the array inside.

Icarus Verilog runs the first acquisitions of the room scene (synth/subsystem/dtof_subsystem_bench.sv) and writes every change of every net;
activity.py counts. The first results are compared with the model's. Where an array computes for thousands of clocks before its first results,
or they are not awaited (awaits_results), the simulation ends behind the lines, and few results or none are compared. Models have no delay, so there are no glitches. Wires have the library's wire
load. The array's own power, with its input pins, is that of `make power`.
"""

from __future__ import annotations

import json
import random
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

from . import activity, array_stand_in, cell_models, liberty, netlist, readouts, simulation, tools
from . import power as power_model
from .activity import OTHER, STREAMING, Activity
from .array_stand_in import Ports
from .configuration import Configuration
from .errors import FlowError, given
from .library import Library
from .mapping import rtl_files
from .technology import TARGET_MHZ, Technology

BENCH = "dtof_subsystem_bench"
SCENE, KLUX = "room", 50.0
ACQUISITIONS = 2  # of which every line is counted
MOST_RESULTS = 200
QUIET_CLOCKS = 64  # without a line, behind which the simulation ends where no result is awaited
MOST_CLOCKS = 60_000
_BIT = re.compile(r"(\w+)\[(\d+)\]")


@dataclass(frozen=True)
class Parts:
    """Power of the subsystem in one phase, mW."""

    logic: float
    clock: float  # pins of flip-flops and clock gates, the tree, and what runs behind clock gates
    leakage: float

    @property
    def total(self) -> float:
        return self.logic + self.clock + self.leakage


@dataclass(frozen=True)
class SubsystemPower:
    """Power of the subsystem. `modules`: logic and gated clock while lines stream in, mW, by module."""

    streaming: Parts  # clocks in which a line is taken
    results: Parts | None  # the other clocks, up to the last result that was compared; none without results
    idle: float  # clock pins, tree and leakage
    modules: dict[str, float]
    clocks: dict[str, int]  # simulated, by phase
    compared: int  # results


@dataclass(frozen=True)
class Simulated:
    """What a simulation counted, and the results that it compared with the model's."""

    activity: Activity
    compared: int


def awaits_results(configuration: Configuration) -> bool:
    """Whether results are simulated and compared. They are those of a pointer array that takes a single pass: it sends them right behind the
    last line. The others scan or decode for thousands of clocks."""
    return configuration.has_pointer and readouts.evaluate(configuration.described.passes, configuration.parameters) == 0


def case(configuration: Configuration, seed: int) -> simulation.Case:
    """The frame. Of several passes the first has ACQUISITIONS, and the others are not simulated."""
    passes = 0 if configuration.is_pool else readouts.evaluate(configuration.described.passes, configuration.parameters)
    return simulation.Case(configuration, (ACQUISITIONS * (passes + 1),), seed)


def _port_and_bit(name: str) -> tuple[str, int]:
    """Of `port` or `port[bit]`."""
    found = _BIT.fullmatch(name)
    return (found[1], int(found[2])) if found else (name, 0)


def array_wrapper(configuration: Configuration, ports: Ports, others: list[tuple[str, bool]]) -> str:
    """Module with the stand-in's pins around the array's RTL. Inputs that the array does not use are 0. `others`: pins without times, and
    whether they are outputs."""
    pins = {port.name: port.is_output for port in ports.timed[array_stand_in.MODES[0]]} | dict(others) | {array_stand_in.CLOCK: False}
    bits: dict[str, dict[int, str]] = {}  # of each port: what is connected
    for name in [*pins, *sorted(ports.constant), *sorted(ports.unused)]:
        port, bit = _port_and_bit(name)
        bits.setdefault(port, {})[bit] = array_stand_in.plain(name) if name in pins else ""
    outputs = {_port_and_bit(name)[0] for name in [*(name for name, is_output in pins.items() if is_output), *ports.constant]}
    wires = []
    for port, connected in bits.items():
        width = max(connected) + 1
        if port in outputs:
            wires.append(f"  wire [{width - 1}:0] {port}_bits;")
            wires += [f"  assign {pin} = {port}_bits[{bit}];" for bit, pin in connected.items() if pin]
        else:  # a single assignment: Icarus Verilog would evaluate the whole vector for each bit that is assigned alone
            ordered = ", ".join(connected.get(bit, "") or "1'b0" for bit in reversed(range(width)))
            wires.append(f"  wire [{width - 1}:0] {port}_bits = {{{ordered}}};")
    declared = ",\n".join(f"    {'output' if is_output else 'input'} wire {array_stand_in.plain(name)}" for name, is_output in pins.items())
    settings = ", ".join(f".{name}({value})" for name, value in configuration.rtl_parameters().items())
    connections = ", ".join(f".{port}({port}_bits)" for port in bits)
    return "\n".join(["// SPDX-License-Identifier: Apache-2.0", "// Generated.", f"module {array_stand_in.CELL} (\n{declared}\n);", *wires,
                      f"  {configuration.top} #({settings}) u_array ({connections});", "endmodule", ""])


def split_ports(design: dict) -> None:
    """Replaces each port of several bits by ports of one bit, except those of the top. Icarus Verilog evaluates a whole vector for each bit that a
    cell drives, and a line has 2,000 bits."""
    own = {name for name, module in netlist.modules(design).items() if module["cells"] and module is not netlist.top(design)}
    for name in own:
        module = netlist.modules(design)[name]
        module["ports"] = {bit_name: {**port, "bits": [bit]} for port_name, port in module["ports"].items()
                           for bit_name, bit in _single_bits(port_name, port["bits"])}
    for module in netlist.modules(design).values():
        for cell in module["cells"].values():
            if cell["type"] in own:
                cell["port_directions"] = {bit_name: cell["port_directions"][pin] for pin, bits in cell["connections"].items()
                                           for bit_name, _ in _single_bits(pin, bits)}
                cell["connections"] = {bit_name: [bit] for pin, bits in cell["connections"].items() for bit_name, bit in _single_bits(pin, bits)}


def _single_bits(name: str, bits: list) -> list[tuple[str, int | str]]:
    return [(name, bits[0])] if len(bits) == 1 else [(f"{name}_{index}_", bit) for index, bit in enumerate(bits)]


def first_lines(configuration: Configuration) -> int:
    """Lines of ACQUISITIONS."""
    return ACQUISITIONS * configuration["PIXELS_PER_SRAM"] * configuration["SLOTS"]


def simulate(design: dict, configuration: Configuration, ports: Ports, others: list[tuple[str, bool]], technology: Technology,
             folder: Path, seed: int) -> Simulated:
    """Simulates the design, and counts its activity. Renames the design's nets and modules. FlowError if a result is not the model's, or if
    results are missing."""
    folder.mkdir(parents=True, exist_ok=True)
    root, drawn = technology.root, random.Random(seed)
    for name in [name for name, module in netlist.modules(design).items() if not module["cells"]]:
        del netlist.modules(design)[name]  # black boxes, of which the RTL has the modules
    split_ports(design)
    activity.name_for_counting(design)
    kinds = netlist.cell_kinds(design, technology.slow)
    netlist.prepare_simulation(design, technology.slow, simulation.NETLIST_SUFFIX, cell_models.POWER_UP, lambda: drawn.random() < 0.5)
    (folder / "simulation.json").write_text(json.dumps(design), encoding="utf-8")
    settings = folder / "write_settings.tcl"
    tools.write_settings(settings, {"netlist_json": folder / "simulation.json", "netlist": folder / "netlist.v"})
    tools.run_yosys(root / "synth" / "yosys" / "write_verilog.tcl", settings, folder / "write.log", configuration.name)
    (folder / "cells.v").write_text(cell_models.verilog(liberty.read(technology.slow.path), kinds), encoding="utf-8")
    (folder / "array.v").write_text(array_wrapper(configuration, ports, others), encoding="utf-8")
    path = f"{BENCH}.u_netlist"
    scopes = ", ".join([path, *(f"{path}.{below}" for below in activity.scopes_of(design) if below)])
    (folder / "activity_dump.sv").write_text(
        f'module activity_dump;\n  initial begin\n    $dumpfile("activity.vcd");\n    $dumpvars(1, {scopes});\n  end\nendmodule\n',
        encoding="utf-8")
    simulation.write_vectors(case(configuration, seed), root, folder, ("--scene", SCENE, "--klux", f"{KLUX:g}"))
    _compile(case(configuration, seed), root, folder)
    return _count(design, path, folder, configuration)


def _compile(simulated: simulation.Case, root: Path, folder: Path) -> None:
    configuration = simulated.configuration
    beats = simulated.frames[0] * configuration["PIXELS_PER_SRAM"] * configuration["SLOTS"]
    values = {"NP": configuration["NP"], "SRAM_NUM": configuration["SRAM_NUM"], "PIXELS_PER_SRAM": configuration["PIXELS_PER_SRAM"],
              "SLOTS": configuration["SLOTS"], "FRACTION_BITS": configuration.parameters.get("FRACTION_BITS", 0),
              "HAS_SCHEDULE": int(configuration.is_pool), "BEATS": beats, "MOST_RESULTS": MOST_RESULTS,
              "QUIET_CLOCKS": 0 if awaits_results(configuration) else QUIET_CLOCKS, "LEAST_LINES": first_lines(configuration),
              "MOST_CLOCKS": MOST_CLOCKS}
    command = ["iverilog", "-g2012", f"-I{root / 'hdl' / 'common'}", "-s", BENCH, "-s", "activity_dump",
               *(f"-P{BENCH}.{name}={value}" for name, value in values.items()), "-o", "bench.vvp",
               *map(str, [*rtl_files(root)[:1], *sorted((root / simulation.BEHAVIOURAL).glob("*.sv")), *rtl_files(root)[1:],
                          root / "synth" / "subsystem" / f"{BENCH}.sv", folder / "netlist.v", folder / "cells.v", folder / "array.v",
                          folder / "activity_dump.sv"])]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    said = (done.stdout + done.stderr).strip()
    if done.returncode or said:
        raise FlowError(f"{simulated.name}: Icarus Verilog: {said.splitlines()[0] if said else 'failed silently'}")


def _streams(ports: dict[str, int]) -> bool:
    return ports.get("s_axis_tready_o") == 1 and ports.get("s_axis_tvalid_i") == 1


def _count(design: dict, path: str, folder: Path, configuration: Configuration) -> Simulated:
    """Counts while vvp writes the waveform to its output; the bench's words go to a file."""
    words = folder / "bench.log"
    command = f"exec 3>&1; vvp -n bench.vvp > {words.name} 2>&1"
    pipe = folder / "activity.vcd"
    pipe.unlink(missing_ok=True)
    pipe.symlink_to("/dev/fd/3")
    with subprocess.Popen(["sh", "-c", command], cwd=folder, stdout=subprocess.PIPE, text=True, encoding="ascii") as process:
        counted = activity.count(given(process.stdout, "vvp has no output"), design, path, _streams)
    pipe.unlink(missing_ok=True)
    return judge(words.read_text(encoding="utf-8"), counted, configuration)


def judge(said: str, counted: Activity, configuration: Configuration) -> Simulated:
    """Compares what the bench said with what was counted. FlowError unless the frame ended as it should: every result compared that can be, and
    as many clocks counted as streaming as lines were taken, of all acquisitions that the first pass has."""
    name = configuration.name
    passed = re.search(r"^DTOF_PASS lines (\d+) results (\d+) clocks (\d+)$", said, re.MULTILINE)
    if passed is None or "DTOF_FAIL" in said:
        raise FlowError(f"{name}: {said.strip().splitlines()[-1] if said.strip() else 'the simulation printed nothing'}")
    lines, results, clocks = map(int, passed.groups())
    wanted = MOST_RESULTS if awaits_results(configuration) else 0
    if results < wanted:
        raise FlowError(f"{name}: {results} results were compared, and {wanted} should be")
    if lines < first_lines(configuration):
        raise FlowError(f"{name}: {lines} lines were taken, and {first_lines(configuration)} should come without a pause")
    streaming, total = counted.clocks.get(STREAMING, 0), sum(counted.clocks.values())
    if abs(streaming - lines) > 1 or abs(total - clocks) > 1:  # the waveform may have s_axis_tready_o before the edge that sets it
        raise FlowError(f"{name}: {streaming} of {total} clocks were counted as streaming, and the bench saw {lines} lines in {clocks} clocks")
    return Simulated(counted, wanted)  # a few more may come before the end of a simulation that does not await results; they are compared, too


def measure(design: dict, configuration: Configuration, ports: Ports, others: list[tuple[str, bool]], technology: Technology,
            folder: Path, seed: int) -> SubsystemPower:
    """Power of the timed design in the typical corner."""
    return power(simulate(design, configuration, ports, others, technology, folder, seed), design, configuration.name, technology.typical)


def power(simulated: Simulated, design: dict, name: str, library: Library) -> SubsystemPower:
    """Power of a design from its counted activity. `name`: for error messages."""
    counted = simulated.activity
    group = liberty.read(library.path)
    internal = activity.internal_energies(group, library.energy_fj)
    leakage = {cell.name: cell.number("cell_leakage_power") for cell in group.children("cell")}
    own = [netlist.modules(design)[scope.module] for scope in counted.scopes.values()]
    counts = [netlist.count(module, library) for module in own]
    tree = power_model.clock_tree(sum(one.clock_sinks for one in counts), sum(one.clock_ff for one in counts), library)
    clock_mw = (sum(one.clock_energy_fj for one in counts) + tree.load_ff * library.voltage**2) * TARGET_MHZ * 1e-6
    leak_mw = sum(leakage.get(cell["type"], 0.0) for module in own for cell in module["cells"].values()) * 1e-6

    def parts(phase: str) -> tuple[Parts, dict[str, float]]:
        clocks = counted.clocks.get(phase, 0)
        if not clocks:
            raise FlowError(f"{name}: the simulation has no clock of the phase {phase}")
        to_mw = TARGET_MHZ * 1e-6 / clocks
        found = {path: activity.energy(scope, phase, design, library, internal, 0.0) for path, scope in counted.scopes.items()}
        modules: dict[str, float] = {}
        for path, one in found.items():
            module = re.sub(rf"(__\d+)?{simulation.NETLIST_SUFFIX}$", "", counted.scopes[path].module)
            modules[module] = modules.get(module, 0.0) + one.total * to_mw
        logic = sum(one.nets + one.cells for one in found.values()) * to_mw
        return Parts(logic, clock_mw + sum(one.gated_clock for one in found.values()) * to_mw, leak_mw), modules

    streaming, by_module = parts(STREAMING)
    results = parts(OTHER)[0] if simulated.compared else None
    return SubsystemPower(streaming, results, clock_mw + leak_mw, by_module, counted.clocks, simulated.compared)
