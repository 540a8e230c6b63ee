# SPDX-License-Identifier: Apache-2.0
"""How far the generated library is off: the read-outs again with Nangate 45 nm and OSU 0.18 um."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from . import batch, technology
from .configuration import Configuration
from .run import Result

AREA_LIMIT = 0.25
SLACK_LIMIT_NS = 0.3


@dataclass(frozen=True)
class Other:
    """Another library: files, whether it is near enough in technology to be held against the limits."""

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


def _line(ours: Result, other: Result) -> tuple[str, bool]:
    """(one row, whether it is within the limits)."""
    ratio = _logic_mm2(ours) / _logic_mm2(other)
    difference = ours.timing["slow"].slack - other.timing["slow"].slack
    within = abs(ratio - 1) <= AREA_LIMIT and abs(difference) <= SLACK_LIMIT_NS
    return (f"{ours.configuration.title:<16}{other.column.area:>10.0f}{ratio:>9.2f}"
            f"{other.timing['slow'].slack:>+10.3f}{difference:>+9.3f}{other.timing['slow'].fmax_mhz:>8.0f}", within)


def run(root: Path, pdk: Path, named: dict[str, Configuration], everything: list[Configuration], workers: int,
        say: Callable[[str], None]) -> int:
    """Prints the comparison; 1 if a comparable library is outside the limits."""
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
            line, within = _line(ours[item.name], results[item.name])
            flag = "" if within or not other.comparable else "  outside"
            outside += bool(flag)
            say(line + flag)
        if not other.comparable:
            say("(another technology: shows that the flow retargets, not held against the limits)")
    say("The generated library is meant to be slower: FO4 28 ps against Nangate's 25.8 ps, 0.2 ns on a 2.4 ns path.")
    say(f"limits: area within {AREA_LIMIT:.0%}, slack within {SLACK_LIMIT_NS} ns: "
        + (f"{outside} outside" if outside else "all within"))
    return 1 if outside else 0
