# SPDX-License-Identifier: Apache-2.0
"""Writes the verdicts on the mutants: a page for people, a table for programs."""

import csv
import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from mutation.explained import ROOT, still_there
from mutation.mutant import Mutant, one_line
from mutation.verdict import STATES, MutationError, Verdict

LEAST_KILLED = 0.95  # of the mutants that are not equivalent
LEAST_KILLED_OF = {"subsystem": 0.97}
LEAST_KILLED_OF_FILE = {"synthesis": 0.90}  # parts that are judged file by file
Z = 1.959964  # of a normal distribution's middle 95 %


@dataclass(frozen=True)
class Run:
    """The run that judged a part of the table."""

    seed: int
    date: str = ""  # nothing: the table's writer did not note it


def least_killed(language: str) -> float:
    return (LEAST_KILLED_OF_FILE | LEAST_KILLED_OF).get(language, LEAST_KILLED)


def judged_together(language: str, verdicts: Sequence[Verdict]) -> dict[str, Sequence[Verdict]]:
    """Verdicts by what has to reach the least share: the language or, for some, each file."""
    return _by(verdicts, lambda file: file) if language in LEAST_KILLED_OF_FILE else {language: verdicts}


def _by(verdicts: Sequence[Verdict], title: Callable[[str], str]) -> dict[str, Sequence[Verdict]]:
    found: dict[str, list[Verdict]] = {}
    for verdict in verdicts:
        found.setdefault(title(verdict.mutant.file), []).append(verdict)
    return dict(sorted(found.items()))


def interval(killed: int, judged: int) -> tuple[float, float]:
    """95 % confidence interval of the share killed among all mutants, from a drawn sample (Wilson)."""
    if judged == 0:
        return 0.0, 1.0
    share, weight = killed / judged, Z**2 / judged
    centre = (share + weight / 2) / (1 + weight)
    half = math.sqrt(share * (1 - share) * weight + weight**2 / 4) / (1 + weight)
    return max(0.0, centre - half), min(1.0, centre + half)


def killed_share(verdicts: Sequence[Verdict]) -> float:
    """Share of non-equivalent mutants that were killed; 1.0 if there is no such mutant."""
    states = Counter(verdict.state for verdict in verdicts)
    judged = states["killed"] + states["survived"]
    return states["killed"] / judged if judged else 1.0


def unexplained(verdicts: Sequence[Verdict]) -> list[Verdict]:
    return [verdict for verdict in verdicts if verdict.state == "survived" and not verdict.by]


def summary(parts: Mapping[str, Sequence[Verdict]]) -> str:
    """Table with a row per language, then a row per folder, or per file for what is judged file by file."""
    lines = [f"| | mutants | {' | '.join(STATES)} | killed of the others | 95 % interval |", f"|---|{'---:|' * (len(STATES) + 3)}"]
    for title, verdicts in parts.items():
        lines.append(_row(f"**{title}**", verdicts))
        rows = _by(verdicts, lambda file: file if title in LEAST_KILLED_OF_FILE else str(Path(file).parent))
        lines += [_row(name, some) for name, some in rows.items()]
    return "\n".join(lines)


def _row(title: str, verdicts: Sequence[Verdict]) -> str:
    states = Counter(verdict.state for verdict in verdicts)
    counts = " | ".join(str(states[state]) for state in STATES)
    low, high = interval(states["killed"], states["killed"] + states["survived"])
    return f"| {title} | {len(verdicts)} | {counts} | {100 * killed_share(verdicts):.1f} % | {100 * low:.0f} to {100 * high:.0f} % |"


def measured(language: str, verdicts: Sequence[Verdict], run: Run, root: Path) -> str:
    """When a part was measured, and whether the sources are still those of that time."""
    gone = sum(not still_there(verdict.mutant, root) for verdict in verdicts)
    date = f"measured on {run.date}" if run.date else "date unknown"
    state = (f"**measured before**: {gone} of the {len(verdicts)} changed lines are no longer in the sources" if gone
             else f"all {len(verdicts)} changed lines are in the sources")  # fmt: skip
    return f"- {language}: seed {run.seed}, {date}; {state}"


def markdown(parts: Mapping[str, Sequence[Verdict]], runs: Mapping[str, Run], root: Path = ROOT) -> str:
    sections = [
        "# Mutants",
        "What `make mutate` found. A mutant is one small change of the code: another operator or constant, "
        "a condition negated, a statement removed, one of two names that are easily mixed up. A killed mutant makes a test "
        "or a proof fail, or a program crash or hang; "
        "[mutants.csv](mutants.csv) names it. A proved equivalent one compiles to the same machine code or circuit, or "
        "Yosys and ABC prove that no input tells it from the original; an argued equivalent one has its argument "
        "below. The interval is Wilson's for a drawn sample; "
        "it is too high where tests were added for survivors of this very sample. What must be killed: "
        f"{100 * LEAST_KILLED:.0f} % of a language, {100 * LEAST_KILLED_OF['subsystem']:.0f} % of the subsystem, "
        f"{100 * LEAST_KILLED_OF_FILE['synthesis']:.0f} % in each file of the synthesis flow.",
        "Parts can be measured one by one (`scripts/mutate.py --only`):",
        "\n".join(measured(language, verdicts, runs[language], root) for language, verdicts in parts.items()),
        summary(parts),
    ]
    for state in ("survived", "argued equivalent", "proved equivalent"):
        sections.append(f"## {state.capitalize()}")
        named = [verdict for verdicts in parts.values() for verdict in verdicts if verdict.state == state]
        sections.append("\n".join(_item(verdict) for verdict in named) or "None.")
    return "\n\n".join(sections) + "\n"


def _item(verdict: Verdict) -> str:
    mutant = verdict.mutant
    return f"- {mutant.file}:{mutant.line} `{mutant.change}`: {verdict.by or 'NOT EXPLAINED'}"


COLUMNS = ["language", "seed", "date", "file", "line", "operator", "original", "mutated", "verdict", "by", "source", "above"]


def write_table(parts: Mapping[str, Sequence[Verdict]], runs: Mapping[str, Run], path: Path) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS)
        for language, verdicts in parts.items():
            for verdict in verdicts:
                mutant = verdict.mutant
                change = [mutant.operator, one_line(mutant.original), one_line(mutant.mutated)]
                found = [verdict.state, verdict.by, mutant.source, mutant.above]
                table.writerow([language, runs[language].seed, runs[language].date, mutant.file, mutant.line, *change, *found])


def read_table(path: Path) -> tuple[dict[str, list[Verdict]], dict[str, Run]]:
    """Verdicts and runs from the table of earlier runs. Older tables have no dates."""
    parts: dict[str, list[Verdict]] = {}
    runs: dict[str, Run] = {}
    try:
        with path.open(encoding="utf-8", newline="") as file:
            for row in csv.DictReader(file):
                mutant = Mutant(file=row["file"], line=int(row["line"]), begin=0, end=0, original=row["original"], mutated=row["mutated"],
                                operator=row["operator"], source=row["source"], above=row["above"], place=0)
                parts.setdefault(row["language"], []).append(Verdict(mutant, row["verdict"], row["by"]))
                runs[row["language"]] = Run(int(row["seed"]), row.get("date", ""))
    except (OSError, KeyError, ValueError) as error:
        raise MutationError(f"{path}: {error!r}: make mutate writes it") from None
    return parts, runs
