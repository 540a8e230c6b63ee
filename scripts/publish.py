#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`publish.py REPORT ...`: copies what a command left in build/ to reports/: text, tables and the pictures that are kept
there (scripts/page/sections.py has the lists). Their figures go to reports/figures.json, and the README's results follow.
With SMALL=1 from build/small/build/ to build/small/reports/, and nothing follows."""

import subprocess
import sys
from pathlib import Path

from dtof_synth import program
from figures import staleness
from figures.reports import load, page_data
from figures.small import written_root
from page.sections import ALL, copy_table, for_reports, page_data_built

ROOT = Path(__file__).resolve().parent.parent


def main() -> int:
    reports = {report.name: report for report in ALL if report.built}
    if len(sys.argv) < 2 or not reports.keys() >= set(sys.argv[1:]):
        print(f"{__doc__}\nReports: {' '.join(reports)}", file=sys.stderr)
        return 2
    root = written_root(ROOT)
    listed = {page: entry for entry in load(ROOT).values() for page in entry.pages}
    measured: dict[str, None] = {}
    for name in sys.argv[1:]:
        report = reports[name]
        assert report.built is not None  # see above
        needed = [report.built, *(built for built, _ in report.with_it)]
        missing = [file for file in needed if not (root / "build" / file).is_file()]
        if missing:
            print(f"error: build/{missing[0]} is missing: run `make {report.target}` first", file=sys.stderr)
            return 1
        entry = listed[report.committed]
        begun = root / staleness.BEGUN / f"{entry.name}.json"
        if not begun.is_file() or (root / "build" / report.built).stat().st_mtime < begun.stat().st_mtime:
            print(f"error: build/{report.built} is not what `make {report.target}` leaves now: run it first", file=sys.stderr)
            return 1
        measured[entry.name] = None
        for built, committed in report.with_it:
            copy_table(root / "build" / built, root / "reports" / committed)
        if (data := page_data_built(report, root)).is_file():
            copy_table(data, root / "reports" / page_data(report.committed))
        written = root / "reports" / report.committed
        written.parent.mkdir(parents=True, exist_ok=True)
        written.write_text(for_reports(report, root), encoding="utf-8")
        print(f"{written.relative_to(ROOT)} renewed")
    return subprocess.run([ROOT / "scripts" / "reports.py", "record", *measured]).returncode


if __name__ == "__main__":
    program.run(main)
