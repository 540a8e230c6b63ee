#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Reports, the figures that pages quote from them, and what is stale (docs/reference/figures.md).

`begin REPORT ...`   notes what the report is about to be measured on; its command calls this first
`record REPORT ...`  the report was measured: its figures go to reports/figures.json, its inputs to reports/digests.json
`record REPORT --commit COMMIT`  the same for a report that was committed with COMMIT
`figures [--check]`  writes figures into README.md and docs/, and what is stale into the first lines of report pages
`stale`              lists stale reports, what changed, and how long renewing takes
`stale-check`        fails if a figure that README.md or the page of results shows is stale, or a report of two minutes
`renew [--list]`     renews every stale report, in order; what is fresh is passed over
`confirm [REPORT ...]`  runs commands with SMALL=1: stores what they write for fresh reports, confirms stale ones that write the same bytes

With SMALL=1 `begin` and `record` leave what lies here alone and note in build/small; no page follows.
"""

import argparse
import os
import subprocess
import sys
from pathlib import Path

import update_readme
from dtof_synth import program
from figures import confirm, hand_typed, references, staleness, store, tables
from figures.reports import LIST, Report, ReportsError, load
from figures.small import is_small, written_root
from figures.source_tree import SourceTree

ROOT = Path(__file__).resolve().parent.parent
MINUTES_TO_BE_FRESH = 2.0  # before a release
MINUTES_TO_BE_FRESH_ALWAYS = 0.5
FILES_SHOWN = 8  # of a stale report


def say_errors(sentences: list[str]) -> int:
    for sentence in sentences:
        print(f"error: {sentence}", file=sys.stderr)
    return 1 if sentences else 0


def chosen(names: list[str], known: dict[str, Report]) -> list[Report]:
    unknown = [name for name in names if name not in known]
    if unknown:
        raise ReportsError(f"{LIST} has no report '{unknown[0]}'; it has {', '.join(known)}")
    return [known[name] for name in names]


def begin(options: argparse.Namespace, known: dict[str, Report]) -> int:
    tree = SourceTree(ROOT)
    for report in chosen(options.report, known):
        staleness.begin(written_root(ROOT), report, tree)
    return 0


def record(options: argparse.Namespace, known: dict[str, Report]) -> int:
    for report in chosen(options.report, known):
        missing = [name for name in report.written if not (written_root(ROOT) / name).is_file()]
        if missing:
            raise ReportsError(f"{missing[0]} is missing: run `{report.command}` first")
        if is_small():
            staleness.record(written_root(ROOT), report)
            continue
        measured = staleness.record_commit(ROOT, report, options.commit) if options.commit else staleness.record(ROOT, report)
        try:
            found = tables.figures(ROOT, report.name)
        except (KeyError, ValueError) as error:
            raise ReportsError(f"the files of {report.name} are not as scripts/figures/tables.py reads them: {error}") from error
        if found:
            store.record(ROOT, report.name, report.command, measured.digest, found)
    return figures(argparse.Namespace(check=False), known) if not options.commit and not is_small() else 0


def figures(options: argparse.Namespace, known: dict[str, Report]) -> int:
    tree = SourceTree(ROOT)
    found = staleness.stale(ROOT, known, tree)
    lines = staleness.first_lines(ROOT, known, tree)
    changed = references.render(ROOT, tree, options.check)
    if not options.check:
        update_readme.write()
        for name in changed + staleness.mark(ROOT, known, lines):
            print(f"{name} renewed")
        return 0
    return say_errors([f"{name}: a figure differs from {store.FILE}: run `make figures`" for name in changed]
                      + hand_typed.check(ROOT, tree) + staleness.unmarked_pages(ROOT, known, lines)
                      + [f"{name} is stale: run `{one.report.command}`, which takes seconds" for name, one in found.items()
                         if one.report.minutes < MINUTES_TO_BE_FRESH_ALWAYS])


def stale(options: argparse.Namespace, known: dict[str, Report]) -> int:
    tree = SourceTree(ROOT)
    found = staleness.stale(ROOT, known, tree)
    for one in found.values():
        print(f"{one.report.name}: {', '.join(one.places) or 'measured on what is not known'}")
        files = staleness.changed_files(ROOT, one, tree)
        for name in files[:FILES_SHOWN]:
            print(f"    {name}")
        if len(files) > FILES_SHOWN:
            print(f"    and {len(files) - FILES_SHOWN} more files")
        print(f"    `{one.report.command}` renews it: {staleness.minutes(one.report)}")
    if found:
        total = sum(one.report.minutes for one in found.values())
        print(f"{len(found)} of {len(known)} reports are stale; renewing them takes {total:.0f} minutes")
    return 0


def stale_check(options: argparse.Namespace, known: dict[str, Report]) -> int:
    """Fails for stale figures in README.md or on the page of results, and for stale reports that take at most two minutes. A page with a
    stale mark is no error."""
    tree = SourceTree(ROOT)
    found = staleness.stale(ROOT, known, tree)
    known_figures = store.load(ROOT)
    quoted = update_readme.quoted_reports(ROOT) | {known_figures[name].report
                                                   for name in references.quoted(tree.text("README.md"), known_figures)}
    wrong = []
    for name, one in found.items():
        where = "README.md shows its figures" if name in quoted else "the page of results of `make report` shows it" \
            if one.report.first else "renewing it takes less than two minutes" if one.report.minutes < MINUTES_TO_BE_FRESH else ""
        if where:
            wrong.append(f"{name} is stale, and {where}: `{one.report.command}` ({staleness.minutes(one.report)}) renews it")
    return say_errors(wrong)


def renew(options: argparse.Namespace, known: dict[str, Report]) -> int:
    for name, report in known.items():
        one = staleness.stale(ROOT, {name: report}, SourceTree(ROOT)).get(name)
        if one is None:
            continue
        if options.list:
            print(f"{name}: {report.command} ({staleness.minutes(report)})")
            continue
        data = ROOT / os.environ.get("SHARED_DATA", "../shared/data")
        missing = [file for file in report.data if not (data / file).is_file()]
        if missing:
            print(f"{name}: {missing[0]} is not here: passed over")
            continue
        print(f"{name}: {report.command} ({staleness.minutes(report)})", flush=True)
        if subprocess.run(report.command, shell=True, cwd=ROOT).returncode:
            return say_errors([f"{name}: `{report.command}` failed; what was renewed before stays, and `make reports` goes on here"])
        if staleness.stale(ROOT, {name: report}, SourceTree(ROOT)):
            return say_errors([f"{name}: `{report.command}` ended, but recorded no inputs: does it call scripts/reports.py?"])
        if not confirm.why_not(ROOT, report):
            print(f"{name}: {confirm.confirm(ROOT, report)}", flush=True)
    return 0


def confirm_all(options: argparse.Namespace, known: dict[str, Report]) -> int:
    """Confirms the reports with these names; without names, those whose command runs on little work."""
    wanted = chosen(options.report, known) or [report for report in known.values() if not confirm.why_not(ROOT, report)]
    for report in wanted:
        print(f"{report.name}: {confirm.confirm(ROOT, report)}", flush=True)
    return figures(argparse.Namespace(check=False), known)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    for name, action in (("begin", begin), ("record", record)):
        command = commands.add_parser(name)
        command.add_argument("report", nargs="+")
        command.set_defaults(action=action, commit="")
        if action is record:
            command.add_argument("--commit", default="")
    command = commands.add_parser("figures")
    command.add_argument("--check", action="store_true")
    command.set_defaults(action=figures)
    for name, action in (("stale", stale), ("stale-check", stale_check)):
        commands.add_parser(name).set_defaults(action=action)
    command = commands.add_parser("confirm")
    command.add_argument("report", nargs="*")
    command.set_defaults(action=confirm_all)
    command = commands.add_parser("renew")
    command.add_argument("--list", action="store_true")
    command.set_defaults(action=renew)
    options = parser.parse_args()
    try:
        return options.action(options, load(ROOT))
    except (ReportsError, subprocess.CalledProcessError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    program.run(main)
