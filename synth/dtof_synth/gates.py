# SPDX-License-Identifier: Apache-2.0
"""Checks of `make synth STRICT=1`: every goal is met and no slack is negative, unless synth/exceptions.toml says why not."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import date
from pathlib import Path

from .errors import FlowError
from .goals import Goal
from .run import Result

FILE = "synth/exceptions.toml"


@dataclass(frozen=True)
class Exemption:
    """A check that may fail. `what`: text of the check."""

    what: str
    reason: str
    date: date


def read(path: Path) -> list[Exemption]:
    """Exceptions in the file. FlowError for an entry that lacks one of its three values or occurs twice."""
    try:
        entries = tomllib.loads(path.read_text(encoding="utf-8")).get("exception", [])
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise FlowError(f"{path}: {error}") from None
    found: list[Exemption] = []
    for number, entry in enumerate(entries, 1):
        if entry.keys() != {"what", "reason", "date"} or not entry["what"] or not entry["reason"] \
                or type(entry["date"]) is not date:
            raise FlowError(f"{path}: exception {number}: needs a text 'what', a text 'reason' and a day 'date', nothing else")
        if any(one.what == entry["what"] for one in found):
            raise FlowError(f"{path}: exception {number}: '{entry['what']}' stands there twice")
        found.append(Exemption(**entry))
    return found


def slacks(results: dict[str, Result]) -> list[Goal]:
    """A check for each slack of the reports that is not part of a goal (none may be negative), and one for the edges of each corner."""
    checks: list[Goal] = []
    for name, result in results.items():
        for corner, timing in result.timing.items():
            if corner != "slow" or result.configuration.variant_of:  # else it is a goal
                checks.append(_slack(f"{name}: setup, {corner} corner", timing.slack))
            checks.append(_slack(f"{name}: hold, {corner} corner", timing.hold_slack))
            checks.append(Goal(f"{name}: edges, {corner} corner", f"{timing.slow_edges} pins beyond max_transition",
                               timing.slow_edges == 0))
        for corner, margin in result.margins.items():
            for kind, slack in (("setup", margin.slack), ("hold", margin.hold_slack), ("reset", margin.reset_slack)):
                checks.append(_slack(f"{name}: {kind} with margins, {corner} corner", slack))
    return checks


def _slack(text: str, slack: float) -> Goal:
    return Goal(text, f"slack {slack:+.3f} ns", slack >= 0)


_MEASURED = re.compile(r"\| (?P<text>.+?) \| *(?P<value>[\d.]+) \+-(?P<half>[\d.]+) \| *(?P<limit>[\d.]+) \| *\S+ \|")


def measured(report: Path) -> list[Goal]:
    """Goals in the table of reports/pool.md. A goal is met only if its whole 95 % interval is below the limit."""
    try:
        section = report.read_text(encoding="utf-8").split("## Goals\n", 1)[1].split("\n## ", 1)[0]
    except (OSError, IndexError):
        raise FlowError(f"{report}: no section 'Goals'") from None
    rows = [line for line in section.splitlines() if line.startswith("|")][2:]
    found = []
    for row in rows:
        parts = _MEASURED.fullmatch(row.strip())
        if parts is None:
            raise FlowError(f"{report}: cannot read the goal '{row}'")
        value, half, limit = (float(parts[name]) for name in ("value", "half", "limit"))
        met = round(value + half, 6) < limit
        found.append(Goal(parts["text"], f"{parts['value']} +-{parts['half']}, limit {parts['limit']}", met,
                          is_open=not met and round(value - half, 6) <= limit))
    if not found:
        raise FlowError(f"{report}: no goal in the section 'Goals'")
    return found


def judge(checks: Iterable[Goal], exemptions: Iterable[Exemption], everything: bool) -> tuple[list[str], bool]:
    """(line, whether it is an error) for each check that fails, or that no longer needs its exception. `everything`: all checks are
    present, so an exception for a missing check is an error, too."""
    allowed = {one.what: one for one in exemptions}
    lines, failed = [], False
    known: set[str] = set()
    for check in checks:
        known.add(check.text)
        exemption = allowed.get(check.text)
        if check.met:
            if exemption:
                failed = True
                lines.append(f"exception no longer needed: {check.text}: {check.value}")
            continue
        failed |= exemption is None
        lines.append(f"{'goal open' if check.is_open else 'missed'}: {check.text}: {check.value}"
                     + (f" (excepted {exemption.date}: {exemption.reason})" if exemption else ""))
    if everything:
        unknown = [what for what in allowed if what not in known]
        failed |= bool(unknown)
        lines += [f"exception for a check that does not exist: {what}" for what in unknown]
    return lines, failed
