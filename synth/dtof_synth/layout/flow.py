# SPDX-License-Identifier: Apache-2.0
"""One column from RTL to a checked layout and its figures."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from .. import mapping, netlist, sram_kit
from .. import tools as steps
from ..configuration import Configuration, memories
from ..errors import FlowError
from ..orfs import small
from ..technology import TARGET_MHZ, Technology
from . import block as blocks
from . import repair, results, wires
from .block import Block
from .results import Arrivals, Layout
from .tools import Cells, Project, processor_seconds

PERIOD_NS = 50.0  # far beyond every path: arrivals count, not slacks
SEEDS = (1, 2, 3)  # of the placement: another one where a check of the layout fails
REPAIRS = 2
POOL_DENSITY = 0.5  # at 0.6 the router found no way for a net of a pair of columns
ARRAY_COLUMNS = 4  # of the array that is elaborated around the column
PAIR = "dtof_pool_pair"


@dataclass
class Result:
    """Figures of one layout. Lengths in um, areas in um2, capacitances in fF, times in ns. `area_shrink`: ratio of lengths between the
    generated library and this one, by the area of their cells."""

    title: str
    block: str
    columns: int
    cells: int
    flip_flops: int
    cell_area: float
    die_width: float
    die_height: float
    sinks: int
    wire: float
    inner_sinks: int
    inner_wire: float
    clock_wire: float
    wire_ff: float
    area_shrink: float
    lone_vias: int
    seed: int
    rule_errors: int
    comparison: str
    bare: Arrivals
    model: Arrivals
    routed: Arrivals
    sram_ports: list[str]
    seconds: dict[str, float] = field(default_factory=dict)

    @property
    def density(self) -> float:
        return self.cell_area / (self.die_width * self.die_height)

    @property
    def wire_per_sink(self) -> float:
        return self.wire / self.sinks

    @property
    def inner_per_sink(self) -> float:
        return self.inner_wire / self.inner_sinks


def columns(configuration: Configuration) -> int:
    """Number of columns in the block that is laid out."""
    return min(2, configuration.module_columns)


def synthesise(configuration: Configuration, technology: Technology, folder: Path) -> Block:
    """Maps the column alone with the flow's own steps. In pool read-outs the block is a pair of columns, because routing all columns of an
    SRAM takes too long. The array around the block is small: a column does not depend on the number of columns."""
    mapping.elaborate(small(configuration, ARRAY_COLUMNS), technology, folder, (PAIR,) if configuration.is_pool else ())
    library = technology.slow
    scripts = technology.root / "synth" / "yosys"
    effort = mapping.LAYOUT_EFFORT
    inverter_ff = next(iter(library.input_ff[library.inverter].values()))
    constraints = folder / "abc.constr"
    constraints.write_text(f"set_driving_cell {library.inverter}\nset_load {4 * inverter_ff:.3f} [all_outputs]\n",
                           encoding="utf-8")
    settings = folder / "column_settings.tcl"
    steps.write_settings(settings, {
        "scripts": scripts, "generic_netlist": folder / "generic.il", "liberty": library.path,
        "abc_constraints": constraints, "abc_period_ps": f"{1e6 / TARGET_MHZ * effort.share:.0f}",
        "column_script": effort.column, "shared_script": effort.shared, "naming": "0",
        "tie_low": list(library.tie.get("0", ())), "tie_high": list(library.tie.get("1", ())),
        "netlist_json": folder / "column.json"})
    steps.run_yosys(scripts / "map_column.tcl", settings, folder / "column.log", configuration.name)
    design = json.loads((folder / "column.json").read_text(encoding="utf-8"))
    found = {name: module for name, module in netlist.modules(design).items()
               if name.endswith((*netlist.COLUMN_SUFFIXES, PAIR)) and module["cells"]}
    if len(found) != 1:
        raise FlowError(f"{configuration.name}: {len(found)} kinds of columns instead of one")
    name, module = found.popitem()

    def load(kind: str, pin: str) -> float:
        return library.input_ff[kind].get(pin, 0.0) if kind in library.input_ff else sram_kit.PIN_FF

    netlist.insert_fanout_trees(module, library, load, netlist.clock_nets(module))
    macros = {size.name for size in memories(configuration).values()}
    return blocks.from_module(name.split("\\")[-1], module, library, macros)


def _place_and_route(folder: Path, block: Block, cells: Cells, density: float | None, seed: int, seconds: dict[str, float]) -> Project:
    """Places and routes from an empty folder. FlowError if the router leaves a net out."""
    shutil.rmtree(folder, ignore_errors=True)
    project = Project(folder, block, cells, seed, density)
    with processor_seconds(seconds, "placement"):
        project.place()
    with processor_seconds(seconds, "routing"):
        failed = project.route()
    if failed:
        raise FlowError(f"{block.name}: {len(failed)} nets could not be routed, {failed[0]} among them (see {folder}/log)")
    return project


def _sound_layout(folder: Path, block: Block, cells: Cells, density: float | None, root: Path, seconds: dict[str, float],
                  say: Callable[[str], None]) -> tuple[Project, int, tuple[int, int, str]]:
    """First placement whose layout passes every check: project, seed, and what the checks found. A router that says that all nets are routed may
    have left one open, which only the comparison of netlists sees. FlowError with the last reason if no seed gives such a layout."""
    for seed in SEEDS:
        try:
            project = _place_and_route(folder, block, cells, density, seed, seconds)
            with processor_seconds(seconds, "checks"):
                return project, seed, _checked(project, root)
        except FlowError as error:
            if seed == SEEDS[-1]:
                raise
            say(f"{error}; the next placement is tried")
    raise AssertionError("there is no seed")


def _checked(project: Project, root: Path) -> tuple[int, int, str]:
    """Checks design rules and netlist comparison, FlowError if they fail. Returns the numbers of mended lone vias and of remaining errors,
    and Netgen's verdict."""
    mended = 0
    found = project.check(root)
    for _ in range(REPAIRS):
        if not found.total:
            break
        routed = project.path(".def")
        text, number = repair.mend_lone_vias(routed.read_text(encoding="utf-8"), found.boxes)
        if not number:
            break
        mended += number
        routed.write_text(text, encoding="utf-8")
        found = project.check(root)
    name = project.block.name
    if found.total:
        rules = ", ".join(f"{rule} ({len(boxes)})" for rule, boxes in found.boxes.items())
        raise FlowError(f"{name}: {found.total} design rule errors in the layout: {rules} (see {project.folder}/magic.log)")
    verdict = project.compare()
    if verdict != results.UNIQUE:
        raise FlowError(f"{name}: layout and netlist differ: {verdict} (see {project.layout}/comparison.out)")
    return mended, found.total, verdict


