# SPDX-License-Identifier: Apache-2.0
"""Notes and records the inputs of the flow's reports, as for every report of the project (scripts/figures)."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "scripts"))

from figures import reports, staleness  # noqa: E402
from figures.source_tree import SourceTree  # noqa: E402

FLOW = "synthesis"  # groups of inputs
RUN = "run"


def begin(name: str) -> str:
    """Notes the inputs before a report is measured; returns their digest."""
    return staleness.begin(ROOT, reports.load(ROOT)[name], SourceTree(ROOT))


def record(name: str) -> None:
    """Records the inputs after the report's files are written."""
    subprocess.run([sys.executable, ROOT / "scripts" / "reports.py", "record", name], check=True)


def flow_digest(root: Path) -> str:
    """Digest of RTL, constraints, and everything that the flow runs."""
    return reports.group(root, FLOW, SourceTree(root)).digest


def run_files(root: Path) -> dict[str, str]:
    """Digests of the files that a run needs besides RTL, configuration and libraries."""
    return reports.group(root, RUN, SourceTree(root)).files
