# SPDX-License-Identifier: Apache-2.0
"""The committed report of dtof_subsystem: subsystem.md and subsystem.csv."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from pathlib import Path

from . import resizing, subsystem_power
from .activity import STREAMING
from .goals import Goal
from .subsystem import CORNERS, MODES, TOP, Subsystem

LINE_BUFFER = "dtof_line_buffer"
MOST_LINE_BUFFER = 0.03  # of the array
OWN = "own cells"  # of dtof_subsystem, outside its modules
TITLES = {TOP: "own registers and ports", "array_stand_in": "the array"}  # of what is no module of the subsystem


def _table(header: Sequence[str], rows: Iterable[Sequence[str]], left: int = 1) -> list[str]:
    return ["| " + " | ".join(header) + " |",
            "|" + "|".join("---" if index < left else "---:" for index in range(len(header))) + "|",
            *("| " + " | ".join(row) + " |" for row in rows), ""]


def goals(found: Iterable[Subsystem]) -> list[Goal]:
    """The line buffer's share of the array, no negative slack, without and with margins, and no edge or load beyond its limit."""
    judged = []
    for one in found:
        title = one.configuration.title
        share = one.part(LINE_BUFFER).counts.area / 1e6 / one.array_mm2
        judged.append(Goal(f"{title}: line buffer at most {100 * MOST_LINE_BUFFER:g} % of the array", f"{share:.2%}",
                           share <= MOST_LINE_BUFFER))
        for mode in MODES:
            worst = one.worst(mode)
            judged.append(Goal(f"{title}: closes {one.target_mhz:g} MHz in all corners" + (" with margins" if mode == "margins" else ""),
                               f"worst slack {worst:+.3f} ns", worst >= 0))
        edges, loads = sum(one.slow_edges.values()), len(one.overloaded)
        judged.append(Goal(f"{title}: no edge and no load beyond its limit", f"{edges} edges, {loads} loads" + (
            f", the first: {one.overloaded[0]}" if loads else ""), edges + loads == 0))
    return judged


def _answer(found: Sequence[Subsystem]) -> str:
    areas, shares = [one.mm2 for one in found], [one.share for one in found]
    late = sorted({name for one in found for name, slack in one.late.items() if slack < 0})
    size = (f"Around an array of {found[0].configuration['SRAM_NUM']} columns, `{TOP}` takes {min(areas):.3f} to {max(areas):.3f} mm2, "
            f"{min(shares):.1%} to {max(shares):.1%} of the array.")
    lines, idle = [one.power.streaming.total for one in found], [one.power.idle for one in found]
    size += (f" Without the array it takes {min(lines):.1f} to {max(lines):.1f} mW while lines stream in, and {min(idle):.1f} to {max(idle):.1f} mW "
             "idle.")
    missed = [one.configuration.title for one in found if one.worst("margins") < 0]
    if not missed:
        return f"{size} It closes {found[0].target_mhz:g} MHz with margins around every array."
    where = f" Setup is missed in {', '.join(TITLES.get(name, f'`{name}`') for name in late)}; every other module meets it." if late else ""
    return f"{size} **It misses {found[0].target_mhz:g} MHz with margins around {', '.join(missed)}.**{where}"


def _area_rows(found: Sequence[Subsystem]) -> list[list[str]]:
    return [[one.configuration.title, f"{one.array_mm2:.3f}", f"{one.mm2:.4f}", f"{one.share:.2%}", f"{one.array_mm2 + one.mm2:.3f}",
             f"{one.counts.cells}", f"{one.counts.flip_flops}", f"{one.counts.buffers}"] for one in found]


def _part_rows(found: Sequence[Subsystem]) -> list[list[str]]:
    """A row per module, with its area around each array."""
    names = sorted({part.name for one in found for part in one.parts},
                   key=lambda name: -max(part.counts.area for one in found for part in one.parts if part.name == name))
    rows = []
    for name in names:
        parts = [next((part for part in one.parts if part.name == name), None) for one in found]
        rows.append([OWN if name == TOP else f"`{name}`", f"{max(part.instances for part in parts if part)}",
                     *(f"{part.counts.area:.0f}" if part else "-" for part in parts)])
    return rows


def _slack_rows(found: Sequence[Subsystem]) -> list[list[str]]:
    rows = []
    for one in found:
        for corner in CORNERS:
            plain, strict = (one.slacks[corner, mode] for mode in MODES)
            rows.append([one.configuration.title, corner, f"{plain.setup:+.3f}", f"{plain.hold:+.3f}", f"{plain.reset:+.3f}",
                         f"{strict.setup:+.3f}", f"{strict.hold:+.3f}", f"{strict.reset:+.3f}", f"`{strict.start}`", f"`{strict.end}`"])
    return rows


