# SPDX-License-Identifier: Apache-2.0
"""Area of dtof_subsystem's line buffer relative to its array. dtof_line_buffer is mapped alone, with the default number of lines, in
registers."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from . import tools
from .configuration import Configuration
from .errors import FlowError
from .goals import Goal
from .mapping import rtl_files
from .run import Result
from .technology import Technology

GOAL = 0.03  # of the array
Size = tuple[int, int, int]  # lines of an acquisition, of the buffer, bits of a line


def size(configuration: Configuration) -> Size:
    """Size of the line buffer for dtof_subsystem's default BUFFER_LINES with CLOCK_WAITS = 1."""
    slots = configuration["SLOTS"]
    return configuration["PIXELS_PER_SRAM"] * slots, max(slots, 2), configuration["SRAM_NUM"] * configuration["NP"]


def area(of: Size, technology: Technology, folder: Path) -> float:
    """Area in um2; FlowError if a step fails."""
    folder.mkdir(parents=True, exist_ok=True)
    acquisition_lines, lines, width = of
    settings, log = folder / "line_buffer_settings.tcl", folder / "line_buffer.log"
    tools.write_settings(settings, {
        "rtl_files": rtl_files(technology.root), "rtl_include": technology.root / "hdl" / "common", "liberty": technology.typical.path,
        "acquisition_lines": acquisition_lines, "lines": lines, "width": width})
    tools.run_yosys(technology.root / "synth" / "yosys" / "line_buffer.tcl", settings, log, "dtof_line_buffer")
    found = re.findall(r"Chip area for .*: ([0-9.]+)", log.read_text(encoding="utf-8"))
    if not found:
        raise FlowError(f"dtof_line_buffer: Yosys counts no area (see {log})")
    return float(found[-1])


def areas(results: Iterable[Result], technology: Technology, folder: Path) -> dict[str, float]:
    """Area in um2 by configuration name; equal sizes are mapped once."""
    kept: dict[Size, float] = {}
    found = {}
    for result in results:
        of = size(result.configuration)
        if of not in kept:
            kept[of] = area(of, technology, folder)
        found[result.configuration.name] = kept[of]
    return found


def goals(results: Sequence[tuple[Result, float]], found: dict[str, float]) -> list[Goal]:
    """Goals that limit the line buffer's share of its array. `results`: with the area of each array in um2."""
    return [Goal(f"{result.configuration.title}: line buffer at most {100 * GOAL:g} % of the array",
                 f"{found[result.configuration.name] / total:.2%}", found[result.configuration.name] / total <= GOAL)
            for result, total in results]


def section(results: Sequence[tuple[Result, float]], found: dict[str, float]) -> str:
    """Section of area.md. `results`: with the area of each array in um2."""
    rows = []
    for (result, _), goal in zip(results, goals(results, found)):
        _, lines, width = size(result.configuration)
        rows.append(f"| {result.configuration.title} | {lines} | {lines * (width + 1)} | {found[result.configuration.name] / 1e6:.4f} "
                    f"| {goal.value} | {'yes' if goal.met else 'no'} |")
    return "\n".join([
        "## Line buffer of the subsystem", "",
        "`dtof_subsystem` holds BUFFER_LINES lines in front of the array, by default as many as the array's raster needs. "
        f"dtof_line_buffer is mapped alone, without the margins of the arrays' logic; its goal is {GOAL:.0%} of the array. "
        "No total above has the line buffer.", "",
        "| read-out | lines | bits | mm2 | of the array | goal |", "|---|---:|---:|---:|---:|---|", *rows, ""])
