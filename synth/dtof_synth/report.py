# SPDX-License-Identifier: Apache-2.0
"""The committed reports: area.md/.csv, timing.md/.csv, and the goals."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from pathlib import Path

from .errors import given
from . import area_parts, floorplan, gates, goals, loads, sram_model, wide_words
from .configuration import memories
from .run import Result
from .technology import TARGET_MHZ
from .timing import FAST_MHZ

# Why our area differs from the thesis's Table 5, a sentence each.
WHY = {
    "ezpointer": "The confidence adds 4 bits to the thesis's 10-bit word; without it the array is "
                 "ezPointer, no confidence, below.",
    "sifh": "The physical model's two-port array is denser at this size than the thesis's compiled macro.",
    "fifh": "The thesis's SiFH and FiFH differ by 4.00 mm2 over 51,200 bits a column in 200 columns: 0.39 um2 "
            "a bit, less than a two-port bitcell (0.472 um2). No physical model meets both; ours meets SiFH.",
    "hispointer": "As FiFH, whose histogram it shares; the pointer SRAM comes on top.",
}


def _table(header: list[str], rows: Iterable[list[str]], left: int = 1) -> str:
    lines = ["| " + " | ".join(header) + " |",
             "|" + "|".join("---" if index < left else "---:" for index in range(len(header))) + "|"]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def _provenance(library: str, digest: str) -> str:
    return (f"Written by `make synth`: library `{library}`, SRAM model `sram40`, {TARGET_MHZ:g} MHz, thesis's array "
            f"unless a row says otherwise; inputs `{digest[:12]}` (hash of RTL, constraints, scripts, "
            "libraries). Generated libraries from public figures, not sign-off: "
            "[docs/reference/technology.md](../docs/reference/technology.md); method: "
            "[docs/reference/synthesis.md](../docs/reference/synthesis.md).\n")


def _sram_text(result: Result) -> str:
    parts = []
    for use, size in memories(result.configuration).items():
        macro = sram_model.macro(size)
        parts.append(f"{use} {size.words}x{size.bits} {'1RW' if size.ports == 1 else '1R1W'} "
                     f"(mux {macro.mux}) {macro.area:.0f}")
    return "<br>".join(parts)


def _area_rows(results: Iterable[Result]) -> list[list[str]]:
    return [[result.configuration.title, f"{result.column.cells}", f"{result.column.flip_flops}",
             f"{result.kge(result.column.area):.2f}", f"{result.column.area:.0f}",
             f"{result.shared.area:.0f}", _sram_text(result), f"{result.bits_per_pixel:.0f}",
             f"{result.total_mm2:.3f}"] for result in results]


AREA_HEADER = ["read-out", "cells", "flip-flops", "kGE", "logic um2", "shared um2", "SRAM, um2", "bits a pixel",
               "total mm2"]


def _split(results: dict[str, Result]) -> tuple[list[Result], list[Result]]:
    main = [result for result in results.values() if not result.configuration.variant_of]
    return main, [result for result in results.values() if result.configuration.variant_of]


def _thesis_section(results: list[Result]) -> str:
    rows = []
    for result in results:
        thesis = result.configuration.thesis_mm2
        if thesis:
            rows.append([result.configuration.title, f"{thesis:.2f}", f"{result.total_mm2:.2f}",
                         f"{result.total_mm2 / thesis - 1:+.0%}", WHY[result.configuration.name]])
    return _table(["read-out", "thesis mm2", "here mm2", "deviation", "why"], rows)


def _variant_rows(variants: list[Result], results: dict[str, Result]) -> list[list[str]]:
    rows = []
    for result in variants:
        base = results[result.configuration.variant_of]
        rows.append([result.configuration.title, f"{result.column.area:.0f}",
                     f"{result.column.area - base.column.area:+.0f}", f"{result.sram_area:.0f}",
                     f"{result.sram_area - base.sram_area:+.0f}", f"{result.bits_per_pixel:.0f}",
                     f"{result.total_mm2:.3f}", f"{result.total_mm2 / base.total_mm2 - 1:+.1%}",
                     f"{result.timing['slow'].fmax_mhz:.0f}", result.configuration.note])
    return rows


def _mm2(um2: float) -> str:
    return f"{um2 / 1e6:.3f}"


def _parts_section(results: list[Result]) -> str:
    rows = []
    for result in results:
        parts = area_parts.parts(result)
        rows.append([result.configuration.title,
                     *map(_mm2, (parts.column_logic, parts.column_sram, parts.engines, parts.scratch_sram,
                                 parts.control, parts.fan_out, parts.total))])
    return _table(["read-out, mm2", "column logic", "column SRAM", "engines", "scratch SRAM", "control", "fan-out",
                   "total"], rows)


def _placed_section(results: list[Result]) -> str:
    rows = [[result.configuration.title, _mm2(area_parts.parts(result).total), _mm2(area_parts.placed(result)),
             f"{area_parts.flip_flops(result)}", _mm2(area_parts.scan(result)), _mm2(result.clock_tree.area),
             _mm2(area_parts.placed_with_all(result))] for result in results]
    return _table(["read-out, mm2", "cells and macros", "placed", "flip-flops", "scan", "clock tree",
                   "placed with both"], rows)


def _doubtful_section(results: list[Result]) -> str:
    """Section on macros whose organisation or width the public points do not cover, with the arrays' areas without them."""
    sizes = area_parts.doubtful_macros(results)
    if not sizes:
        return "No macro lacks a column multiplexer or is wider than the fitted points.\n"
    rows = []
    for size in sizes:
        macro, other = sram_model.macro(size), sram_model.macro(size, area_parts.OTHER_MUX)
        rows.append([size.name, f"{macro.mux}", f"{macro.area:.0f}", f"{other.area:.0f}",
                     "yes" if size.bits > wide_words.FITTED_BITS else "no", f"{macro.read_energy:.2f}"])
    arrays = [f"{result.configuration.title} {area_parts.total_with_other_mux(result) / 1e6:.3f} instead of "
              f"{result.total_mm2:.3f} mm2" for result in results if area_parts.lacks_mux(result)]
    ending = f"With a multiplexer of {area_parts.OTHER_MUX}: {'; '.join(arrays)}.\n" if arrays else ""
    return (_table(["macro", "mux", "um2", f"um2 with mux {area_parts.OTHER_MUX}",
                    f"over {wide_words.FITTED_BITS} bits", "read pJ"], rows) + "\n" + ending)


