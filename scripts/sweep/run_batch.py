#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`run_batch.py SWEEP.toml FOLDER NUMBER HASH`: computes the points of a batch, one after the other, and writes its file."""

import csv
import hashlib
import json
import os
import shlex
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import plan

ROOT = Path(__file__).resolve().parent.parent.parent


def read_table(path: Path) -> tuple[list[str], list[list[str]]]:
    try:
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
    except OSError as error:
        raise plan.SweepError(f"{path.name}: {error.strerror}: the command left no table") from None
    if len(rows) < 2:
        raise plan.SweepError(f"{path.name}: the command's table has no rows")
    return rows[0], rows[1:]


def compute(sweep: plan.Sweep, point: plan.Point) -> tuple[list[str], list[list[str]]]:
    """Header and rows of the point's table."""
    with tempfile.TemporaryDirectory() as out:
        values = {**point.values(), "out": out}
        command = [part.format(**values) for part in shlex.split(sweep.command)]
        result = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
        if result.returncode != 0:
            last = (result.stderr.strip() or result.stdout.strip()).splitlines()[-1:]
            raise plan.SweepError(f"{shlex.join(command)}: exit {result.returncode}: {''.join(last)}")
        return read_table(Path(out) / sweep.table)


def checksum(header: list[str], points: list) -> str:
    return hashlib.sha256(json.dumps([header, points]).encode()).hexdigest()


def write(path: Path, batch: plan.Batch, header: list[str], points: list) -> None:
    """Writes the whole file or nothing, even if the job is killed while it writes."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile("w", dir=path.parent, prefix=".", suffix=".part", encoding="utf-8", delete=False) as file:
        json.dump({"batch": batch.name, "header": header, "points": points, "checksum": checksum(header, points)}, file)
        file.flush()
        os.fsync(file.fileno())
    os.chmod(file.name, 0o644)  # others of a cluster may merge it
    os.replace(file.name, path)


def wanted(path: Path, number: int, name: str) -> tuple[plan.Sweep, plan.Batch]:
    """The sweep, and its batch with this number, which must have this name."""
    sweep = plan.load(path, ROOT)
    batch = sweep.batch(number)
    if batch.name != name:
        raise plan.SweepError(f"{path}: batch {number} is {batch.name} now, not {name}: the description or an input changed "
                              "while the sweep ran; start it again")
    return sweep, batch


def main() -> int:
    if len(sys.argv) != 5 or not sys.argv[3].isdecimal():
        print(__doc__, file=sys.stderr)
        return 2
    for ended in (signal.SIGTERM, signal.SIGINT):  # by Slurm or at the terminal: no folder of a point stays behind
        signal.signal(ended, lambda number, _: sys.exit(128 + number))
    expected = Path(sys.argv[1]), int(sys.argv[3]), sys.argv[4]
    try:
        sweep, batch = wanted(*expected)
        header: list[str] = []
        points = []
        for point in batch.points:
            found, rows = compute(sweep, point)
            if header and found != header:
                raise plan.SweepError(f"sweep {sweep.name}: the points' tables differ in their columns")
            twice = [column for column in found if column in sweep.header]
            if twice:
                raise plan.SweepError(f"sweep {sweep.name}: the command's table has a column '{twice[0]}', too: "
                                      "name the axis otherwise")
            header = found
            points.append({"coordinates": point.coordinates, "seed": point.seed, "rows": rows})
        wanted(*expected)  # still: a program that was built anew in the meantime has computed some of the points
        write(plan.batch_file(Path(sys.argv[2]), batch), batch, header, points)
    except plan.SweepError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
