# SPDX-License-Identifier: Apache-2.0
"""Command of make synth-subsystem: dtof_subsystem around arrays, whose times come from the netlists of make synth."""

from __future__ import annotations

import argparse
import os
import sys
import time

from . import batch, configuration, report_inputs, subsystem, subsystem_report
from . import technology as technologies
from .cli import ROOT, all_configurations
from .errors import FlowError


def _say(text: str) -> None:
    print(text, flush=True)


def _run(names: list[str], jobs: int) -> bool:
    """Measures the subsystems; True if every goal is met. Without names it also writes the report."""
    started = time.monotonic()
    named = configuration.load(ROOT / "configurations.toml")
    unknown = [name for name in names if name not in named]
    if unknown:
        raise FlowError(f"unknown configuration '{unknown[0]}'; known: {', '.join(named)}")
    chosen = [named[name] for name in names or subsystem.CONFIGURATIONS]
    digest = report_inputs.begin("subsystem")
    build = ROOT / "build" / "synth"
    technology = technologies.prepare(ROOT, build / "generic40", all_configurations(named))
    results = batch.run_all([batch.Job(item) for item in chosen], technology, build / "runs", jobs, _say)
    found = subsystem.measure_all([results[item.name] for item in chosen], technology, build, jobs, digest, _say)
    goals = subsystem_report.goals(found)
    for goal in goals:
        _say(f"{'met' if goal.met else 'missed'}: {goal.text}: {goal.value}")
    if not names:
        (ROOT / "reports" / "subsystem.md").write_text(subsystem_report.report(found, digest), encoding="utf-8")
        subsystem_report.write_csv(ROOT / "reports" / "subsystem.csv", found)
        report_inputs.record("subsystem")
        _say("reports/subsystem.md, reports/subsystem.csv written")
    _say(f"{len(found)} subsystems in {time.monotonic() - started:.0f} s")
    return all(goal.met for goal in goals)


def main() -> int:
    parser = argparse.ArgumentParser(description="Area, timing and power of dtof_subsystem around arrays.")
    parser.add_argument("configuration", nargs="*", help="names from configurations.toml, without renewing reports/; none: "
                        f"{', '.join(subsystem.CONFIGURATIONS)}")
    parser.add_argument("--strict", action="store_true", help="fail if a goal is missed")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="subsystems at the same time")
    arguments = parser.parse_args()
    try:
        met = _run(arguments.configuration, max(arguments.jobs, 1))
    except FlowError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return 130
    return 1 if arguments.strict and not met else 0