def _times(project: Project, technology: Technology, layout: Layout, ff: dict[str, float]) -> list[Arrivals]:
    """Arrival times without wires, with the wire-load model, and with the layout's wires."""
    block, library, folder = project.block, technology.typical, project.folder
    signals = wires.signal_nets(block)
    per_um = sum(ff[net] for net in signals if net in ff) / sum(layout.length(net) for net in signals)
    files = {"wires.lib": wires.wire_load_liberty(per_um), "block.v": blocks.verilog(block),
             "block.spef": wires.spef(block, library, results.read_trees(project.path(".rc").read_text(encoding="utf-8")),
                                      ff)}
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")
    settings = folder / "sta_settings.tcl"
    buffer = library.buffers[0]
    steps.write_settings(settings, {
        "liberty_files": [library.path, folder / "wires.lib"], "netlist": folder / "block.v", "top": block.name,
        "period": PERIOD_NS, "inputs": [port for port in block.inputs if port != blocks.CLOCK], "outputs": block.outputs,
        "driving_cell": buffer.name, "load": f"{4 * buffer.input_ff / 1000:.6g}", "wire_load": wires.MODEL,
        "parasitics": folder / "block.spef"})
    output = steps.run_sta(technology.root / "synth" / "sta" / "layout.tcl", settings, folder / "sta.log", block.name)
    return [results.arrivals(output, label, PERIOD_NS) for label in ("DTOF_BARE", "DTOF_MODEL", "DTOF_ROUTED")]


def lay_out(configuration: Configuration, technology: Technology, cells: Cells, generic_area: float, folder: Path,
            say: Callable[[str], None]) -> Result:
    """Lays out one configuration. FlowError with one sentence at the first step that fails. `generic_area`: area of the same column in the
    generated library."""
    seconds: dict[str, float] = {}
    library = technology.slow
    with processor_seconds(seconds, "synthesis"):
        block = synthesise(configuration, technology, folder / "synthesis")
    say(f"{configuration.name}: {len(block.cells)} cells, placing and routing")
    project, seed, (mended, errors, verdict) = _sound_layout(
        folder / "qflow", block, cells, POOL_DENSITY if configuration.is_pool else None, technology.root, seconds, say)
    layout = results.read_def(project.path(".def").read_text(encoding="utf-8"))
    per_um = wires.layer_ff_per_um(cells.file("_stdcells.lef").read_text(encoding="utf-8"))
    ff = wires.net_ff(layout, per_um)
    with processor_seconds(seconds, "timing"):
        bare, model, routed = _times(project, technology, layout, ff)
    signals = wires.signal_nets(block)
    inner = signals - set(block.ports)
    sinks = block.sinks(library)
    left, low, right, high = layout.die
    return Result(
        configuration.title, block.name, columns(configuration), len(block.cells),
        sum(cell.kind in library.sequential for cell in block.cells), block.area(library), right - left, high - low,
        sum(sinks[net] for net in signals), sum(layout.length(net) for net in signals),
        sum(sinks[net] for net in inner), sum(layout.length(net) for net in inner), layout.length(blocks.CLOCK),
        sum(ff.get(net, 0.0) for net in signals), (generic_area / block.area(library)) ** 0.5 if generic_area else 0.0,
        mended, seed, errors, verdict, bare, model, routed, block.sram_ports, seconds)