def area(results: dict[str, Result], extra: str, library: str, digest: str) -> str:
    main, variants = _split(results)
    notes = [f"* {result.configuration.title}: {result.configuration.note}." for result in main
             if result.configuration.note]
    return "\n".join([
        "# Area", "", _provenance(library, digest),
        "Cells, flip-flops, kGE and logic um2 are of one column (kGE: NAND2 of the library). Shared logic is in the "
        "array once, engines and fan-out trees to the columns included. An SRAM of a pool read-out serves four columns. "
        "Total: cells and macros, as below.", "",
        _table(AREA_HEADER, _area_rows(main)), *notes, "",
        "## What the area is made of", "",
        "Of the whole array. Engines, their scratch SRAMs and control are shared by the columns; fan-out is the trees "
        "of buffers that carry shared signals.", "", _parts_section(main),
        "## Placed", "",
        f"Cells at a utilisation of {area_parts.UTILISATION:.0%} and macros with a halo of {area_parts.HALO_UM:g} um. "
        "Scan is a multiplexer in front of every flip-flop, the clock tree the estimate below; both are cells that the "
        "total does not have.", "", _placed_section(main),
        "## Macros beyond the public points", "",
        "Compilers often offer no array without a column multiplexer (mux 1), and the energies of words wider than "
        f"{wide_words.FITTED_BITS} bits are extrapolated from narrower ones.", "", _doubtful_section(main),
        "## Beside the thesis (Table 5)", "", _thesis_section(main),
        "## Shared logic and fan-out", "",
        "Buffers, repeaters and register copies that carry the shared signals to all columns are counted in the shared logic. "
        "The clock tree is an estimate from the clock loads and not in any total.", "",
        _table(["read-out", "cells", "flip-flops", "um2", "of it fan-out buffers", "um2", "clock tree buffers",
                "um2"],
               [[result.configuration.title, f"{result.shared.cells}", f"{result.shared.flip_flops}",
                 f"{result.shared.area:.0f}", f"{result.shared.buffers}", f"{result.shared.buffer_area:.0f}",
                 f"{result.clock_tree.buffers}", f"{result.clock_tree.area:.0f}"] for result in main]),
        "## Variants", "", "Changes are against the read-out that the variant belongs to.", "",
        _table(["variant", "logic um2", "change", "SRAM um2", "change", "bits a pixel", "total mm2", "change",
                "fmax slow", "note"], _variant_rows(variants, results)),
        extra])


