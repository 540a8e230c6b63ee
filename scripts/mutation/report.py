# SPDX-License-Identifier: Apache-2.0
"""Writes the verdicts on the mutants: a page for people, a table for programs."""

import csv
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

from mutation.mutant import Mutant, one_line
from mutation.verdict import STATES, MutationError, Verdict

LEAST_KILLED = 0.95  # of the mutants that are not equivalent


def killed_share(verdicts: Sequence[Verdict]) -> float:
    """Share of non-equivalent mutants that were killed; 1.0 if there is no such mutant."""
    states = Counter(verdict.state for verdict in verdicts)
    judged = states["killed"] + states["survived"]
    return states["killed"] / judged if judged else 1.0


def unexplained(verdicts: Sequence[Verdict]) -> list[Verdict]:
    return [verdict for verdict in verdicts if verdict.state == "survived" and not verdict.by]


def summary(parts: Mapping[str, Sequence[Verdict]]) -> str:
    """Table with a row per language, then a row per folder."""
    lines = [f"| | mutants | {' | '.join(STATES)} | killed of the others |", f"|---|{'---:|' * (len(STATES) + 2)}"]
    for title, verdicts in parts.items():
        lines.append(_row(f"**{title}**", verdicts))
        folders: dict[str, list[Verdict]] = {}
        for verdict in verdicts:
            folders.setdefault(str(Path(verdict.mutant.file).parent), []).append(verdict)
        lines += [_row(folder, of_folder) for folder, of_folder in sorted(folders.items())]
    return "\n".join(lines)


def _row(title: str, verdicts: Sequence[Verdict]) -> str:
    states = Counter(verdict.state for verdict in verdicts)
    counts = " | ".join(str(states[state]) for state in STATES)
    return f"| {title} | {len(verdicts)} | {counts} | {100 * killed_share(verdicts):.1f} % |"


def markdown(parts: Mapping[str, Sequence[Verdict]], seeds: Mapping[str, int]) -> str:
    drawn = ", ".join(f"{language} seed {seeds[language]}" for language in parts)
    sections = [
        "# Mutants",
        f"What `make mutate` found ({drawn}). A mutant is one small change of the code: another operator or constant, "
        "a condition negated, a statement removed. A killed mutant makes a test fail, crash or hang; "
        "[mutants.csv](mutants.csv) names it. A proved equivalent one compiles to the same machine code or circuit, or "
        "Yosys and ABC prove that no input tells it from the original; an argued equivalent one has its argument "
        "below.",
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


COLUMNS = ["language", "seed", "file", "line", "operator", "original", "mutated", "verdict", "by", "source", "above"]


def write_table(parts: Mapping[str, Sequence[Verdict]], seeds: Mapping[str, int], path: Path) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS)
        for language, verdicts in parts.items():
            for verdict in verdicts:
                mutant = verdict.mutant
                change = [mutant.operator, one_line(mutant.original), one_line(mutant.mutated)]
                found = [verdict.state, verdict.by, mutant.source, mutant.above]
                table.writerow([language, seeds[language], mutant.file, mutant.line, *change, *found])


def read_table(path: Path) -> tuple[dict[str, list[Verdict]], dict[str, int]]:
    """Verdicts and seeds from the table of an earlier run."""
    parts: dict[str, list[Verdict]] = {}
    seeds: dict[str, int] = {}
    try:
        with path.open(encoding="utf-8", newline="") as file:
            for row in csv.DictReader(file):
                change = {name: row[name] for name in ("file", "original", "mutated", "operator", "source", "above")}
                mutant = Mutant(line=int(row["line"]), begin=0, end=0, place=0, **change)
                parts.setdefault(row["language"], []).append(Verdict(mutant, row["verdict"], row["by"]))
                seeds[row["language"]] = int(row["seed"])
    except (OSError, KeyError, ValueError) as error:
        raise MutationError(f"{path}: {error!r}: make mutate writes it") from None
    return parts, seeds
