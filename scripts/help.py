#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`make help`: the targets in groups, with what each does and how long it takes on two cores; `make study NAME=...`: one study.

`help.py [--all]` prints the groups of scripts/help.toml, with --all every other target, too.
`help.py --study NAME` prints NAME if it is a study, else one line that says which there are, with exit status 2.
"""

import argparse
import re
import sys
import textwrap
import tomllib
from dataclasses import dataclass
from pathlib import Path

from dtof_synth import program
from figures import reports
from page.commands import commands, targets

ROOT = Path(__file__).resolve().parent.parent
LIST = "scripts/help.toml"
WIDTH = 132
_CLAUSE = re.compile(r"[;:(]")


class HelpError(Exception):
    """The list has an error; the message is one line."""


@dataclass(frozen=True)
class Group:
    title: str
    minutes: dict[str, float]  # by target
    is_study: bool


def report_minutes(root: Path) -> dict[str, float]:
    """Minutes that the reports of each make target take, by target."""
    found: dict[str, float] = {}
    for report in reports.load(root).values():
        match = re.fullmatch(r"make ([a-z-]+)", report.command)
        if match:
            found[match[1]] = found.get(match[1], 0.0) + report.minutes
    return found


def load(root: Path) -> list[Group]:
    """The groups of the list; HelpError where a target is unknown, undescribed, listed twice or without minutes."""
    known, described, measured = targets(root), commands(root), report_minutes(root)
    groups, seen = [], set()
    for entry in tomllib.loads((root / LIST).read_text(encoding="utf-8"))["group"]:
        minutes = {}
        is_study = entry.get("studies", False)
        listed = {name: "" if "inputs" in study else study["minutes"] for name, study in reports.studies(root).items()} if is_study \
            else entry["targets"]
        for target, given in listed.items():
            if target not in known:
                raise HelpError(f"{LIST}: no makefile has the target '{target}'")
            if target not in described:
                raise HelpError(f"{known[target]}: no comment says what the target '{target}' does")
            if target in seen:
                raise HelpError(f"{LIST}: '{target}' stands there twice")
            if (given == "") != (target in measured):
                raise HelpError(f"{LIST}: '{target}' needs minutes " + ('"", for its report has them' if given != "" else "here, for no report has them"))
            seen.add(target)
            minutes[target] = measured[target] if given == "" else float(given)
        groups.append(Group(entry["title"], minutes, is_study))
    return groups


def duration(minutes: float) -> str:
    return f"{minutes / 60:.0f} h" if minutes >= 90 else f"{max(1, round(minutes))} min" if minutes >= 0.75 else "seconds"


def line(target: str, says: str, minutes: float | None) -> str:
    """Help line of a target: its name and the first clause of its description."""
    clause = _CLAUSE.split(says, maxsplit=1)[0].strip().rstrip(",")
    time = "" if minutes is None else duration(minutes)
    return f"  {target:<16} {time:>8}  {textwrap.shorten(clause, WIDTH - 28, placeholder=' ...')}"


def text(root: Path, everything: bool) -> str:
    groups, described = load(root), commands(root)
    lines = ["make TARGET [VARIABLE=value]; minutes are those of two cores", ""]
    for group in groups:
        lines += [group.title, *(line(target, described[target].says, minutes) for target, minutes in group.minutes.items()), ""]
    listed = {target for group in groups for target in group.minutes}
    if everything:
        lines += ["All others", *(line(target, one.says, None) for target, one in sorted(described.items()) if target not in listed), ""]
    else:
        lines.append("All others: make help ALL=1. More on each: docs/user/commands.md")
    return "\n".join(lines).rstrip()


def study(root: Path, name: str) -> str:
    """Returns the name if it is a study's; HelpError otherwise."""
    known = [target for group in load(root) if group.is_study for target in group.minutes]
    if name not in known:
        raise HelpError(f"{f'there is no study {name!r}' if name else 'make study needs NAME=...'}; studies are {', '.join(known)}")
    return name


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--all", action="store_true", help="every target that a makefile describes")
    parser.add_argument("--study", metavar="NAME", help="check the name of a study")
    arguments = parser.parse_args()
    try:
        print(study(ROOT, arguments.study) if arguments.study is not None else text(ROOT, arguments.all))
    except HelpError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    program.run(main)
