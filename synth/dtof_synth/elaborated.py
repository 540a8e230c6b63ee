# SPDX-License-Identifier: Apache-2.0
"""`elaborated.py REPORT` prints all that a report of the synthesis takes from hdl/, configurations.toml and readouts.toml: what its Python reads
of each configuration, and a digest of each elaborated netlist. While this is the same, a change of these files changes no figure of the report
(scripts/reports.py confirm).

The digest is taken of the canonical netlist (canonical.py), from which the flow goes on. It holds the cells, their parameters and how they are
connected, module by module, and neither names of nets nor cells that drive nothing. So the digest says that the logic is the same. Names can still
move an area by some tenths of a per cent, because ABC's result depends on them.
"""

from __future__ import annotations

import argparse
import ast
import hashlib
import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from pathlib import Path
from typing import Any

from . import configuration, growth, library, readouts, run, scene_power, signalled_clear, sram_kit, standard_cells, subsystem, tools
from . import technology as technologies
from .canonical import canonical
from .cli import ROOT, all_configurations
from .configuration import Configuration, engine_memories, memories
from .errors import FlowError

BUILD = ROOT / "build" / "elaborated"
Named = dict[str, Configuration]
Json = dict[str, Any]
# Attributes that no pass of the flow reads after the checks of the RTL. Others, as keep, stay in the digest.
NO_LOGIC = re.compile(r"src|hdlname|dynports|wiretype|enum_\w+|top")
_TEXT_ONLY = {"title", "enumerator", "summary", "style", "model", "choices", "defaults", "memories", "word"}  # of a read-out


def _layout(named: Named) -> list[Configuration]:
    from .layout.command import DEFAULT  # which imports what draws pictures
    return [named[name] for name in DEFAULT]


def _power(named: Named) -> list[Configuration]:
    whole = [named[name] for name in scene_power.CONFIGURATIONS]
    return whole + [scene_power.small(item).with_parameters(f"{item.name}_small") for item in whole]


# Configurations whose netlists a report's command makes.
REPORTS: dict[str, Callable[[Named], list[Configuration]]] = {
    "synth": lambda named: [*named.values(), *signalled_clear.configurations(named)],
    "power": _power,
    "layout": _layout,
    "subsystem": lambda named: [named[name] for name in subsystem.CONFIGURATIONS],
    "growth": lambda named: list({point.name: point for _, _, point in growth.sweep(named)}.values()),
    "namings": lambda named: [item for item in named.values() if not item.variant_of],
}


# ---- Digest of a netlist ---------------------------------------------------------------------------------

def _hash(*parts: object) -> str:
    return hashlib.blake2b(json.dumps(parts, sort_keys=True).encode(), digest_size=12).hexdigest()


def _attributes(of: Json) -> Json:
    return {name: value for name, value in of.get("attributes", {}).items() if not NO_LOGIC.fullmatch(name)}


def _structure(module: Json, kind: Callable[[str], str]) -> str:
    """Digest of a module's cells, and of how they are connected. `kind`: what the type of a cell stands for.

    Each cell begins with a label of its type, its parameters and, for an instance, its name. In each round a cell takes the labels of the cells
    that drive its inputs into its label, until no round tells more cells apart. Names of nets do not enter.
    """
    source: dict[int, tuple[str, str, int]] = {}  # of a bit: cell (or nothing, for a port), port, place
    for name, port in module["ports"].items():
        if port["direction"] != "output":
            source |= {bit: ("", name, place) for place, bit in enumerate(port["bits"]) if isinstance(bit, int)}
    first: dict[str, str] = {}
    inputs: dict[str, list[tuple[str, list[int | str]]]] = {}
    for name, cell in module["cells"].items():
        is_instance = not cell["type"].startswith("$") or cell["type"].startswith("$paramod")
        first[name] = _hash(kind(cell["type"]), {} if is_instance else cell["parameters"], _attributes(cell), "" if name.startswith("$") else name)
        inputs[name] = []
        for port, bits in sorted(cell["connections"].items()):
            if cell.get("port_directions", {}).get(port) == "output":
                source |= {bit: (name, port, place) for place, bit in enumerate(bits) if isinstance(bit, int)}
            else:
                inputs[name].append((port, bits))
    marks: dict[int | str, list[Json]] = {}  # `keep` and the like of the nets of a bit
    for net in module["netnames"].values():
        if found := _attributes(net):
            for place, bit in enumerate(net["bits"]):
                marks.setdefault(bit, []).append(found | {"init": found["init"][-1 - place]} if "init" in found else found)
    label = first

    def of(bit: int | str) -> list[object]:
        cell, port, place = source.get(bit, ("", "", 0)) if isinstance(bit, int) else ("", bit, 0)
        return [label.get(cell, ""), port, place, sorted(marks.get(bit, []), key=str)]

    known = 0
    while len(set(label.values())) > known:
        known = len(set(label.values()))
        label = {name: _hash(first[name], [[port, [of(bit) for bit in bits]] for port, bits in inputs[name]]) for name in first}
    outputs = {name: [of(bit) for bit in port["bits"]] for name, port in module["ports"].items() if port["direction"] != "input"}
    kept = sorted(_hash(found, of(bit)) for bit, found in marks.items())
    ports = {name: [port["direction"], len(port["bits"])] for name, port in module["ports"].items()}
    return _hash(sorted(label.values()), ports, outputs, kept, _attributes(module))


