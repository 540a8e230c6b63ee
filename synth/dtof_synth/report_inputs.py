# SPDX-License-Identifier: Apache-2.0
"""What the flow's reports are measured on, noted and recorded as for every report of the project (scripts/figures)."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "scripts"))

from figures import reports, staleness  # noqa: E402
from figures.source_tree import SourceTree  # noqa: E402

FLOW = "synthesis"  # group of inputs


def begin(name: str) -> str:
    """Before a report is measured: the digest of its inputs."""
    return staleness.begin(ROOT, reports.load(ROOT)[name], SourceTree(ROOT))


def record(name: str) -> None:
    """After the report's files are written."""
    subprocess.run([sys.executable, ROOT / "scripts" / "reports.py", "record", name], check=True)


def flow_digest(root: Path) -> str:
    """Digest of RTL, constraints, and all that the flow runs."""
    return reports.group(root, FLOW, SourceTree(root)).digest
