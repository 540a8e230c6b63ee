# SPDX-License-Identifier: Apache-2.0
"""How far the generated library is off: the read-outs again with Nangate 45 nm, OSU 0.18 um and IHP 130 nm, the last
with its own SRAM macros."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from .errors import given
from . import batch, ihp130, technology
from .configuration import Configuration, counted_macros
from .run import Result

AREA_LIMIT = 0.25
SLACK_LIMIT_NS = 0.3
IHP_MHZ = 100.0  # its SRAMs alone take 5 ns from clock to data in the slow corner


@dataclass(frozen=True)
class Other:
    """Another library: its files, and whether its technology is close enough for the limits to apply."""

    title: str
    typical: Path
    slow: Path | None
    comparable: bool


def libraries(pdk: Path) -> list[Other]:
    liberty = pdk / "liberty"
    osu = Path("/usr/share/qflow/tech/osu018/osu018_stdcells.lib")
    return [Other("Nangate 45 nm", liberty / "nangate45_typ.lib.gz", liberty / "nangate45_slow.lib.gz", True),
            Other("OSU 0.18 um", osu, None, False)]


def _logic_mm2(result: Result) -> float:
    return (result.column.area * result.columns + result.shared.area) / 1e6


def _line(ours: Result, other: Result) -> tuple[str, bool, bool]:
    """(table row, whether the area is within its limit, whether the slack is)."""
    ratio = _logic_mm2(ours) / _logic_mm2(other)
    difference = ours.timing["slow"].slack - other.timing["slow"].slack
    return (f"{ours.configuration.title:<16}{other.column.area:>10.0f}{ratio:>9.2f}"
            f"{other.timing['slow'].slack:>+10.3f}{difference:>+9.3f}{other.timing['slow'].fmax_mhz:>8.0f}",
            abs(ratio - 1) <= AREA_LIMIT, abs(difference) <= SLACK_LIMIT_NS)


def _open_process(root: Path, pdk: Path, chosen: list[Configuration], everything: list[Configuration], workers: int,
                  say: Callable[[str], None]) -> None:
    """Compares the read-outs whose memories IHP's compiled macros can hold, entirely in that process: cells, macros, clock."""
    typical, slow = ihp130.cells(pdk)
    if not typical.exists():
        say(f"IHP 130 nm: {typical} is not here, skipped")
        return
    macros = ihp130.read(pdk / "ihp130" / "sram")

    fitting = [item for item in chosen if all(ihp130.choose(size, macros) for _, size in counted_macros(item))]
    folder = root / "build" / "synth" / "ihp130"
    foreign = technology.prepare(root, folder, everything, typical, slow, lambda size: ihp130.macro(size, macros),
                                 IHP_MHZ)
    results = batch.run_all([batch.Job(item) for item in fitting], foreign, folder / "runs", workers, say)
    say(f"\nIHP 130 nm, its cells and SRAM macros, mapped for {IHP_MHZ:g} MHz in the slow corner (1.08 V, 125 C)")
    say(f"{'read-out':<18}{'um2/col':>10}{'logic mm2':>11}{'macros mm2':>12}{'total mm2':>11}{'slack':>9}{'fmax':>7}"
        f"{'fmax typ':>10}  macros")
    for item in fitting:
        result = results[item.name]
        logic = _logic_mm2(result)
        copies = [(number, size, *given(ihp130.choose(size, macros), item.name)) for number, size in counted_macros(item)]
        sram = sum(number * count * macro.area for number, _, count, macro in copies) / 1e6
        used = ", ".join(f"{size.words}x{size.bits}: {count} of {macro.size.words}x{macro.size.bits}"
                         for _, size, count, macro in copies)
        say(f"{item.title:<18}{result.column.area:>10.0f}{logic:>11.2f}{sram:>12.2f}{logic + sram:>11.2f}"
            f"{result.timing['slow'].slack:>+9.3f}{result.timing['slow'].fmax_mhz:>7.0f}"
            f"{result.timing['typical'].fmax_mhz:>10.0f}  {used}")
    without = [item.title for item in chosen if item not in fitting]
    if without:
        say(f"no macro of the PDK has the words that these need: {', '.join(without)}")


def run(root: Path, pdk: Path, named: dict[str, Configuration], everything: list[Configuration], workers: int,
        say: Callable[[str], None]) -> int:
    """Prints the comparison. Rows outside the limits are marked and explained, but are no failure, since other libraries may differ.
    Returns 0 unless a step of the flow fails."""
    chosen = [item for item in named.values() if not item.variant_of]
    build = root / "build" / "synth"
    ours = batch.run_all([batch.Job(item) for item in chosen],
                         technology.prepare(root, build / "generic40", everything), build / "runs", workers, say)
    outside = 0
    for other in libraries(pdk):
        if not other.typical.exists():
            say(f"{other.title}: {other.typical} is not here, skipped")
            continue
        folder = build / other.typical.name.split(".")[0]
        foreign = technology.prepare(root, folder, everything, other.typical, other.slow)
        results = batch.run_all([batch.Job(item) for item in chosen], foreign, folder / "runs", workers, say)
        say(f"\nGenerated library against {other.title} (SRAM macros are the same)")
        say(f"{'read-out':<16}{'um2/col':>10}{'area':>9}{'slack':>10}{'slack':>9}{'fmax':>8}\n"
            f"{'':<16}{'theirs':>10}{'ours/':>9}{'theirs':>10}{'ours -':>9}{'theirs':>8}")
        for item in chosen:
            line, area_within, slack_within = _line(ours[item.name], results[item.name])
            beyond = [figure for figure, within in (("area", area_within), ("slack", slack_within)) if not within]
            flag = f"  {' and '.join(beyond)} outside" if beyond and other.comparable else ""
            outside += bool(flag)
            say(line + flag)
        if not other.comparable:
            say("(another technology: shows that the flow retargets, not held against the limits)")
    _open_process(root, pdk, chosen, everything, workers, say)
    say("The generated library is meant to be slower: FO4 28 ps against Nangate's 25.8 ps, 0.2 ns on a 2.4 ns path.")
    say(f"limits: area within {AREA_LIMIT:.0%}, slack within {SLACK_LIMIT_NS} ns: "
        + (f"{outside} outside" if outside else "all within"))
    if outside:
        say("A slack outside is the flow's choice, not the library's: it takes the first mapping that closes, which may "
            "close with more to spare in one library than in the other.")
    return 0
