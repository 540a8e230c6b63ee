# SPDX-License-Identifier: Apache-2.0
"""The make targets and what they do, from the comments at the head of the makefiles and from studies.toml."""

import re
from dataclasses import dataclass
from pathlib import Path

from figures import reports

MAKEFILES = ("Makefile", "scripts/*.mk", "synth/*.mk")
# `# make NAME[, NAME ...]  what it does`; what follows more deeply indented belongs to it, but for variables.
LINE = re.compile(r"^# make (?P<names>[a-z-]+(?:, (?:make )?[a-z-]+)*)(?P<rest>:? .*)$")
VARIABLE = re.compile(r"^[A-Z_]+=")
PHONY = re.compile(r"^\.PHONY:(.*)$", re.MULTILINE)


@dataclass(frozen=True)
class Command:
    target: str
    says: str
    makefile: str


def makefiles(root: Path) -> list[Path]:
    return [makefile for pattern in MAKEFILES for makefile in sorted(root.glob(pattern))]


def targets_of(text: str) -> set[str]:
    return {name for line in PHONY.findall(text) for name in line.split()}


def targets(root: Path) -> dict[str, str]:
    """Targets of make, described or not, and the makefile of each."""
    return {name: str(makefile.relative_to(root)) for makefile in makefiles(root)
            for name in targets_of(makefile.read_text(encoding="utf-8"))}


def commands(root: Path) -> dict[str, Command]:
    """Described targets by name. The description in a makefile of its own is preferred to the one in the main makefile."""
    found: dict[str, Command] = {}
    studies = {name: [study["does"]] for name, study in reports.studies(root).items()}
    for makefile in makefiles(root):
        text = makefile.read_text(encoding="utf-8")
        says: dict[str, list[str]] = {}
        current: list[str] = []
        for line in text.splitlines():
            match = LINE.match(line)
            if match:
                current = [name.removeprefix("make ") for name in match["names"].split(", ")]
                for name in current:
                    says[name] = [match["rest"].strip(" :")]
            elif not line.startswith("#   ") or VARIABLE.match(line[1:].strip()):
                current = []
            else:
                for name in current:
                    says[name].append(line[1:].strip())
        if twice := says.keys() & studies.keys():
            raise reports.ReportsError(f"{makefile.relative_to(root)}: {reports.STUDIES} says what '{min(twice)}' does: no comment here")
        says |= studies
        for target in targets_of(text) & says.keys():
            found[target] = Command(target, " ".join(says[target]), str(makefile.relative_to(root)))
    return found
