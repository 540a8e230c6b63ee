#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Changes RTL and C++ models in many small ways, one at a time, and counts the changes that the tests notice.

Writes reports/mutants.md and reports/mutants.csv; with --only neither. Ends with status 1 if fewer than 95 % of the
mutants that are not equivalent are killed, or if a survivor is not explained in scripts/mutation/explained.toml.
"""

import argparse
import os
import sys
import time
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "scripts"))

from mutation import cpp, report, rtl  # noqa: E402
from mutation.explained import explain, load  # noqa: E402
from mutation.verdict import MutationError, Verdict  # noqa: E402

BUILD = ROOT / "build" / "mutate"
RUNS = {"C++": cpp.run, "RTL": rtl.run}


def judged(language: str, count: int, seed: int, jobs: int) -> list[Verdict]:
    """`count` mutants of a language, the survivors explained."""
    known = load()
    verdicts = RUNS[language](count, seed, BUILD / language.lower().replace("+", "p"), jobs)
    return [explain(verdict, source_line(verdict), known) for verdict in verdicts]


def source_line(verdict: Verdict) -> str:
    return (ROOT / verdict.mutant.file).read_text().splitlines()[verdict.mutant.line - 1].strip()


def failures(parts: dict[str, Sequence[Verdict]]) -> list[str]:
    """Why the run is not good enough."""
    found = []
    for language, verdicts in parts.items():
        share = report.killed_share(verdicts)
        if share < report.LEAST_KILLED:
            found.append(f"{language}: {100 * share:.1f} % killed, less than {100 * report.LEAST_KILLED:.0f} %")
        for verdict in report.unexplained(verdicts):
            mutant = verdict.mutant
            found.append(f"{mutant.file}:{mutant.line}: {mutant.change} survives and is not explained")
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=1, help="draws the mutants")
    parser.add_argument("--count", type=int, default=200, help="mutants of each language")
    parser.add_argument("--only", choices=RUNS, help="one language; writes no report")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="processes at a time")
    arguments = parser.parse_args()
    if arguments.count < 1 or arguments.jobs < 1:
        parser.error("--count and --jobs must be at least 1")
    print(f"seed {arguments.seed}", flush=True)
    parts: dict[str, Sequence[Verdict]] = {}
    try:
        for language in [arguments.only] if arguments.only else RUNS:
            started = time.monotonic()
            parts[language] = judged(language, arguments.count, arguments.seed, arguments.jobs)
            print(f"{language}: {len(parts[language])} mutants in {time.monotonic() - started:.0f} s", flush=True)
    except MutationError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("interrupted: nothing is written", file=sys.stderr)
        return 130
    print(report.summary(parts))
    if not arguments.only:
        report.write(parts, arguments.seed, f"make mutate SEED={arguments.seed}", ROOT / "reports")
    found = failures(parts)
    for failure in found:
        print(f"FAILED {failure}", file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
