# SPDX-License-Identifier: Apache-2.0
"""Area and power of each part of poolPointer: the flow with the parts' modules kept, counted in area and simulated for power.

An engine of two columns and one pair go through the flow as in scene_power.py, but the modules in them are not flattened, so
that each has cells and transitions of its own. Logic is no longer shared across the parts' borders, so that the sum is
somewhat more than the array's; it is for comparing the parts with each other.
"""

from __future__ import annotations

import copy
import csv
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from . import activity, liberty, netlist, scene_power, sram_kit, sram_model
from .activity import STREAMING
from .configuration import Configuration, engine_memories, memories
from .mapping import efforts, elaborate, map_to_cells
from .technology import TARGET_MHZ, Technology

CONFIGURATION = "poolpointer"
KEPT_MODULES = ("dtof_pool_column", "dtof_timestamp_input", "dtof_label_match", "dtof_pool_pixel_update", "dtof_pixel_distance", "dtof_pool_track_update",
                "dtof_twin_pointer_update", "dtof_pool_candidate_decoder", "dtof_beside_evidence", "dtof_label_chain", "dtof_smoothing")
SRAM = "SRAM"


@dataclass(frozen=True)
class Part:
    """Instances of one name in the columns of an SRAM or in an engine, scaled to the whole array."""

    block: str  # quad or engine
    instance: str  # without the hierarchy above it; empty: what is in no part; SRAM: the block's macros
    area_um2: float
    power_mw: dict[str, float]  # by light, while acquisitions stream in


def _instances(design: dict) -> dict[str, tuple[str, str]]:
    """(block, instance) of every scope of activity.scopes_of; a scope comes before those inside it."""
    found: dict[str, tuple[str, str]] = {}

    def enter(module: dict, path: str, block: str) -> None:
        number = 0
        for name, cell in module["cells"].items():
            inner = netlist.modules(design).get(cell["type"])
            if inner and inner["cells"] or cell["type"].startswith("sram_"):
                below, number = f"{path}{activity.INSTANCE}{number}", number + 1
                if inner and inner["cells"]:
                    kind = block or cell["type"].rsplit("_", 1)[-1]
                    found[below] = (kind, name.rsplit(".", 1)[-1] if block else "")
                    enter(inner, f"{below}.", kind)

    enter(netlist.top(design), "", "")
    return found


def measure(configuration: Configuration, technology: Technology, folder: Path, seed: int,
            say: Callable[[str], None]) -> list[Part]:
    """Area and power of the parts of the columns, then of the engine, by name. FlowError if the netlist differs from its RTL or a step
    fails."""
    library = technology.typical
    group = liberty.read(library.path)
    internal = activity.internal_energies(group, library.energy_fj)
    leakage = {cell.name: cell.number("cell_leakage_power") for cell in group.children("cell")}
    times = {"quad": configuration.column_modules, "engine": configuration.engines}
    case = scene_power.small_case(configuration, seed)
    elaborate(case.configuration, technology, folder, KEPT_MODULES)
    mapped = map_to_cells(case.configuration, technology, folder, efforts(configuration)[0])
    instances = _instances(mapped)
    area = {(block, SRAM): times[block] * sum(sram_model.macro(size).area for size in sizes.values())
            for block, sizes in (("quad", memories(configuration)), ("engine", engine_memories(configuration)))}
    power: dict[str, dict[tuple[str, str], float]] = {}
    for light, klux in scene_power.KLUX.items():
        design = copy.deepcopy(mapped)
        counted = scene_power.count_activity(design, case, technology, folder, klux)
        own = power.setdefault(light, {})
        for path, (block, instance) in instances.items():
            scope = counted.scopes[path]
            module = netlist.modules(design)[scope.module]
            cells = netlist.count(module, library)
            energy = activity.energy(scope, STREAMING, design, library, internal, sram_kit.PIN_FF)
            clocks = counted.clocks[STREAMING]
            fj = (energy.total - energy.sram) / clocks + cells.clock_energy_fj
            leak_nw = sum(leakage.get(cell["type"], 0.0) for cell in module["cells"].values())
            for part, mw in (((block, instance), fj * TARGET_MHZ * 1e-6 + leak_nw * 1e-6),
                             ((block, SRAM), energy.sram / clocks * TARGET_MHZ * 1e-6)):
                own[part] = own.get(part, 0.0) + mw * times[block]
            if len(power) == 1:
                area[(block, instance)] = area.get((block, instance), 0.0) + cells.area * times[block]
        say(f"{configuration.name}, {light}: {sum(own.values()):.1f} mW")
    return [Part(*part, area[part], {light: own[part] for light, own in power.items()})
            for part in sorted(area, key=lambda part: (part[0] != "quad", part[1]))]


def write_csv(path: Path, parts: list[Part]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["block", "instance", "area_um2", *(f"{light}_mw" for light in scene_power.KLUX)])
        for part in parts:
            writer.writerow([part.block, part.instance, f"{part.area_um2:.0f}", *(f"{mw:.3f}" for mw in part.power_mw.values())])
