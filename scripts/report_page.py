#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes build/report/index.html: results, plots and documents of this tree as pages that need no network and can be moved.

`report_page.py [FOLDER]`: another folder than build/report. Its content is replaced.
"""

import os
import sys
from pathlib import Path

from dtof_synth import program
from page.library import fetch
from page.site import Site

ROOT = Path(__file__).resolve().parent.parent


def main() -> int:
    if len(sys.argv) > 2 or sys.argv[1:2] in (["-h"], ["--help"]):
        print(__doc__, file=sys.stderr)
        return 2
    out = Path(sys.argv[1]) if len(sys.argv) == 2 else ROOT / "build" / "report"
    library = fetch(ROOT)
    if library.why_not:
        print(f"The plots of the page are pictures: {library.why_not}")
    wrong = Site(ROOT, out, library).write()
    for sentence in wrong:
        print(f"error: {sentence}", file=sys.stderr)
    if wrong:
        return 1
    print(f"The page of all results: {os.path.relpath(out)}/index.html")
    return 0


if __name__ == "__main__":
    program.run(main)
