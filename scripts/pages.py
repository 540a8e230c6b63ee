#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`pages.py DTOF_STUDY [--check]`: makes the pages of reports/ again, from reports/data/*.page.json and the templates that the program DTOF_STUDY has.
Nothing is measured: after words have changed, this renews the pages. --check writes nothing, and fails if a page differs."""

import subprocess
import sys
from pathlib import Path

from dtof_synth import program
from figures import staleness
from figures.reports import page_data
from page.sections import ALL, Report, as_committed

ROOT = Path(__file__).resolve().parent.parent


def from_data(report: Report, study: str, root: Path) -> str:
    """The page as the template makes it, in its form in reports/, with the committed page's line about its age."""
    made = subprocess.run([study, "page", root / "reports" / page_data(report.committed)], capture_output=True, text=True)
    if made.returncode:
        sys.exit(made.stderr.strip())
    text = made.stdout
    committed = (root / "reports" / report.committed).read_text(encoding="utf-8")
    mark = committed.removesuffix(staleness.without_mark(committed))
    return mark + as_committed(report, text)


def main() -> int:
    arguments = [argument for argument in sys.argv[1:] if argument != "--check"]
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    differing = 0
    for report in ALL:
        if not report.built or not (ROOT / "reports" / page_data(report.committed)).is_file():
            continue
        page = ROOT / "reports" / report.committed
        text = from_data(report, arguments[0], ROOT)
        if text == page.read_text(encoding="utf-8"):
            continue
        differing += 1
        if "--check" in sys.argv:
            print(f"reports/{report.committed} is not what its template makes of {page_data(report.committed)}: make pages")
        else:
            page.write_text(text, encoding="utf-8")
            print(f"reports/{report.committed} has other words")
    return 1 if differing and "--check" in sys.argv else 0


if __name__ == "__main__":
    program.run(main)
