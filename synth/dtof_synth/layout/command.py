# SPDX-License-Identifier: Apache-2.0
"""`make layout`: lays out the columns of several read-outs and writes the report."""

from __future__ import annotations

import argparse
import csv
import hashlib
import os
import pickle
import sys
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

from .. import batch, configuration, run_inputs, technology
from ..cli import all_configurations
from ..configuration import Configuration
from ..errors import FlowError
from ..run import with_wires
from ..technology import Technology
from . import flow, picture, report, results
from .flow import Result
from .tools import Cells

ROOT = Path(__file__).resolve().parents[3]
BUILD = ROOT / "build" / "layout"
SYNTH = ROOT / "build" / "synth"
DEFAULT = ("ezpointer", "hispointer", "poolpointer")


def _say(text: str) -> None:
    print(text, flush=True)


def _generic_areas() -> dict[str, float]:
    """Area of a column's logic in the generated library, um2, from `make synth`."""
    with (ROOT / "reports" / "area.csv").open(newline="", encoding="utf-8") as file:
        return {row["configuration"]: float(row["column_um2"]) for row in csv.DictReader(file)}


def _key(item: Configuration, technologies: Technology, cells: Cells, generic_area: float) -> str:
    """Hash of all inputs of a layout. The wording of the report is no input, so a new wording needs no new layouts."""
    folder = Path(__file__).resolve().parent
    said_only = {folder / name for name in ("command.py", "picture.py", "report.py")}
    digest = hashlib.sha256(f"{run_inputs.everything(technologies)} {item.rtl_parameters()} {generic_area}".encode())
    for file in sorted({*folder.glob("*.py"), *(ROOT / "synth" / "magic").iterdir(), *cells.folder.iterdir()} - said_only):
        digest.update(file.read_bytes())
    return digest.hexdigest()


def _work(item: Configuration, technologies: Technology, cells: Cells, generic_area: float) -> Result:
    """The layout of one configuration; reused if no input has changed."""
    key = _key(item, technologies, cells, generic_area)
    kept = BUILD / item.name / "result.pickle"
    try:
        kept_key, result = pickle.loads(kept.read_bytes())
        if kept_key == key:
            return result
    except (OSError, pickle.UnpicklingError, EOFError, AttributeError, TypeError, ValueError, ImportError):
        pass
    result = flow.lay_out(item, technologies, cells, generic_area, BUILD / item.name, _say)
    kept.write_bytes(pickle.dumps((key, result)))
    return result


def _slacks(named: dict[str, Configuration], found: dict[str, Result], jobs: int) -> dict[str, report.Slacks]:
    """Slacks of the arrays of `make synth` with the wire-load model, and with the wire lengths of these layouts."""
    prepared = technology.prepare(ROOT, SYNTH / "generic40", all_configurations(named))
    arrays = batch.run_all([batch.Job(named[name]) for name in found], prepared, SYNTH / "runs", jobs, _say)
    slacks = {}
    for name, result in found.items():
        slow = arrays[name]
        measured = with_wires(slow, prepared, SYNTH / "runs" / name, result.wire_per_sink * result.area_shrink)
        slacks[name] = report.Slacks(slow.timing["slow"].slack, slow.margins["slow"].slack, measured)
    return slacks


def _draw(items: list[Configuration], found: dict[str, Result], cells: Cells, library, output: Path) -> None:
    drawn = []
    for item in items:
        result = found[item.name]
        path = BUILD / item.name / "qflow" / "layout" / f"{result.block}.def"
        title = result.title if result.columns == 1 else f"{result.title}, {result.columns} columns"
        drawn.append(picture.Drawn(title, results.read_def(path.read_text(encoding="utf-8")),
                                   frozenset(result.sram_ports), frozenset(library.sequential)))
    picture.draw(drawn, picture.cell_sizes(cells.file("_stdcells.lef").read_text(encoding="utf-8")), output)


def _run(names: list[str], jobs: int) -> None:
    started = time.monotonic()
    named = configuration.load(ROOT / "configurations.toml")
    unknown = [name for name in names if name not in named]
    if unknown:
        raise FlowError(f"unknown configuration '{unknown[0]}'; known: {', '.join(named)}")
    items = [named[name] for name in names or DEFAULT]
    cells = Cells()
    prepared = technology.prepare(ROOT, BUILD / "technology", items, cells.file("_stdcells.lib"))
    areas = _generic_areas()
    found: dict[str, Result] = {}
    # The largest last in the list takes longest and starts first.
    with ProcessPoolExecutor(max_workers=jobs) as pool:
        waiting = {pool.submit(_work, item, prepared, cells, areas.get(item.name, 0.0) * flow.columns(item)): item
                   for item in reversed(items)}
        try:
            for done in as_completed(waiting):
                result = done.result()
                found[waiting[done].name] = result
                _say(f"{waiting[done].name}: {result.rule_errors} design rule errors, "
                     f"{result.comparison} {sum(result.seconds.values()):.0f} processor seconds")
        except FlowError:
            pool.shutdown(cancel_futures=True)
            raise
    folder = BUILD if names else ROOT / "reports"
    _draw(items, found, cells, prepared.slow, folder / "layout.png")
    command = "make layout" + (f' CONFIGURATIONS="{" ".join(names)}"' if names else "")
    ordered = [found[item.name] for item in items]
    slacks = _slacks(named, {item.name: found[item.name] for item in items}, jobs)
    (folder / "layout.md").write_text(report.text(ordered, list(slacks.values()), "layout.png", command), encoding="utf-8")
    report.write_csv(folder / "layout.csv", ordered, list(slacks.values()))
    _say(f"{(folder / 'layout.md').relative_to(ROOT)} written, {time.monotonic() - started:.0f} s; GDS: "
         f"{', '.join(f'build/layout/{item.name}/qflow/layout/{found[item.name].block}.gds' for item in items)}")


def main() -> int:
    parser = argparse.ArgumentParser(description="Columns placed, routed and checked in OSU 0.18 um.")
    parser.add_argument("configuration", nargs="*", help="names from configurations.toml, without renewing reports/; none: "
                        f"{', '.join(DEFAULT)}")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="layouts at the same time")
    arguments = parser.parse_args()
    try:
        _run(arguments.configuration, max(arguments.jobs, 1))
    except FlowError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return 130
    return 0