def _timing_rows(results: Iterable[Result]) -> list[list[str]]:
    rows = []
    for result in results:
        for corner in ("typical", "slow"):
            timing = result.timing[corner]
            rows.append([result.configuration.title, corner, f"{timing.slack:+.3f}", f"{timing.fast_slack:+.3f}",
                         f"{timing.hold_slack:+.3f}", f"{timing.fmax_mhz:.0f}", f"`{timing.start}`",
                         f"`{timing.end}`", f"{timing.stages}"])
    return rows


def _margin_rows(results: Iterable[Result]) -> list[list[str]]:
    rows = []
    for result in results:
        slow, fast = result.margins["slow"], result.margins["fast"]
        met = ["yes" if worst >= 0 else "**no**" for worst in (
            min(slow.slack, fast.slack), min(slow.hold_slack, fast.hold_slack), min(slow.reset_slack, fast.reset_slack))]
        rows.append([result.configuration.title, f"{slow.slack:+.3f}", f"{slow.hold_slack:+.3f}", f"{slow.reset_slack:+.2f}",
                     f"{fast.slack:+.3f}", f"{fast.hold_slack:+.3f}", f"{fast.reset_slack:+.2f}", *met,
                     f"`{slow.start}`", f"`{slow.end}`"])
    return rows


def _margin_section(results: list[Result]) -> list[str]:
    results = [result for result in results if result.margins]
    if not results:
        return []
    return ["## With margins", "",
            "The same netlists with the margins of [constraints/margins.sdc](../constraints/margins.sdc): cells 5 % slower or "
            "faster where that hurts, 0.15 ns of uncertainty, edges at the inputs and loads at the outputs; slow corner, and "
            "the fast one for hold. Reset: the lesser of recovery and removal behind dtof_reset_synchroniser. Met: no slack is "
            "negative. Buffers that hold needs are in the netlist and in every total.", "",
            _table(["read-out", "slow: setup", "hold", "reset", "fast: setup", "hold", "reset", "setup met", "hold met",
                    "reset met", "slowest from", "to"], _margin_rows(results))]


def _ends_section(results: list[Result]) -> list[str]:
    rows = [[result.configuration.title, f"{result.ends.all}", f"{result.ends.timed}", f"{result.ends.constant}",
             f"{result.ends.side_band}", f"{result.timing['slow'].slow_edges}",
             f"{result.fullest_load.ff / result.fullest_load.limit_ff:.0%}", f"`{result.fullest_load.driver}`"]
            for result in results if result.ends and result.fullest_load]
    if not rows:
        return []
    return ["## Ends of paths, edges and loads", "",
            "Ends: pins with a setup time and output ports of the netlist that is timed. It has three real columns (the first, the "
            "second and the last) and of every other column the logic at its borders, so that each path between columns and to engines "
            "and control is timed where it is, and those inside a column in the real ones. OpenSTA's check_setup stops the flow for "
            "an end without a path, a register without a clock, a port without a budget and a loop. Not timed: ends that hang on a "
            "constant, and the SRAMs' side band, which rests. Slow edges: pins beyond a limit of 15 % of the period, slow corner. Fullest: "
            "the driver that is nearest to its max_capacitance; one beyond it, or with more than "
            f"{loads.MAX_FANOUT} inputs behind it, stops the flow.", "",
            _table(["read-out", "ends", "timed", "constant", "side band", "slow edges", "fullest", "driver"], rows)]


def timing(results: dict[str, Result], library: str, digest: str) -> str:
    main, variants = _split(results)
    header = ["read-out", "corner", f"slack at {TARGET_MHZ:g} MHz", f"at {FAST_MHZ:g} MHz", "hold slack",
              "fmax MHz", "start", "end", "stages"]
    return "\n".join([
        "# Timing", "", _provenance(library, digest),
        "Slacks in ns, ideal clock with the uncertainty and port budgets of "
        "[constraints/dtof.sdc](../constraints/dtof.sdc). fmax: the shortest period without a setup violation, port "
        "budgets scaled with it. Stages: cells between start and end. Wires inside a block are a wire load; those between "
        f"blocks are those of a floorplan with columns of {floorplan.PITCH_UM:g} um, with {floorplan.TYPICAL.ohm_per_um:g} ohm and "
        f"{floorplan.TYPICAL.ff_per_um:g} fF per um, in the slow corner {floorplan.PESSIMISTIC.ohm_per_um:g} ohm and "
        f"{floorplan.PESSIMISTIC.ff_per_um:g} fF.", "",
        _table(header, _timing_rows(main)),
        *_margin_section(main),
        *_ends_section([*main, *variants]),
        "Power from the activity of the netlists is in [power.md](power.md).", "",
        "## Variants", "", _table(header, _timing_rows(variants))])


