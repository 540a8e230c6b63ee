# SPDX-License-Identifier: Apache-2.0
"""The program and the files that it writes."""

import csv
import os
import subprocess
from pathlib import Path

import numpy as np
import numpy.typing as npt

ROOT = Path(__file__).resolve().parent.parent.parent
BIN = Path(os.environ.get("DTOF_BIN", ROOT / "build" / "cpp" / "bin"))


def run(program: str, *arguments: object) -> str:
    done = subprocess.run([BIN / program, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(f"{program} {arguments}: {done.stdout}{done.stderr}")
    return done.stdout


def refusal(program: str, *arguments: object) -> str:
    """What the program says instead of working."""
    done = subprocess.run([BIN / program, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 1:
        raise AssertionError(f"{program} {arguments}: exit code {done.returncode}")
    return done.stderr.strip().removeprefix(f"{program}: error: ")


def codes(file: Path, rows: int) -> dict[str, npt.NDArray[np.int64]]:
    """A result file's columns as arrays (rows, columns)."""
    numbers = np.loadtxt(file, delimiter=",", skiprows=1, dtype=np.int64)
    with open(file, encoding="ascii") as stream:
        names = stream.readline().strip().split(",")
    return {name: numbers[:, i].reshape(rows, -1) for i, name in enumerate(names)}


def table(file: Path) -> dict[str, dict[str, str]]:
    """Lines of a CSV table by their first column."""
    with open(file, encoding="utf-8", newline="") as stream:
        return {next(iter(line.values())): line for line in csv.DictReader(stream)}


def ply_points(file: Path) -> npt.NDArray[np.float32]:
    """The points of the program's PLY: x, y and z, and three bytes of colour that are left out."""
    header, _, body = file.read_bytes().partition(b"end_header\n")
    assert b"property uchar blue" in header
    return np.frombuffer(body, dtype=[("point", "<f4", 3), ("colour", "u1", 3)])["point"]
