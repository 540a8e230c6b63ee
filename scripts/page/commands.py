# SPDX-License-Identifier: Apache-2.0
"""The make targets and what they do, from the comments at the head of the makefiles."""

import re
from dataclasses import dataclass
from pathlib import Path

MAKEFILES = ("Makefile", "scripts/*.mk", "synth/*.mk")
# `# make NAME[, NAME ...]  what it does`; what follows more deeply indented belongs to it, but for variables.
LINE = re.compile(r"^# make (?P<names>[a-z-]+(?:, (?:make )?[a-z-]+)*)(?P<rest>:? .*)$")
VARIABLE = re.compile(r"^[A-Z_]+=")


@dataclass(frozen=True)
class Command:
    target: str
    says: str
    makefile: str


def commands(root: Path) -> dict[str, Command]:
    """By target, those that a comment describes. A makefile of its own says more than the first one's list."""
    found: dict[str, Command] = {}
    for pattern in MAKEFILES:
        for makefile in sorted(root.glob(pattern)):
            text = makefile.read_text(encoding="utf-8")
            targets = {name for line in re.findall(r"^\.PHONY:(.*)$", text, re.MULTILINE) for name in line.split()}
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
            for target in targets & says.keys():
                found[target] = Command(target, " ".join(says[target]), str(makefile.relative_to(root)))
    return found
