# SPDX-License-Identifier: Apache-2.0
"""Runs qflow's steps, Magic and Netgen, and turns their failures into one line."""

from __future__ import annotations

import os
import re
import resource
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from ..errors import FlowError
from . import block as blocks
from . import pins, results
from .block import Block

QFLOW = Path("/usr/lib/qflow")
STEPS = ("synthesis", "placement", "routing", "checks", "timing")


@dataclass(frozen=True)
class Cells:
    """Files of Debian's qflow-tech-osu018: cells as Liberty and LEF, without transistor layouts."""

    folder: Path = Path("/usr/share/qflow/tech/osu018")
    name: str = "osu018"

    def file(self, end: str) -> Path:
        found = self.folder / f"{self.name}{end}"
        if not found.is_file():
            raise FlowError(f"{found} is missing; scripts/install_packages.sh layout installs it")
        return found


@contextmanager
def processor_seconds(seconds: dict[str, float], step: str) -> Iterator[None]:
    """Adds the processor time of the processes started inside; time of other jobs on the machine is not counted."""
    def used() -> float:
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime
    before = used()
    yield
    seconds[step] = seconds.get(step, 0.0) + used() - before


def _run(command: list[str], folder: Path, log: Path, **environment: str) -> str:
    try:
        finished = subprocess.run(command, cwd=folder, env={**os.environ, **environment}, check=False,
                                  stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    except FileNotFoundError:
        raise FlowError(f"{command[0]} is not installed; scripts/install_packages.sh layout installs it") from None
    output = finished.stdout.decode("utf-8", "replace")
    log.write_text(output, encoding="utf-8")
    return output


class Project:
    """A folder for qflow's scripts. `seed`: graywolf's seed. `density`: share of the rows that cells fill, the rest being fillers; None:
    graywolf's own density."""

    def __init__(self, folder: Path, block: Block, cells: Cells, seed: int, density: float | None = None) -> None:
        self.folder, self.block, self.cells = folder, block, cells
        self.layout = folder / "layout"
        for name in ("source", "synthesis", "layout", "log"):
            (folder / name).mkdir(parents=True, exist_ok=True)
        settings = {"projectpath": folder, "techdir": cells.folder, "techname": cells.name,
                    "sourcedir": folder / "source", "synthdir": folder / "synthesis", "layoutdir": self.layout,
                    "logdir": folder / "log", "scriptdir": QFLOW / "scripts", "bindir": QFLOW / "bin"}
        self._write("qflow_vars.sh", "#!/usr/bin/tcsh -f\n" + "".join(f"set {key}={value}\n"
                                                                    for key, value in settings.items()))
        self._write("project_vars.sh", "" if density is None else f"set initial_density={density}\n")
        self._write("log/synth.log", "done\n")
        self._write(f"synthesis/{block.name}_powerground", 'set vddnet="vdd"\nset gndnet="gnd"\n')
        self._write(f"synthesis/{block.name}.blif", blocks.blif(block))
        parameters = cells.file(".par").read_text(encoding="utf-8")
        self._write(f"layout/{block.name}.par", re.sub(r"(random\.seed\s*:) \d+", rf"\1 {seed}", parameters))
        self._write(f"layout/{block.name}.cel2", blocks.pin_sides(block))

    def _write(self, name: str, text: str) -> None:
        (self.folder / name).write_text(text, encoding="utf-8")

    def path(self, end: str) -> Path:
        """File in the layout folder: the block's name followed by `end`."""
        return self.layout / f"{self.block.name}{end}"

    def _script(self, script: str, *options: str) -> str:
        return _run([str(QFLOW / "scripts" / script), *options, str(self.folder), self.block.name], self.folder,
                    self.folder / f"{script}.log")

    def place(self) -> None:
        self.path("_unroute.def").unlink(missing_ok=True)
        self._script("placement.sh", "-d")
        unrouted = self.path("_unroute.def")
        if not unrouted.is_file():
            raise FlowError(f"{self.block.name}: qflow's placement failed (see {self.folder / 'log' / 'place.log'})")
        unrouted.write_text(pins.arrange(unrouted.read_text(encoding="utf-8"), self.block), encoding="utf-8")

    def route(self) -> list[str]:
        """Routes the block; returns the nets that failed."""
        self._script("router.sh")
        log = self.folder / "log" / "route.log"
        return results.failed_nets(log.read_text(encoding="utf-8") if log.is_file() else "")

    def check(self, root: Path) -> results.Violations:
        """Runs Magic: writes the extracted netlist and GDS, and checks design rules."""
        for end in (".spice", ".gds"):
            self.path(end).unlink(missing_ok=True)
        (self.layout / ".magicrc").write_bytes(self.cells.file(".magicrc").read_bytes())
        output = _run(["magic", "-dnull", "-noconsole", str(root / "synth" / "magic" / "layout.tcl")], self.layout,
                      self.folder / "magic.log", DTOF_NAME=self.block.name, DTOF_LEF=str(self.cells.file("_stdcells.lef")))
        found = results.violations(output)
        for end in (".spice", ".gds"):
            if not self.path(end).is_file():
                raise FlowError(f"{self.block.name}: Magic wrote no {end} (see {self.folder / 'magic.log'})")
        return found

    def compare(self) -> str:
        """Compares the extracted netlist with the mapped one by Netgen; returns the verdict."""
        orders = blocks.pin_orders(self.path(".spice").read_text(encoding="utf-8"))
        reference = self.layout / "reference.spice"
        reference.write_text(blocks.spice(self.block, orders), encoding="utf-8")
        name = self.block.name
        output = _run(["netgen-lvs", "-batch", "lvs", f"{name}.spice {name}", f"reference.spice {name}",
                       str(self.cells.file("_setup.tcl")), "comparison.out", "-blackbox"], self.layout,
                      self.folder / "netgen.log")
        return results.lvs_verdict(output)