def _late_rows(found: Sequence[Subsystem]) -> list[list[str]]:
    names = sorted({name for one in found for name in one.late}, key=lambda name: min(one.late.get(name, 9.0) for one in found))
    return [[TITLES.get(name, f"`{name}`"), *(f"{one.late[name]:+.3f}" if name in one.late else "-" for one in found)] for name in names]


def _power_rows(found: Sequence[Subsystem]) -> list[list[str]]:
    rows = []
    for one in found:
        lines, results = one.power.streaming, one.power.results
        sent = [f"{value:.2f}" for value in (results.logic, results.clock, results.total)] if results else ["-"] * 3
        rows.append([one.configuration.title, *(f"{value:.2f}" for value in (lines.logic, lines.clock, lines.leakage, lines.total)), *sent,
                     f"{one.power.idle:.2f}", f"{one.power.clocks[STREAMING]}", f"{one.power.compared or '-'}"])
    return rows


def _compared(found: Sequence[Subsystem]) -> str:
    """Around which arrays results are compared."""
    def named(compared: bool) -> str:
        return ", ".join(one.configuration.title for one in found if bool(one.power.compared) == compared)

    text = f"Around {named(True)} the first {subsystem_power.MOST_RESULTS} results are simulated, and are those of the model. " if named(True) else ""
    if named(False):
        text += (f"Around {named(False)} **results are not measured**: the simulation ends {subsystem_power.QUIET_CLOCKS} clocks behind the last "
                 "line. Results that come before the end are compared, and there are few or none. Only the first of several passes is simulated, and a "
                 "pool read-out takes all lines in its first phase.")
    return text.rstrip()


def _power_part_rows(found: Sequence[Subsystem]) -> list[list[str]]:
    """A row per module that takes at least 0.005 mW around some array, the largest first."""
    most = {name: max(one.power.modules.get(name, 0.0) for one in found) for one in found for name in one.power.modules}
    return [[OWN if name == TOP else f"`{name}`", *(f"{one.power.modules.get(name, 0.0):.2f}" for one in found)]
            for name in sorted(most, key=lambda name: -most[name]) if most[name] >= 0.005]


def _pessimism(found: Sequence[Subsystem]) -> str:
    """What makes slacks smaller than they could be."""
    text = "Each module is mapped alone, so no logic is optimised across borders of modules."
    hopeless = [one for one in found if not resizing.is_tried(min(one.late.values()))]
    if hopeless:
        text += (f" Resizing gates is not tried where a path misses by more than {resizing.HOPELESS_NS:g} ns; so around "
                 f"{', '.join(one.configuration.title for one in hopeless)} no gate is resized. A smaller miss than that may be one of the "
                 "flow, not of the RTL.")
    return text


def _end_rows(found: Sequence[Subsystem]) -> list[list[str]]:
    return [[one.configuration.title, f"{one.ends.all}", f"{one.ends.timed}", f"{one.ends.constant}", f"{one.ends.side_band}",
             f"{one.ends.to_array}", f"{one.ends.from_array}", f"{one.ends.resets}"] for one in found]


