# SPDX-License-Identifier: Apache-2.0
"""Slacks and paths of a netlist in one corner: runs OpenSTA with synth/sta/timing.tcl and parses its output."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from pathlib import Path

from . import power, tools
from .errors import FlowError, found_in, given
from .standard_cells import CINV_FF, FO4_NS

FAST_MHZ = 500.0
_SLACK = re.compile(r"(-?\d+\.\d+) +slack")
NAMES = "names.json"  # beside the netlist: what its parts were called before spef.plain_names
BLOCKS = "blocks.json"  # beside it: kind of a block, its instances, how many the array has, and so on


@dataclass(frozen=True)
class Timing:
    """Timing of one corner. Slacks in ns: setup and hold at the technology's target clock, setup at 500 MHz. `slow_edges`: pins beyond the
    library's max_transition."""

    slack: float
    hold_slack: float
    fast_slack: float
    fmax_mhz: float
    start: str
    end: str
    stages: int
    slow_edges: int


@dataclass(frozen=True)
class Margin:
    """Timing of one corner with the margins of constraints/margins.sdc. Slacks in ns at the target clock."""

    slack: float
    hold_slack: float
    reset_slack: float  # the lesser of recovery and removal
    start: str  # of the slowest path
    end: str


@dataclass(frozen=True)
class TimedPath:
    """Input pins of a path, from behind the first register to the end."""

    pins: list[str]
    slack: float


@dataclass(frozen=True)
class Netlist:
    """Files for OpenSTA: Verilog, SPEF of the wires, and the Liberty files of one corner."""

    name: str  # in messages
    verilog: Path
    wires: Path
    liberty_files: list[Path]
    wire_load: str
    top: str


def _readable(name: str, called: dict[str, str]) -> str:
    """Name of a register or macro without generate levels, cell type and copy number. `called`: names of its parts before
    spef.plain_names."""
    name = "/".join(called.get(part, part) for part in name.split("/"))
    name = re.sub(r"\\+\w+$", "", name)
    name = re.sub(r"^\S*u_(column|pair)/(g_column\[\d+\]\.u_column\.)?", "column ", name)
    return re.sub(r"(\.(g_\w+|genblk\d+|u_macro|u_words))+$", "", name)


def _slack_of(text: str) -> float:
    return float(given(_SLACK.search(text), "OpenSTA: a path without slack")[1])


