# SPDX-License-Identifier: Apache-2.0
"""reports/layout.md and layout.csv: what was placed and routed, and how far the flow's wire-load model is from it."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

from .. import resizing
from ..run import OtherWires
from ..standard_cells import WIRE_UM_PER_FANOUT
from .flow import Result
from .tools import STEPS
from .wires import NODE_NM, REFERENCE_NM, scaled_um

COLUMNS = ["title", "block", "columns", "cells", "flip_flops", "cell_um2", "die_width_um", "die_height_um", "density",
           "sinks", "wire_um", "wire_um_per_sink", "inner_wire_um_per_sink", "wire_um_per_sink_40nm",
           "wire_um_per_sink_by_area", "model_um_per_sink", "clock_wire_um", "wire_ff_per_um", "drc_errors",
           "lvs", "lone_vias_mended", "placement_seed", "bare_ns", "model_ns", "routed_ns", "bare_mean_ns", "model_mean_ns",
           "routed_mean_ns", "slack_40nm_model_ns", "margin_40nm_model_ns", "slack_40nm_measured_ns", "margin_40nm_measured_ns",
           "margin_40nm_resized_ns", "added_40nm_mm2", *(f"{step}_s" for step in STEPS)]


@dataclass(frozen=True)
class Slacks:
    """Setup slacks of the array at 40 nm in the slow corner, ns, without and with margins, for two wire lengths per sink: the wire-load
    model's, and the layout's, scaled by cell area."""

    model: float
    model_with_margins: float
    measured: OtherWires


def at_node(um: float) -> float:
    return um * REFERENCE_NM / NODE_NM


def _row(result: Result, slacks: Slacks) -> list[str | int]:
    per_sink = result.wire_per_sink
    return [result.title, result.block, result.columns, result.cells, result.flip_flops, f"{result.cell_area:.0f}",
            f"{result.die_width:.1f}", f"{result.die_height:.1f}", f"{result.density:.3f}", result.sinks,
            f"{result.wire:.0f}", f"{per_sink:.2f}", f"{result.inner_per_sink:.2f}", f"{at_node(per_sink):.2f}",
            f"{per_sink * result.area_shrink:.2f}", f"{WIRE_UM_PER_FANOUT:.2f}", f"{result.clock_wire:.0f}",
            f"{result.wire_ff / result.wire:.3f}", result.rule_errors, result.comparison,
            result.lone_vias, result.seed,
            *(f"{time:.3f}" for time in (result.bare.longest, result.model.longest, result.routed.longest,
                                         result.bare.mean, result.model.mean, result.routed.mean)),
            *(f"{slack:+.3f}" for slack in (slacks.model, slacks.model_with_margins, slacks.measured.slack,
                                            slacks.measured.with_margins, slacks.measured.resized)),
            f"{slacks.measured.added_mm2:.4f}",
            *(f"{result.seconds.get(step, 0):.0f}" for step in STEPS)]


def _resized(wires: OtherWires) -> list[str]:
    """Slack with margins after resizing, and the area that resizing adds; "-" where resizing is not tried."""
    return [f"{wires.resized:+.3f}", f"{wires.added_mm2:.4f}"] if resizing.is_tried(wires.with_margins) else ["-", "-"]


def write_csv(path: Path, results: list[Result], slacks: list[Slacks]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(_row(result, slack) for result, slack in zip(results, slacks))


def _table(header: list[str], rows: list[list[str]]) -> str:
    lines = [f"| {' | '.join(header)} |", f"|---{'|---:' * (len(header) - 1)}|"]
    return "\n".join([*lines, *(f"| {' | '.join(row)} |" for row in rows)])


def _name(result: Result) -> str:
    return result.title if result.columns == 1 else f"{result.title}, {result.columns} columns"


def _more(value: float, base: float) -> str:
    return f"{100 * (value / base - 1):+.1f} %"


def text(results: list[Result], slacks: list[Slacks], picture: str, command: str) -> str:
    blocks = _table(["block", "cells", "flip-flops", "cell area, um2", "die, um", "density"],
                    [[_name(one), f"{one.cells:,}", str(one.flip_flops), f"{one.cell_area:,.0f}",
                      f"{one.die_width:.0f} x {one.die_height:.0f}", f"{one.density:.1%}"] for one in results])
    checks = _table(["block", "design rule errors (Magic)", "layout against netlist (Netgen)",
                     "lone vias mended", "placement's seed"],
                    [[_name(one), str(one.rule_errors), one.comparison, str(one.lone_vias),
                      str(one.seed)] for one in results])
    wires = _table(["block", "sinks", "um a sink", "of nets inside", "at 40 nm", "at 40 nm by cell area", "model",
                    "clock's wire, um"],
                   [[_name(one), f"{one.sinks:,}", f"{one.wire_per_sink:.1f}", f"{one.inner_per_sink:.1f}",
                     f"{at_node(one.wire_per_sink):.2f}", f"{one.wire_per_sink * one.area_shrink:.2f}",
                     f"{WIRE_UM_PER_FANOUT:.2f}", f"{one.clock_wire:,.0f}"] for one in results])
    times = _table(["block", "no wires", "wire-load model", "routed", "routed against model", "mean of all ends, model",
                    "routed", "routed against model"],
                   [[_name(one), f"{one.bare.longest:.2f}", f"{one.model.longest:.2f}", f"{one.routed.longest:.2f}",
                     _more(one.routed.longest, one.model.longest), f"{one.model.mean:.2f}", f"{one.routed.mean:.2f}",
                     _more(one.routed.mean, one.model.mean)] for one in results])
    arrays = _table(["array", "um per sink, model", "slack", "with margins", "um per sink, layout", "slack", "with margins", "resized",
                     "adds, mm2"],
                    [[one.title, f"{WIRE_UM_PER_FANOUT:.2f}", f"{slack.model:+.3f}", f"{slack.model_with_margins:+.3f}",
                      f"{one.wire_per_sink * one.area_shrink:.2f}", f"{slack.measured.slack:+.3f}",
                      f"{slack.measured.with_margins:+.3f}", *_resized(slack.measured)] for one, slack in zip(results, slacks)])
    seconds = _table(["block", *STEPS, "sum"],
                     [[_name(one), *(f"{one.seconds.get(step, 0):.0f}" for step in STEPS),
                       f"{sum(one.seconds.values()):.0f}"] for one in results])
    return "\n".join([
        "# Layout", "",
        f"Written by `{command}`: columns placed and routed in OSU 0.18 um with Debian's qflow (graywolf, qrouter), checked by "
        "Magic and Netgen. The SRAM is outside; its pins are on the lower edge. How, and what it does not show: "
        "[docs/reference/layout.md](../docs/reference/layout.md).", "",
        f"![Columns as placed and routed, to one scale]({picture})", "", blocks, "", checks, "",
        "## Wires", "",
        f"A sink is a cell's input or an output of the block; the clock is apart. The flow's wire-load model has "
        f"{WIRE_UM_PER_FANOUT:g} um a sink at {REFERENCE_NM} nm. The layout's lengths are scaled twice: by the names of the nodes "
        f"({REFERENCE_NM}/{NODE_NM}), and by the root of the areas of the same column's cells in the generated library "
        "(reports/area.csv) and here, whose cells are large for their node.", "", wires, "",
        "## Timing", "",
        f"Longest path in ns from register or port to register or port, the library's one corner, clock ideal, setup included. "
        f"The same netlist without wires, with the model ({scaled_um():g} um a sink here) and with the routed wires (resistance "
        "and capacitance of every net); both with the same capacitance of a micrometre.", "", times, "",
        "## What such wires would cost the arrays", "",
        "The netlists of [timing.md](timing.md), 330 MHz, slow corner, once with the wire-load model that they were mapped for and "
        "once with the layout's length per sink, scaled by cell area, inside columns, engines and control. Setup slack in ns: with "
        "the gates as they are, and with margins once they are resized for these wires, which makes the array larger. "
        f"-: a path misses by more than {resizing.HOPELESS_NS:g} ns, so resizing is not tried.", "", arrays, "",
        "## Seconds", "", "Of one processor, so that other work on the machine does not count.", "", seconds, ""])
