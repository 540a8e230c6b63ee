# SPDX-License-Identifier: Apache-2.0
"""`elaborated.py REPORT` prints all that a report of the synthesis takes from hdl/, configurations.toml, readouts.toml and configuration.py: what
its Python reads of each configuration, and a digest of each elaborated netlist. While this is the same, a change of these files changes no figure
of the report (scripts/reports.py confirm).

The digest is that of the canonical netlist (canonical.py), from which the flow goes on. ABC's result depends on names and on the order of cells,
which are in the digest, too. So an equal digest stands for an equal result.
"""

from __future__ import annotations

import argparse
import hashlib
import inspect
import json
import os
import sys
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from . import configuration, growth, library, mapping, run_inputs, scale, scene_power, signalled_clear, sram_kit, standard_cells, subsystem, tools
from . import technology as technologies
from .canonical import canonical
from .cli import ROOT, all_configurations
from .configuration import Configuration, macro_sizes
from .errors import FlowError

BUILD = ROOT / "build" / "elaborated"
Named = dict[str, Configuration]
_OF_ONE_REPORT = {"scale.py": "scale"}  # what other reports do not read


def _layout(named: Named) -> list[Configuration]:
    from .layout.command import DEFAULT  # which imports what draws pictures
    return [named[name] for name in DEFAULT]


def _power(named: Named) -> list[Configuration]:
    whole = [named[name] for name in scene_power.CONFIGURATIONS]
    return whole + [scene_power.small(item).with_parameters(f"{item.name}_small") for item in whole]


def _scale(named: Named) -> list[Configuration]:
    bases = [named[readout] for readout in scale.READOUTS]
    return [item for base in bases for size in scale.SIZES for item in scale.parts(base, *size)] + [scale.array(base, *scale.WHOLE) for base in bases]


# Configurations whose netlists a report's command makes.
REPORTS: dict[str, Callable[[Named], list[Configuration]]] = {
    "synth": lambda named: [*named.values(), *signalled_clear.configurations(named)],
    "power": _power,
    "layout": _layout,
    "subsystem": lambda named: [named[name] for name in subsystem.CONFIGURATIONS],
    "growth": lambda named: list({point.name: point for _, _, point in growth.sweep(named)}.values()),
    "namings": lambda named: [item for item in named.values() if not item.variant_of],
    "scale": _scale,
}


# ---- Elaboration -----------------------------------------------------------------------------------------

def elaborate(item: Configuration, root: Path, folder: Path, whole_subsystem: bool = False) -> str:
    """The canonical netlist of an array, as in mapping.elaborate, or of dtof_subsystem around it, as in subsystem.generic."""
    folder.mkdir(parents=True, exist_ok=True)
    liberty = folder / "slow.lib"
    liberty.write_text(standard_cells.library(standard_cells.SLOW), encoding="utf-8")
    black_boxes, *technology_files = sram_kit.write_rtl_views(folder, macro_sizes(item))
    written = folder / "elaborated.il"
    script = root / "synth" / "yosys" / "elaborate.tcl"
    settings: dict[str, tools.Setting] = {
        "scripts": root / "synth" / "yosys", "top": item.top, "rtl_files": list(mapping.rtl_files(root)), "rtl_include": root / "hdl" / "common",
        "technology_files": list(technology_files), "black_boxes": black_boxes, "liberty": liberty, "parameters": dict(item.rtl_parameters()),
        "elaborated_netlist": written}
    if whole_subsystem:
        gate = folder / f"{subsystem.CLOCK_GATE}.sv"
        gate.write_text(subsystem.clock_gate(library.read(liberty)), encoding="utf-8")
        script = root / "synth" / "subsystem" / "elaborate.tcl"
        around: dict[str, tools.Setting] = {
            "top": subsystem.TOP, "technology_files": [*technology_files, gate], "parameters": dict(subsystem.parameters(item, root))}
        settings |= around | subsystem.module_patterns()
    tools.write_settings(folder / "settings.tcl", settings)
    tools.run_yosys(script, folder / "settings.tcl", folder / "elaborate.log", item.name)
    text = canonical(written.read_text(encoding="utf-8"), root)
    written.unlink()
    return text


def digest(netlist: str) -> str:
    return hashlib.blake2b(netlist.encode(), digest_size=12).hexdigest()


def _work(job: tuple[Configuration, Path, Path, bool]) -> str:
    return digest(elaborate(*job))


# ---- What the flow's Python reads ------------------------------------------------------------------------

def read_by_the_flow(root: Path, report: str) -> list[str]:
    """Parameters that the flow's Python names, without configuration.py, whose results are printed. What no file names enters a report by
    elaboration alone."""
    return run_inputs.named_parameters(file for file in (root / "synth" / "dtof_synth").rglob("*.py")
                                       if file.name != "configuration.py" and _OF_ONE_REPORT.get(file.name, report) == report)


def derived(item: Configuration) -> dict[str, str]:
    """All that configuration.py derives from a configuration: each property, and each public function of a configuration alone. "none": the
    read-out has nothing like this."""
    found = {name: getattr(item, name) for name, value in vars(Configuration).items() if isinstance(value, property) and name != "described"}
    for name, function in inspect.getmembers(configuration, inspect.isfunction):
        own = function.__module__ == configuration.__name__ and not name.startswith("_")
        if own and [*inspect.signature(function).parameters] == ["configuration"]:
            try:
                found[name] = function(item)
            except (FlowError, KeyError):
                found[name] = "none"
    return {name: str(value) for name, value in found.items()}


def described(item: Configuration, parameters: Iterable[str]) -> str:
    """What the flow's Python reads of a configuration, in one line."""
    return json.dumps({"title": item.title, "variant_of": item.variant_of, "thesis_mm2": item.thesis_mm2, "note": item.note,
                       "simulation": item.simulation, "derived": derived(item), **run_inputs.read_by_python(item, parameters)}, ensure_ascii=False)


def lines(report: str, root: Path, folder: Path, workers: int) -> list[str]:
    """The output for a report. Arrays of `scale` take too long to elaborate; their parameters are printed instead, and the RTL is not covered."""
    named = configuration.load(root / "configurations.toml")
    chosen = REPORTS[report](named)
    parameters = read_by_the_flow(root, report)
    text = [f"sram {size.name} {' '.join(users)}" for size, users in sorted(technologies.needed_sizes(all_configurations(named)).items())]
    text += [f"configuration {item.name} {described(item, parameters)}" for item in chosen]
    if report == "scale":
        return text + [f"parameters {item.name} {json.dumps(item.rtl_parameters())}" for item in chosen]
    jobs = [(item, root, folder / item.name, False) for item in chosen]
    if report == "subsystem":
        jobs += [(item, root, folder / f"{item.name}_subsystem", True) for item in chosen]
    with ProcessPoolExecutor(workers) as pool:
        found = list(pool.map(_work, jobs))
    return text + [f"netlist {place.name} {one}" for (_, _, place, _), one in zip(jobs, found, strict=True)]


def main() -> int:
    parser = argparse.ArgumentParser(description="Digests of the elaborated netlists of a report of the synthesis, and what the flow reads beside "
                                     "them.")
    parser.add_argument("report", choices=REPORTS)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="netlists at the same time")
    arguments = parser.parse_args()
    try:
        print("\n".join(lines(arguments.report, ROOT, BUILD, max(arguments.jobs, 1))))
    except FlowError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0