@dataclass(frozen=True)
class Report:
    """Output of OpenSTA for the requested steps of synth/sta/timing.tcl."""

    output: str
    called: dict[str, str]

    def timing(self) -> Timing:
        """Timing from the steps `closing` and `nominal`."""
        return Timing(self.slack, self._number("DTOF_SLACK", 1), self._number("DTOF_FAST_SLACK"),
                      1000 / self._number("DTOF_CLOSING_PERIOD"), *self._slowest_path("DTOF_PATH_MAX"),
                      self._section("DTOF_TRANSITION").count("VIOLATED"))

    @property
    def slack(self) -> float:
        """Setup slack from the step `nominal`, ns."""
        return self._number("DTOF_SLACK")

    @property
    def unchecked(self) -> dict[str, list[str]]:
        """Warnings of OpenSTA's check_setup from the step `check`: pins and ports for each kind of warning."""
        found: dict[str, list[str]] = {}
        names: list[str] = []
        for line in self._section("DTOF_CHECK").splitlines():
            warning = re.match(r"Warning: There (?:is|are) (?:\d+ )?(.*?)\.?$", line)
            if warning:
                names = found.setdefault(warning.group(1), [])
            elif line.startswith("  "):
                names.append(line.strip())
            elif line.strip():
                found.setdefault(line.strip(), [])
        return found

    @property
    def too_fast_for_sram(self) -> bool:
        """True if the clock is faster than an SRAM's minimum period; from the step `nominal`."""
        return "VIOLATED" in self._section("DTOF_MIN_PERIOD")

    def margin(self) -> Margin:
        """Slacks with margins, from the step `margins`."""
        start, end, _ = self._slowest_path("DTOF_MARGIN_PATH_MAX")
        reset = re.findall(r"^\*\*async_default\*\* +(-?\d+\.\d+)$", self._section("DTOF_RESET"), re.MULTILINE)
        if not reset:
            raise FlowError("OpenSTA reported no check of the reset")
        return Margin(self._number("DTOF_MARGIN_SLACK"), self._number("DTOF_MARGIN_SLACK", 1), min(map(float, reset)), start, end)

    @property
    def early(self) -> list[TimedPath]:
        """Paths that violate hold with margins, from the step `early`."""
        return self._paths("DTOF_EARLY")

    @property
    def spare(self) -> dict[str, float]:
        """Setup slack of each pin with margins, ns, from the step `spare`."""
        return {pin: float(slack) for pin, slack in (line.split() for line in self._section("DTOF_SPARE").splitlines())}

    @property
    def resized(self) -> list[tuple[str, str, str]]:
        """(kind of block or `top`, gate, library cell) for each gate that the step `resize` gave another drive."""
        return re.findall(r"^DTOF_RESIZED (\S+) (\S+) (\S+)$", self.output, re.MULTILINE)

    @property
    def dropped(self) -> list[tuple[str, str]]:
        """(kind of block, buffer) for each buffer that the step `resize` found unnecessary."""
        return re.findall(r"^DTOF_DROPPED (\S+) (\S+)$", self.output, re.MULTILINE)

    @property
    def resized_slack(self) -> float:
        """Setup slack with margins from the step `resize`, ns."""
        return self._number("DTOF_RESIZED_SLACK")

    @property
    def resized_area(self) -> float:
        """Area that the step `resize` added to the array, um2."""
        return self._number("DTOF_RESIZED_AREA")

    def _section(self, name: str) -> str:
        return self.output.split(f"{name}\n", 1)[1].split("\nDTOF_", 1)[0]

    def _number(self, label: str, index: int = 0) -> float:
        return float(found_in("OpenSTA", rf"^{label} (.*)$", self.output)[1].split()[index])

    def _slowest_path(self, section: str) -> tuple[str, str, int]:
        """(start, end, cells between them) of the path with the least slack. OpenSTA reports one path per path group, resets first."""
        reports = [report for report in self._section(section).split("Startpoint: ")[1:] if _SLACK.search(report)]
        if not reports:
            raise FlowError("OpenSTA reported no timing path")
        report = min(reports, key=_slack_of)
        start = report.split(maxsplit=1)[0]
        end = found_in("OpenSTA", r"Endpoint: (\S+)", report)[1]
        data = report.split("data arrival time")[0]
        pins = re.findall(r"[v^] (\S+) \(\S+\)$", data, re.MULTILINE)
        gates = [pin for pin in pins if not pin.startswith((start, end))]
        return _readable(start, self.called), _readable(end, self.called), len(gates)

    def _paths(self, section: str) -> list[TimedPath]:
        """Paths of a report's section that has input pins, without paths that end at a port. Counted from a path's end, every second pin is
        an input; the last input is the clock pin at the path's start."""
        found = []
        for report in self._section(section).split("Startpoint: ")[1:]:
            data, times = report.split("data arrival time", 1)
            pins = re.findall(r"[v^] (\S+) \(\S+\)$", data, re.MULTILINE)
            if "/" in pins[-1]:
                found.append(TimedPath(pins[:0:-2][::-1], _slack_of(times)))
        return found


def measure(netlist: Netlist, root: Path, target_mhz: float, log: Path, steps: tuple[str, ...],
            settings_of_steps: dict[str, tools.Setting] | None = None) -> Report:
    """Runs the given steps of synth/sta/timing.tcl in OpenSTA; some steps have settings. FlowError if OpenSTA fails or the clock is too
    fast for an SRAM."""
    settings = log.with_suffix(".tcl")
    tools.write_settings(settings, {
        "steps": list(steps), "liberty_files": netlist.liberty_files, "netlist": netlist.verilog, "wires": netlist.wires,
        "top": netlist.top, "wire_load": netlist.wire_load, "constraints": root / "constraints" / "dtof.sdc",
        "margins": root / "constraints" / "margins.sdc", "target_period": f"{1000 / target_mhz:.6f}",
        "fast_period": f"{1000 / FAST_MHZ:.6f}", "activity": power.ACTIVITY, "slew": f"{FO4_NS:.4f}",
        "load": f"{10 * CINV_FF:.4f}", **(settings_of_steps or {})})
    output = tools.run_sta(root / "synth" / "sta" / "timing.tcl", settings, log, netlist.name)
    called = json.loads((netlist.verilog.parent / NAMES).read_text(encoding="utf-8"))
    report = Report(output, called)
    if "nominal" in steps and report.too_fast_for_sram:
        raise FlowError(f"{netlist.name}: the clock is faster than an SRAM's minimum period (see {log})")
    return report