def report(found: Sequence[Subsystem], digest: str) -> str:
    titles = [one.configuration.title for one in found]
    return "\n".join([
        "# Subsystem", "", _answer(found), "",
        f"Written by `make synth-subsystem`: `{TOP}` with its default parameters around each array, library `generic40`, "
        f"{found[0].target_mhz:g} MHz; inputs `{digest[:12]}`. Generated libraries from public figures, not sign-off: "
        "[docs/reference/technology.md](../docs/reference/technology.md).", "",
        "## Area", "",
        "The arrays were synthesised for this page. Their logic is that of [area.md](area.md), which has the area to quote. Where the areas differ, "
        "the names of nets differ, on which the mapping by ABC depends. Subsystem: all cells around the array, with buffers and clock gates, without the "
        "clock tree. By default the subsystem has no raster buffer and no SRAM.", "",
        *_table(["read-out", "array mm2", "subsystem mm2", "of the array", "both mm2", "cells", "flip-flops", "buffers"], _area_rows(found)),
        f"In um2, by module; {OWN}: cells of `{TOP}` outside its modules.", "",
        *_table(["module", "instances", *titles], _part_rows(found)),
        "## Timing", "",
        "Slacks in ns, with the budgets of [dtof_subsystem.sdc](../constraints/subsystem/dtof_subsystem.sdc), without and with the margins of "
        "[margins.sdc](../constraints/margins.sdc). Reset: the lesser of recovery and removal.", "",
        *_table(["read-out", "corner", "setup", "hold", "reset", "with margins: setup", "hold", "reset", "slowest from", "to"],
                _slack_rows(found), 2),
        "Least setup slack in the slow corner with margins, by the module in which paths end:", "",
        *_table(["paths end in", *titles], _late_rows(found)),
        _pessimism(found), "",
        "The clock is ideal, and `dtof_clock_gate` is a cell of the library: the array's clock is `clk_i` behind it, with the same arrival. "
        "Wires have the library's wire load. There is no floorplan of the subsystem, so the wires from the line buffer to 200 columns are "
        "timed shorter than they are.", "",
        "In the timed netlist a cell stands for the array. Its times are those of the array's own netlist: OpenSTA measures in each corner, "
        "without and with margins, how long before the clock's edge each input must be stable, and when each output changes. The edges at "
        "inputs and the loads at outputs are those of margins.sdc. So paths from the subsystem to the array and back are timed.", "",
        "Edges: OpenSTA compares the transition at every pin with the library's max_transition, in three corners. Loads: those of the nets "
        "inside modules, with the wire load, compared with max_capacitance and with a number of inputs; nets between modules are not "
        "compared.", "",
        "## Power", "",
        f"mW of `{TOP}` without the array, typical corner, {found[0].target_mhz:g} MHz. Power of the array: [power.md](power.md). The "
        "netlist of the timing is simulated with the RTL of the array inside, and every transition of every net is counted: "
        f"{subsystem_power.ACQUISITIONS} acquisitions of the scene `{subsystem_power.SCENE}` at {subsystem_power.KLUX:g} klux, a line in every "
        f"clock. {_compared(found)}", "",
        "Lines: the clocks in which the subsystem takes a line. Results: all other clocks, from the reset to the last result that was compared. "
        "Idle: no line, no register access, no clock gate open. Logic: nets and cells. Clock: pins of flip-flops and clock gates, an estimated "
        "tree, and what runs behind clock gates. Not counted: glitches, because the models of the cells have no delay; the wires from the line buffer "
        "to the array; the optional raster buffer, which is not built.", "",
        *_table(["read-out", "lines: logic", "clock", "leakage", "total", "results: logic", "clock", "total", "idle", "clocks with a line",
                 "results compared"], _power_rows(found)),
        "Logic and gated clocks while lines stream in, by module:", "",
        *_table(["module", *titles], _power_part_rows(found)),
        "## Ends of paths", "",
        "Ends: pins with a setup time, the array's included, and output ports. OpenSTA must time every end for setup and hold, except those "
        "on which it finds a constant, and the side band of the SRAMs. Its check_setup must find no register without a clock, no port without "
        "a budget, no other end without a path, and no loop; else the command stops.", "",
        *_table(["read-out", "ends", "timed", "constant", "side band", "at the array", "array's outputs", "resets"], _end_rows(found)),
        "## Goals", "",
        *_table(["goal", "here", "met"], [[goal.text, goal.value, "yes" if goal.met else "**no**"] for goal in goals(found)])])


def write_csv(path: Path, found: Iterable[Subsystem]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["configuration", "array_mm2", "subsystem_mm2", "share", "line_buffer_mm2", "cells", "flip_flops", "ends", "timed_ends",
                         "resets", "lines_mw", "results_mw", "idle_mw", "results_compared",
                         *(f"{corner}_{mode}_{kind}_ns" for corner in CORNERS for mode in MODES for kind in ("setup", "hold", "reset"))])
        for one in found:
            writer.writerow([one.configuration.name, f"{one.array_mm2:.4f}", f"{one.mm2:.5f}", f"{one.share:.4f}",
                             f"{one.part(LINE_BUFFER).counts.area / 1e6:.5f}", one.counts.cells, one.counts.flip_flops, one.ends.all,
                             one.ends.timed, one.ends.resets, f"{one.power.streaming.total:.3f}",
                             f"{one.power.results.total:.3f}" if one.power.results else "", f"{one.power.idle:.3f}", one.power.compared,
                             *(f"{value:.4f}" for corner in CORNERS for mode in MODES
                               for value in (one.slacks[corner, mode].setup, one.slacks[corner, mode].hold, one.slacks[corner, mode].reset))])
