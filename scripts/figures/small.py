# SPDX-License-Identifier: Apache-2.0
"""`make TARGET SMALL=1`: the same programs and steps on less work. What they leave is no measurement, thus it lies in a root of its
own, build/small: build/small/build/ for build/, build/small/reports/ for reports/."""

import os
from pathlib import Path

FOLDER = "build/small"  # the Makefile has it, too


def is_small() -> bool:
    return bool(os.environ.get("SMALL"))


def written_root(root: Path) -> Path:
    """The root below which build/ and reports/ are written."""
    if not is_small():
        return root
    (root / FOLDER / "reports").mkdir(parents=True, exist_ok=True)
    return root / FOLDER