def goals_section(found: list[goals.Goal], exemptions: list[gates.Exemption]) -> str:
    reasons = {one.what: one for one in exemptions}
    rows = [[goal.text, goal.value, "yes" if goal.met else "**no**"] for goal in found]
    lines = [f"* {goal.text}: {goal.value}." + (f" {reasons[goal.text].reason} ({reasons[goal.text].date})"
                                                if goal.text in reasons else "") for goal in found if not goal.met]
    return "\n".join(["## Goals", "", _table(["goal", "here", "met"], rows), *(["Missed:", "", *lines, ""] if lines else [])])


def write_area_csv(path: Path, results: dict[str, Result]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["configuration", "readout", "variant_of", "column_cells", "column_flip_flops",
                         "column_kge", "column_um2", "shared_cells", "shared_flip_flops", "shared_um2",
                         "fanout_buffers", "fanout_um2", "clock_tree_um2_estimate", "sram", "sram_column_um2",
                         "bits_per_pixel", "columns", "total_mm2", "thesis_mm2", "deviation"])
        for name, result in results.items():
            configuration = result.configuration
            sizes = " ".join(size.name for size in memories(configuration).values())
            thesis = configuration.thesis_mm2
            writer.writerow([name, configuration.readout, configuration.variant_of, result.column.cells,
                             result.column.flip_flops, f"{result.kge(result.column.area):.3f}",
                             f"{result.column.area:.1f}", result.shared.cells, result.shared.flip_flops,
                             f"{result.shared.area:.1f}", result.shared.buffers,
                             f"{result.shared.buffer_area:.1f}", f"{result.clock_tree.area:.1f}", sizes,
                             f"{result.sram_area:.1f}", f"{result.bits_per_pixel:g}", result.columns,
                             f"{result.total_mm2:.4f}", thesis or "",
                             f"{result.total_mm2 / thesis - 1:.3f}" if thesis else ""])


def write_timing_csv(path: Path, results: dict[str, Result]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["configuration", "corner", "slack_330_ns", "slack_500_ns", "hold_slack_ns", "fmax_mhz",
                         "start", "end", "stages", "logic_mw", "sram_mw", "clock_mw"])
        for name, result in results.items():
            for corner, timing_ in result.timing.items():
                figures = result.power if corner == "typical" else None
                split = [f"{value:.2f}" for value in (figures.logic, figures.sram, figures.clock)] \
                    if figures else ["", "", ""]
                writer.writerow([name, corner, f"{timing_.slack:.4f}", f"{timing_.fast_slack:.4f}",
                                 f"{timing_.hold_slack:.4f}", f"{timing_.fmax_mhz:.1f}", timing_.start,
                                 timing_.end, timing_.stages, *split])
            for corner, margin in result.margins.items():
                writer.writerow([name, f"{corner} with margins", f"{margin.slack:.4f}", "", f"{margin.hold_slack:.4f}", "",
                                 margin.start, margin.end, "", "", "", ""])


def summary(results: dict[str, Result]) -> str:
    """Table that the command prints."""
    lines = [f"{'configuration':<26}{'logic':>8}{'shared':>8}{'SRAM':>8}{'total':>9}{'thesis':>8}"
             f"{'slack':>8}{'fmax':>6}{'fmax':>6}{'assumed':>8}",
             f"{'':<26}{'um2/col':>8}{'um2':>8}{'um2/col':>8}{'mm2':>9}{'mm2':>8}"
             f"{'slow':>8}{'slow':>6}{'typ':>6}{'mW':>8}"]
    for name, result in results.items():
        slow, typical = result.timing["slow"], result.timing["typical"]
        thesis = f"{result.configuration.thesis_mm2:.2f}" if result.configuration.thesis_mm2 else ""
        lines.append(f"{name:<26}{result.column.area:>8.0f}{result.shared.area:>8.0f}{result.sram_area:>8.0f}"
                     f"{result.total_mm2:>9.3f}{thesis:>8}{slow.slack:>+8.3f}{slow.fmax_mhz:>6.0f}"
                     f"{typical.fmax_mhz:>6.0f}{given(result.power, name).total:>8.1f}")
    return "\n".join(lines)
