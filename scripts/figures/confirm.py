# SPDX-License-Identifier: Apache-2.0
"""Small runs that confirm a report. A command that runs with SMALL=1 does the same steps on less work, and its files are the same bytes in
every run. While a report is fresh, the digest of these files is stored with the report's inputs. After a change of the inputs, the same
digest says that the change altered nothing that the small run reaches. Such a report is confirmed: it is not stale, and its pages say
which inputs have changed. A report may name another command that confirms it (`confirm` in its entry), and the inputs that the command's
output stands for; then no other input may have changed."""

import hashlib
import os
import subprocess
import tomllib
from pathlib import Path

from . import staleness
from .reports import Report, inputs, not_covered, page_data
from .small import FOLDER
from .source_tree import SourceTree

TRIALS = "scripts/try_targets.toml"


def why_not(root: Path, report: Report) -> str:
    """Why a small run of the report's command can confirm nothing; empty if it can."""
    if report.confirm:
        return ""
    words = report.command.split()
    path = root / TRIALS
    trials = tomllib.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}
    if len(words) != 2 or words[0] != "make" or words[1] not in trials:
        return f"`{report.command}` is no target that runs on little work"
    trial = trials[words[1]]
    if "long" in trial:
        return f"`{report.command}` is too long, even on little work"
    if "arguments" in trial:
        return f"`{report.command}` leaves out configurations when it runs on little work"
    return ""


def digest_of_files(folder: Path, report: Report) -> str:
    """Digest of the report's files in `folder`, without the lines about their age. Where a page is made from data, the data count: other
    words change no result."""
    found = hashlib.sha256()
    for name in sorted(report.written):
        data = folder / "reports" / page_data(name.removeprefix("reports/"))
        content = data.read_bytes() if name.endswith(".md") and data.is_file() else (folder / name).read_bytes()
        if name.endswith(".md"):
            content = staleness.without_mark(content.decode()).encode()
        found.update(f"{name} {len(content)}\n".encode() + content)
    return found.hexdigest()[:16]


def small_run(root: Path, report: Report) -> str | None:
    """Runs the report's command on little work, or the one that confirms it; returns the digest of what it writes, or None if it fails."""
    folder = root / FOLDER
    if report.confirm:
        folder.mkdir(parents=True, exist_ok=True)
        with (folder / f"{report.name}.log").open("w", encoding="utf-8") as log:
            finished = subprocess.run(report.confirm, shell=True, cwd=root, stdout=subprocess.PIPE, stderr=log)
        rest = not_covered(report, SourceTree(root))
        return hashlib.sha256(finished.stdout + rest.encode()).hexdigest()[:16] if finished.returncode == 0 and finished.stdout else None
    for name in report.written:
        (folder / name).unlink(missing_ok=True)
        (folder / "reports" / page_data(name.removeprefix("reports/"))).unlink(missing_ok=True)
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / f"{report.name}.log").open("w", encoding="utf-8") as log:
        done = subprocess.run(f"{report.command} SMALL=1", shell=True, cwd=root, stdout=log, stderr=subprocess.STDOUT,
                              env=os.environ | {"SMALL": "1"})
    if done.returncode or not all((folder / name).is_file() for name in report.written):
        return None
    return digest_of_files(folder, report)


def confirm(root: Path, report: Report) -> str:
    """Confirms a stale report, or stores the digest that will confirm a fresh one; returns what was found, in words."""
    if reason := why_not(root, report):
        return f"not confirmed: {reason}"
    known = staleness.measured(root).get(report.name)
    now = inputs(report, SourceTree(root))
    stale = staleness.compared(report, known, now)
    small = known.small if known and known.small_by == staleness.confirmed_by(report) else ""  # else it is that of another command
    if known is None or (stale and not small):
        return "stale, and no small run was made while it was fresh"
    if small and not stale:
        return "fresh"
    digest = small_run(root, report)
    if digest is None:
        return f"not confirmed: `{staleness.confirming(report)}` failed, see {FOLDER}/{report.name}.log"
    if inputs(report, SourceTree(root)).digest != now.digest:
        return "not confirmed: its inputs changed while the small run was made"
    if not stale:
        staleness.store_small(root, report, digest)
        return "fresh: the digest of its small run is stored"
    if digest != small:
        return f"stale: `{staleness.confirming(report)}` writes other bytes than before, `{report.command}` renews it"
    staleness.store_confirmed(root, report, now)
    return f"confirmed: `{staleness.confirming(report)}` writes the same bytes as before"