def digest(netlist: str) -> str:
    """Digest of the top of a canonical netlist (RTLIL) and of all below it."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "netlist.il").write_text(netlist, encoding="utf-8")
        done = subprocess.run(["yosys", "-q", "-p", "read_rtlil netlist.il; opt_clean; write_json netlist.json"], cwd=folder, check=False,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode:
            raise FlowError(f"Yosys does not read the elaborated netlist: {done.stdout.strip()}")
        modules = json.loads((folder / "netlist.json").read_text(encoding="utf-8"))["modules"]
    tops = [name for name, module in modules.items() if "top" in module["attributes"]]
    if not tops:
        raise FlowError("the elaborated netlist has no top")
    known: dict[str, str] = {}

    def of(kind: str) -> str:
        if kind in modules and kind not in known:
            known[kind] = _structure(modules[kind], of)
        return f"{subsystem.plain_module(kind)} {known[kind]}" if kind in known else kind

    return of(tops[0]).split()[-1]


# ---- Elaboration -----------------------------------------------------------------------------------------

def elaborate(item: Configuration, root: Path, folder: Path, whole_subsystem: bool = False) -> str:
    """The canonical netlist of an array, as in run.elaborate, or of dtof_subsystem around it, as in subsystem.generic."""
    folder.mkdir(parents=True, exist_ok=True)
    liberty = folder / "slow.lib"
    liberty.write_text(standard_cells.library(standard_cells.SLOW), encoding="utf-8")
    black_boxes, *technology_files = sram_kit.write_rtl_views(folder, [*memories(item).values(), *engine_memories(item).values()])
    written = folder / "elaborated.il"
    script = root / "synth" / "yosys" / "elaborate.tcl"
    settings: dict[str, tools.Setting] = {
        "scripts": root / "synth" / "yosys", "top": item.top, "rtl_files": list(run.rtl_files(root)), "rtl_include": root / "hdl" / "common",
        "technology_files": list(technology_files), "black_boxes": black_boxes, "liberty": liberty, "parameters": dict(item.rtl_parameters()),
        "elaborated_netlist": written}
    if whole_subsystem:
        gate = folder / f"{subsystem.CLOCK_GATE}.sv"
        gate.write_text(subsystem.clock_gate(library.read(liberty)), encoding="utf-8")
        script = root / "synth" / "subsystem" / "elaborate.tcl"
        settings |= {"top": subsystem.TOP, "technology_files": [*technology_files, gate], "parameters": dict(subsystem.parameters(item, root)),
                     "array_modules": [f"*{name}" for name in subsystem.ARRAYS]}
    tools.write_settings(folder / "settings.tcl", settings)
    tools.run_yosys(script, folder / "settings.tcl", folder / "elaborate.log", item.name)
    text = canonical(written.read_text(encoding="utf-8"), root)
    written.unlink()
    return text


def _work(job: tuple[Configuration, Path, Path, bool]) -> str:
    return digest(elaborate(*job))


# ---- What the flow's Python reads ------------------------------------------------------------------------

def read_by_the_flow(root: Path) -> list[str]:
    """Parameters that the flow's Python names. What no file names enters a report by elaboration alone."""
    known = readouts.load().parameters.keys()
    return sorted({node.value for file in (root / "synth" / "dtof_synth").rglob("*.py")
                   for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
                   if isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value in known})


def described(item: Configuration, parameters: Iterable[str]) -> str:
    """What the flow's Python reads of a configuration, in one line."""
    readout = {name: readouts.evaluate(value, item.parameters) if name in ("passes", "bin_width", "scan_width", "decode_clocks")
               and value is not None else value for name, value in asdict(item.described).items() if name not in _TEXT_ONLY}
    return json.dumps({
        "title": item.title, "variant_of": item.variant_of, "thesis_mm2": item.thesis_mm2, "note": item.note, "readout": readout,
        "parameters": {name: item[name] for name in parameters if name in item.parameters},
        "memories": {name: size.name for name, size in memories(item).items()},
        "engine_memories": {name: size.name for name, size in engine_memories(item).items()}}, ensure_ascii=False)


def lines(report: str, root: Path, folder: Path, workers: int) -> list[str]:
    """The output for a report."""
    named = configuration.load(root / "configurations.toml")
    chosen = REPORTS[report](named)
    parameters = read_by_the_flow(root)
    text = [f"sram {size.name} {' '.join(users)}" for size, users in sorted(technologies.needed_sizes(all_configurations(named)).items())]
    text += [f"configuration {item.name} {described(item, parameters)}" for item in chosen]
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
