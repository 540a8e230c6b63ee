# SPDX-License-Identifier: Apache-2.0
"""One configuration from RTL to numbers: synthesis, fan-out trees, timing in both corners, power."""

from __future__ import annotations

import hashlib
import json
import re
from dataclasses import asdict, dataclass
from pathlib import Path

from . import netlist, sram_model, tools
from .configuration import Configuration, bits_per_pixel, memories
from .errors import FlowError
from .library import Library
from .netlist import Counts

TOP = "dtof_array"
TARGET_MHZ = 330.0
FAST_MHZ = 500.0
KEPT_COLUMNS = 3
# Delay target for ABC: the target period less clock-to-data, setup and uncertainty of the slow corner.
LOGIC_SHARE = 0.72
ACTIVITY = 0.1  # of the data nets, transitions a clock cycle; docs/synthesis.md
HIT_RATE = 0.25  # share of timestamps that are detections, for the SRAM accesses

ABC_SCRIPT = ("+strash;ifraig;scorr;dc2;dch,-f;map,-B,0.9,{D};topo;buffer,-c,-N,16;"
              "upsize,{D};dnsize,{D};stime,-p")


@dataclass(frozen=True)
class Technology:
    """Everything a run needs besides the RTL."""

    typical: Library
    slow: Library
    slow_is_typical: bool
    kit: Path
    root: Path


@dataclass(frozen=True)
class Path_:
    """A timing path."""

    start: str
    end: str
    stages: int


@dataclass(frozen=True)
class Timing:
    """One corner. Slacks in ns at 330 MHz (setup, hold) and at 500 MHz (setup)."""

    slack: float
    hold_slack: float
    fast_slack: float
    fmax_mhz: float
    critical: Path_
    violations: list[str]


@dataclass(frozen=True)
class Power:
    """mW of the whole array at 330 MHz, typical corner."""

    logic: float
    sram: float
    clock: float

    @property
    def total(self) -> float:
        return self.logic + self.sram + self.clock


@dataclass(frozen=True)
class Result:
    """Figures of one configuration."""

    configuration: Configuration
    column: Counts
    shared: Counts
    memories: dict[str, str]
    sram_column_um2: float
    nand2_um2: float
    timing: dict[str, Timing]
    power: Power | None

    @property
    def columns(self) -> int:
        return self.configuration["SRAM_NUM"]

    @property
    def total_mm2(self) -> float:
        column = self.column.area + self.sram_column_um2
        return (column * self.columns + self.shared.area) / 1e6

    @property
    def bits_per_pixel(self) -> float:
        return bits_per_pixel(self.configuration)

    @property
    def column_kge(self) -> float:
        return self.column.area / self.nand2_um2 / 1000


def rtl_files(root: Path) -> list[Path]:
    """hdl/dtof.f without the behavioural technology; leaf first."""
    listing = root / "hdl" / "dtof.f"
    try:
        lines = listing.read_text(encoding="utf-8").split()
    except OSError as error:
        raise FlowError(f"{listing}: cannot read the file list ({error.strerror})") from None
    return [root / "hdl" / line for line in lines
            if line.endswith((".sv", ".v")) and not line.startswith("technology/")]


def _tie(library: Library, value: str) -> list[str]:
    return list(library.tie.get(value, ()))


def synthesise(configuration: Configuration, technology: Technology, folder: Path) -> dict:
    """Runs Yosys; returns the mapped design."""
    folder.mkdir(parents=True, exist_ok=True)
    library = technology.slow
    period_ps = 1e6 / TARGET_MHZ
    load = 4 * library.input_ff[library.inverter][next(iter(library.input_ff[library.inverter]))]
    constraints = folder / "abc.constr"
    constraints.write_text(f"set_driving_cell {library.inverter}\nset_load {load:.3f} [all_outputs]\n",
                           encoding="utf-8")
    settings = folder / "yosys_settings.tcl"
    tools.write_settings(settings, {
        "scripts": technology.root / "synth" / "yosys", "top": TOP,
        "rtl_files": rtl_files(technology.root), "rtl_include": technology.root / "hdl" / "package",
        "technology_files": [technology.kit / f"{kind.module}.sv" for kind in sram_model.KINDS.values()],
        "black_boxes": technology.kit / "sram40_blackbox.v",
        "liberty": library.path, "parameters": configuration.rtl_parameters(),
        "abc_constraints": constraints, "abc_period_ps": f"{period_ps * LOGIC_SHARE:.0f}",
        "abc_script": ABC_SCRIPT, "tie_low": _tie(library, "0"), "tie_high": _tie(library, "1"),
        "netlist_json": folder / "mapped.json"})
    tools.run_yosys(technology.root / "synth" / "yosys", settings, folder / "yosys.log", configuration.name)
    return json.loads((folder / "mapped.json").read_text(encoding="utf-8"))


