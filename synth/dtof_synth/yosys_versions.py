# SPDX-License-Identifier: Apache-2.0
"""`make synth` with two versions of Yosys: which figures differ, and why.

The second version ran in another checkout of the same inputs, for example in the Debian system of scripts/try_debian.sh.
"""

from __future__ import annotations

import csv
import json
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path

from .configuration import Configuration
from .errors import FlowError

TOLERANCE = 0.02  # of an area; of the clock's period for a slack
EXPLANATIONS = Path("synth") / "yosys_versions.toml"
FIGURES = ("column", "array", "slack")
_VERSION = re.compile(r"\bYosys (\d\S*)")
_COLUMNS = ("configuration", "yosys", "column_um2", "total_mm2", "slack_330_ns")


@dataclass(frozen=True)
class Figures:
    """One configuration by one version of Yosys."""

    column: float  # logic of a column, um2
    array: float  # cells and macros, mm2
    slack: float  # slow corner with margins at 330 MHz, ns


@dataclass(frozen=True)
class Checkout:
    """What `make synth` left in one checkout."""

    yosys: str
    digest: str  # of its inputs
    figures: dict[str, Figures]


@dataclass(frozen=True)
class Difference:
    """A figure that differs by more than the tolerance."""

    configuration: str
    figure: str
    share: float


def _rows(path: Path) -> list[dict[str, str]]:
    try:
        with path.open(newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))
    except OSError as error:
        raise FlowError(f"{path}: cannot read the results of make synth ({error.strerror})") from None


def yosys_version(folder: Path) -> str:
    """The version that mapped the netlists below `folder`/build/synth/runs. FlowError if there are none, or of several versions."""
    found = set()
    for log in sorted(folder.glob("build/synth/runs/*/map.log")):
        match = _VERSION.search(log.read_text(encoding="utf-8"))
        if match:
            found.add(match.group(1))
    if len(found) != 1:
        raise FlowError(f"{folder / 'build/synth/runs'}: " + (f"logs of several versions of Yosys: {', '.join(sorted(found))}" if found
                                                               else "no log of Yosys; make synth writes them"))
    return found.pop()


def read(folder: Path) -> Checkout:
    """The results of `make synth` in the checkout `folder`."""
    digests = folder / "reports" / "digests.json"
    try:
        digest = json.loads(digests.read_text(encoding="utf-8"))["synth"]["digest"]
        slacks = {row["configuration"]: float(row["slack_330_ns"]) for row in _rows(folder / "reports" / "timing.csv")
                  if row["corner"] == "slow with margins"}
        figures = {row["configuration"]: Figures(float(row["column_um2"]), float(row["total_mm2"]), slacks[row["configuration"]])
                   for row in _rows(folder / "reports" / "area.csv")}
    except OSError as error:
        raise FlowError(f"{digests}: cannot read the digests of the reports ({error.strerror})") from None
    except (KeyError, ValueError) as error:
        raise FlowError(f"{folder / 'reports'}: not the results of make synth ({error})") from None
    return Checkout(yosys_version(folder), digest, figures)


def differences(own: Checkout, other: Checkout, period_ns: float) -> list[Difference]:
    """Figures that differ by more than the tolerance. FlowError if the checkouts have other inputs, or not the same configurations."""
    if own.digest != other.digest:
        raise FlowError(f"make synth ran on other inputs in the other checkout: {other.digest[:12]}, here {own.digest[:12]}")
    if own.figures.keys() != other.figures.keys():
        raise FlowError("not the same configurations in both checkouts: "
                        + ", ".join(sorted(own.figures.keys() ^ other.figures.keys())))
    found = []
    for name, here in own.figures.items():
        there = other.figures[name]
        shares = (there.column / here.column - 1, there.array / here.array - 1, (there.slack - here.slack) / period_ns)
        found += [Difference(name, figure, share) for figure, share in zip(FIGURES, shares) if abs(share) > TOLERANCE]
    return found


def explanations(path: Path) -> dict[tuple[str, str], str]:
    """Reasons by configuration and figure."""
    try:
        entries = tomllib.loads(path.read_text(encoding="utf-8")).get("difference", [])
        return {(entry["configuration"], figure): entry["reason"] for entry in entries for figure in entry["figures"]}
    except (OSError, KeyError, tomllib.TOMLDecodeError) as error:
        raise FlowError(f"{path}: cannot read the explanations ({error})") from None


def open_points(found: list[Difference], reasons: dict[tuple[str, str], str]) -> list[str]:
    """A line for each difference without a reason, and for each reason without a difference."""
    seen = {(one.configuration, one.figure) for one in found}
    return ([f"{one.configuration}: {one.figure} differs by {one.share:+.1%} and has no explanation" for one in found
             if (one.configuration, one.figure) not in reasons]
            + [f"{name}: {figure} has an explanation but no difference" for name, figure in reasons if (name, figure) not in seen])


def report(own: Checkout, other: Checkout, named: dict[str, Configuration], found: list[Difference],
           reasons: dict[tuple[str, str], str]) -> str:
    areas = [abs(other.figures[name].array / here.array - 1) for name, here in own.figures.items()]
    missed = {one.yosys: [named[name].title for name, figures in one.figures.items() if figures.slack < 0] for one in (own, other)}
    closing = ["Every configuration closes with margins with both." if not any(missed.values()) else
               " ".join(f"Not closed with margins with Yosys {version}: {', '.join(titles)}." for version, titles in missed.items() if titles)]
    lines = [
        "# Two versions of Yosys", "",
        f"Yosys {own.yosys} and {other.yosys} differ by at most {max(areas):.1%} in the area of an array. {closing[0]}", "",
        f"Written by `make synth-versions`, which compares `make synth` of two checkouts with equal inputs (`{own.digest[:12]}`). The flow uses "
        f"the Yosys that is installed. All other pages show Yosys {own.yosys}. Slack: slow corner with margins, 330 MHz. Figures that "
        f"differ by more than {TOLERANCE:.0%} (slack: of the clock's period) are explained below.", "",
        f"| read-out | column um2, {own.yosys} | {other.yosys} | array mm2, {own.yosys} | {other.yosys} | slack ns, {own.yosys} | {other.yosys} |",
        "|---|---:|---:|---:|---:|---:|---:|"]
    for name, here in own.figures.items():
        there = other.figures[name]
        lines.append(f"| {named[name].title} | {here.column:.0f} | {there.column:.0f} | {here.array:.3f} | {there.array:.3f} | "
                     f"{here.slack:+.3f} | {there.slack:+.3f} |")
    lines += ["", "## Differences above the limit", ""]
    lines += [f"* {named[one.configuration].title}, {one.figure}: {one.share:+.1%}. "
              f"{reasons.get((one.configuration, one.figure), '**No explanation.**')}" for one in found] or ["None."]
    return "\n".join([*lines, ""])


def write_csv(path: Path, own: Checkout, other: Checkout) -> None:
    """A row for each configuration and version."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(_COLUMNS)
        for name in own.figures:
            for checkout in (own, other):
                figures = checkout.figures[name]
                writer.writerow([name, checkout.yosys, figures.column, figures.array, figures.slack])
