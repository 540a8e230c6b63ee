#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Changes RTL, C++ models and the synthesis flow in many small ways, one at a time, and counts the changes that the tests notice.

Writes reports/mutants.csv and reports/mutants.md. Ends with status 1 if fewer than 95 % of the mutants that are not
equivalent are killed (97 % of the subsystem's, 90 % in each file of the synthesis flow), or if a survivor is not explained in scripts/mutation/explained.toml.
"""

import argparse
import datetime
import os
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from dtof_synth import program
from figures.small import written_root
from figures.staleness import MARK
from mutation import cpp, report, rtl, subsystem, synthesis
from mutation.explained import explain, load
from mutation.verdict import MutationError, Verdict

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "mutate"
TABLE = written_root(ROOT) / "reports" / "mutants.csv"
RUNS: dict[str, Callable[[int, int, Path, int], list[Verdict]]] = {"C++": cpp.run, "RTL": rtl.run, "subsystem": subsystem.run, "synthesis": synthesis.run}
COUNTS = {"C++": 200, "RTL": 160, "subsystem": 110, "synthesis": 20}  # synthesis: of each file


def judged(language: str, arguments: argparse.Namespace) -> list[Verdict]:
    started = time.monotonic()
    folder = BUILD / RUNS[language].__module__.rpartition(".")[2]
    verdicts = RUNS[language](arguments.count or COUNTS[language], arguments.seed, folder, arguments.jobs)
    print(f"{language}: {len(verdicts)} mutants in {time.monotonic() - started:.0f} s", flush=True)
    return verdicts


def failures(parts: Mapping[str, Sequence[Verdict]]) -> list[str]:
    """Reasons why the run fails."""
    found = []
    for language, verdicts in parts.items():
        least = report.least_killed(language)
        for title, some in report.judged_together(language, verdicts).items():
            share = report.killed_share(some)
            if share < least:
                found.append(f"{title}: {100 * share:.1f} % killed, less than {100 * least:.0f} %")
        for verdict in report.unexplained(verdicts):
            mutant = verdict.mutant
            found.append(f"{mutant.file}:{mutant.line}: {mutant.change} survives and is not explained")
    return found


def stale_mark(page: Path) -> str:
    """The first lines of a page that say that it was measured before: they stay when a part alone is renewed."""
    text = page.read_text(encoding="utf-8") if page.exists() else ""
    return text.partition("\n\n")[0] + "\n\n" if text.startswith(MARK) else ""


def run(arguments: argparse.Namespace) -> int:
    chosen = [] if arguments.explain else [arguments.only] if arguments.only else list(RUNS)
    if chosen:
        print(f"seed {arguments.seed}", flush=True)
    load()  # refuses damage before the long work
    found = {language: judged(language, arguments) for language in chosen}
    others = len(chosen) < len(RUNS) and (TABLE.exists() or arguments.explain)
    parts, runs = report.read_table(TABLE) if others else ({}, {})
    parts |= found
    runs |= {language: report.Run(arguments.seed, datetime.date.today().isoformat()) for language in chosen}
    known = load()
    explained = {name: [explain(verdict, known) for verdict in parts[name]] for name in RUNS if name in parts}
    report.write_table(explained, runs, TABLE)
    page = TABLE.with_suffix(".md")
    page.write_text(stale_mark(page) * others + report.markdown(explained, runs), encoding="utf-8")
    print(report.summary(explained))
    reasons = failures(explained)
    for reason in reasons:
        print(f"FAILED {reason}", file=sys.stderr)
    return 1 if reasons else 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=1, help="draws the mutants")
    parser.add_argument("--count", type=int, help=f"mutants of each language, of synthesis those of each file, instead of {COUNTS}")
    parser.add_argument("--only", choices=RUNS, help="judges one language, and leaves the other as the table has it")
    parser.add_argument("--explain", action="store_true", help="judges nothing: writes the report anew from the table")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="processes at a time")
    arguments = parser.parse_args()
    if (arguments.count is not None and arguments.count < 1) or arguments.jobs < 1:
        parser.error("--count and --jobs must be at least 1")
    try:
        return run(arguments)
    except (MutationError, rtl.FlowError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("interrupted: nothing is written", file=sys.stderr)
        return 130


if __name__ == "__main__":
    program.run(main)