def write_timing_netlist(design: dict, loads: dict[str, list[float]], technology: Technology,
                         folder: Path, name: str) -> None:
    """Verilog of the array with few real columns, and the stub's Liberty."""
    netlist.keep_columns(design, KEPT_COLUMNS)
    (folder / "column_stub.lib").write_text(
        netlist.stub_liberty(design, loads, technology.typical.voltage), encoding="utf-8")
    (folder / "timing.json").write_text(json.dumps(design), encoding="utf-8")
    settings = folder / "write_settings.tcl"
    tools.write_settings(settings, {"netlist_json": folder / "timing.json", "netlist": folder / "timing.v"})
    scripts = technology.root / "synth" / "yosys"
    tools.run_yosys(scripts, settings, folder / "write.log", name, "write_verilog.tcl")


def _path(text: str) -> Path_:
    start = re.search(r"Startpoint: (\S+)", text)
    end = re.search(r"Endpoint: (\S+)", text)
    if not start or not end:
        raise FlowError("OpenSTA reported no timing path")
    # A stage is a cell output on the path: rows "  delay  time  edge  instance/pin (cell)", data part only.
    data = text.split("data arrival time")[0]
    stages = len(re.findall(r"[v^] \S+/(?:Y|Z|ZN|Q|QN|S|CO|CON|SN|YC|YS|GCK) \(", data))
    return Path_(start.group(1), end.group(1), stages)


def _section(output: str, name: str) -> str:
    return output.split(f"{name}\n", 1)[1].split("\nDTOF_", 1)[0]


def time_corner(configuration: Configuration, technology: Technology, corner: str,
                folder: Path) -> tuple[Timing, str]:
    """Runs OpenSTA in one corner; returns the timing and the output (for power)."""
    library = technology.typical if corner == "typical" else technology.slow
    settings = folder / f"sta_{corner}_settings.tcl"
    tools.write_settings(settings, {
        "liberty_files": [library.path, technology.kit / f"sram40_{corner}.lib", folder / "column_stub.lib"],
        "netlist": folder / "timing.v", "top": TOP, "wire_load": library.wire_load,
        "constraints": technology.root / "constraints" / "dtof.sdc",
        "target_period": f"{1000 / TARGET_MHZ:.6f}", "fast_period": f"{1000 / FAST_MHZ:.6f}",
        "activity": ACTIVITY})
    output = tools.run_sta(technology.root / "synth" / "sta" / "timing.tcl", settings,
                           folder / f"sta_{corner}.log", f"{configuration.name} {corner}")
    slack, hold = map(float, re.search(r"^DTOF_SLACK (\S+) (\S+)", output, re.MULTILINE).groups())
    closing = float(re.search(r"^DTOF_CLOSING_PERIOD (\S+)", output, re.MULTILINE).group(1))
    fast = float(re.search(r"^DTOF_FAST_SLACK (\S+)", output, re.MULTILINE).group(1))
    violations = [line.strip() for line in _section(output, "DTOF_CHECKS").splitlines() if "VIOLATED" in line]
    return Timing(slack, hold, fast, 1000 / closing, _path(_section(output, "DTOF_PATH_MAX")), violations), output


def key(configuration: Configuration, technology: Technology) -> str:
    """Hash of all inputs of a run: same key, same result."""
    digest = hashlib.sha256()
    digest.update(json.dumps(configuration.rtl_parameters(), sort_keys=True).encode())
    synth = technology.root / "synth"
    files = [*rtl_files(technology.root), *(technology.root / "hdl").rglob("*.svh"),
             *synth.glob("yosys/*.tcl"), *synth.glob("sta/*.tcl"), *synth.glob("dtof_synth/*.py"),
             *(technology.root / "constraints").glob("*.sdc"), *technology.kit.iterdir(),
             technology.typical.path, technology.slow.path]
    for file in sorted(set(files)):
        digest.update(file.read_bytes())
    return digest.hexdigest()
