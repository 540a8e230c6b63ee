# SPDX-License-Identifier: Apache-2.0
"""From RTL to cells: elaboration, clock gates, and mapping by Yosys and ABC with one of several efforts."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from . import clock_gating, netlist, sram_kit, tools
from .canonical import canonical
from .configuration import Configuration, macro_sizes
from .errors import FlowError
from .technology import Technology

_SCRIPTS = Path(__file__).resolve().parents[1] / "yosys"


@dataclass(frozen=True)
class Effort:
    """Effort of ABC: its delay target as a share of the period, and its scripts for the column (which occurs many times) and for the shared
    logic. The rest of the period covers clock-to-data, setup, uncertainty and the late broadcast signals, which ABC does not model."""

    share: float
    column: str
    shared: str


_SIZING = "topo;buffer,-c;upsize,{D};dnsize,{D};stime,-p"
_START = "+strash;ifraig;scorr;dc2"
_BALANCE = "dch,-f;if,-g;strash"
_MAP = "dch,-f;map,-B,0.9,{D};topo;strash;dch,-f;map,-B,0.9,{D}"
_MAP_FROM_SMALL = "dch,-f;map,-B,0.7,{D};topo;strash;dch,-f;map,-B,0.7,{D};topo;strash;dch,-f;map,-B,0.9,{D}"
_AREA_MAP = "&get,-n;&syn3;&syn3;&dch,-f;&nf;&put"
_SMALLEST = ";".join([_START, _BALANCE, _AREA_MAP, _SIZING])
_SMALL = ";".join([_START, _BALANCE, _MAP, _SIZING])
_PAIR = ";".join([_START, _BALANCE, _MAP_FROM_SMALL, _SIZING])
_FAST = ";".join([_START, _BALANCE, _BALANCE, _MAP, _SIZING])
# From small to fast; the first that closes timing with margins is taken. The larger parts of the pool read-outs become slower
# as well as larger where ABC tries harder: what they miss is left to resizing.
EFFORTS = (Effort(0.62, _SMALLEST, _FAST), Effort(0.62, _SMALL, _FAST), Effort(0.55, _FAST, _FAST))
POOL_EFFORTS = (Effort(0.68, _PAIR, _SMALL), Effort(0.68, _FAST, _SMALL), Effort(0.68, _SMALL, _SMALL))
LAYOUT_EFFORT = Effort(0.68, _SMALL, _SMALL)


def efforts(configuration: Configuration) -> tuple[Effort, ...]:
    return POOL_EFFORTS if configuration.is_pool else EFFORTS


def rtl_files(root: Path) -> list[Path]:
    """RTL files of hdl/dtof.f without the behavioural technology; modules come after the modules that they contain."""
    listing = root / "hdl" / "dtof.f"
    try:
        lines = listing.read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise FlowError(f"{listing}: cannot read the file list ({error.strerror})") from None
    return [root / "hdl" / line for line in lines
            if line.endswith((".sv", ".v")) and not line.startswith(("//", "technology/"))]


def to_generic(root: Path, settings: Path, folder: Path, name: str) -> None:
    """Turns the RTL that the settings name, below `root`, into `folder`/generic.il by way of `folder`/elaborated.il. Checks must pass."""
    (folder / "elaborated.il").write_text(_elaborated(root, settings, folder, name), encoding="utf-8")
    tools.run_yosys(_SCRIPTS / "generic.tcl", settings, folder / "generic.log", name)


def _elaborated(root: Path, settings: Path, folder: Path, name: str) -> str:
    tools.run_yosys(_SCRIPTS / "elaborate.tcl", settings, folder / "elaborate.log", name)
    return canonical((folder / "elaborated.il").read_text(encoding="utf-8"), root)


def elaborate(configuration: Configuration, technology: Technology, folder: Path, kept_modules: Iterable[str] = ()) -> None:
    """Turns the RTL into the technology-independent netlist generic.il with clock gates. Checks must pass. `kept_modules` are not flattened
    into their surroundings; columns, pairs and engines never are."""
    to_generic(technology.root, _generic_settings(configuration, technology, folder, kept_modules), folder, configuration.name)
    clock_gating.insert(folder / "generic.il", technology.slow)


def elaborated(configuration: Configuration, technology: Technology, folder: Path) -> str:
    """The netlist from which `elaborate` goes on: all that a run reads of the RTL."""
    return _elaborated(technology.root, _generic_settings(configuration, technology, folder), folder, configuration.name)


def _generic_settings(configuration: Configuration, technology: Technology, folder: Path, kept_modules: Iterable[str] = ()) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    scripts = technology.root / "synth" / "yosys"
    settings = folder / "generic_settings.tcl"
    # Only this configuration's macros: Yosys numbers what it reads, and mapping depends on the numbers by a few
    # per cent, so another configuration's size would change this one's area.
    black_boxes, *technology_files = sram_kit.write_rtl_views(
        folder, macro_sizes(configuration))
    tools.write_settings(settings, {
        "scripts": scripts, "top": configuration.top,
        "rtl_files": rtl_files(technology.root), "rtl_include": technology.root / "hdl" / "common",
        "technology_files": technology_files, "black_boxes": black_boxes, "liberty": technology.slow.path,
        "parameters": configuration.rtl_parameters(), "kept_modules": [f"*{name}*" for name in kept_modules],
        "elaborated_netlist": folder / "elaborated.il", "generic_netlist": folder / "generic.il"})
    return settings


def map_to_cells(configuration: Configuration, technology: Technology, folder: Path, effort: Effort, naming: int = 0) -> dict:
    """Maps generic.il to cells; returns the design. Checks must pass. `naming`: 0 keeps the names of cells and wires; another number
    scrambles them, which changes ABC's result (namings.py)."""
    library = technology.slow
    inverter_ff = next(iter(library.input_ff[library.inverter].values()))
    constraints = folder / "abc.constr"
    constraints.write_text(f"set_driving_cell {library.inverter}\nset_load {4 * inverter_ff:.3f} [all_outputs]\n",
                           encoding="utf-8")
    scripts = technology.root / "synth" / "yosys"
    settings = folder / "map_settings.tcl"
    tools.write_settings(settings, {
        "scripts": scripts, "generic_netlist": folder / "generic.il", "liberty": library.path,
        "abc_constraints": constraints, "abc_period_ps": f"{1e6 / technology.target_mhz * effort.share:.0f}",
        "column_script": effort.column, "shared_script": effort.shared, "naming": str(naming),
        "tie_low": list(library.tie.get("0", ())),
        "tie_high": list(library.tie.get("1", ())), "netlist_json": folder / "mapped.json"})
    tools.run_yosys(scripts / "map.tcl", settings, folder / "map.log", configuration.name)
    design = json.loads((folder / "mapped.json").read_text(encoding="utf-8"))
    netlist.rename_parts(design)
    macros = {size.name for size in macro_sizes(configuration)}
    foreign = netlist.foreign_cells(design, library, macros)
    if foreign:
        raise FlowError(f"{configuration.name}: unmapped cells in the netlist: {', '.join(sorted(foreign))}")
    return design
