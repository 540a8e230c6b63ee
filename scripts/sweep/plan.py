# SPDX-License-Identifier: Apache-2.0
"""Contents of a sweep: its description (TOML), the points, the batches (jobs), and their files.

A point is one value of each axis. Its seed depends on some of its coordinates alone, so it is the same in any sweep and on any machine. A
batch is a series of points that one job computes one after the other. Its name is the hash of the program, of the files that it reads, of
the command and of its points. So a file with this name is the result of exactly these inputs and never has to be computed again.
"""

from __future__ import annotations

import hashlib
import json
import math
import shlex
import string
import tomllib
from dataclasses import dataclass
from pathlib import Path

MOST_POINTS = 10_000_000
SEED_BITS = 31
KEYS = {"name", "command", "table", "inputs", "batch", "seed_of", "axes"}


class SweepError(Exception):
    """An error in a sweep's description or files; the message says where and what."""


@dataclass(frozen=True)
class Point:
    coordinates: tuple[tuple[str, str], ...]  # axis, value; in the order of the axes
    seed: int

    def values(self) -> dict[str, str]:
        return {**dict(self.coordinates), "seed": str(self.seed)}


@dataclass(frozen=True)
class Batch:
    number: int
    name: str  # hash
    points: tuple[Point, ...]


@dataclass(frozen=True)
class Sweep:
    """A sweep. Batches are made on request, since a job needs only its own."""

    name: str
    command: str
    table: str  # CSV file that the command writes into {out}
    axes: tuple[tuple[str, tuple[str, ...]], ...]
    seed_of: tuple[str, ...]
    batch_size: int
    inputs: str  # hash

    @property
    def header(self) -> list[str]:
        return [axis for axis, _ in self.axes] + ["seed"]

    @property
    def points(self) -> int:
        return math.prod(len(values) for _, values in self.axes)

    @property
    def batches(self) -> int:
        return -(-self.points // self.batch_size)

    def point(self, number: int) -> Point:
        """Point with this number; the last axis varies fastest."""
        found = []
        for axis, values in reversed(self.axes):
            number, index = divmod(number, len(values))
            found.append((axis, values[index]))
        coordinates = tuple(reversed(found))
        return Point(coordinates, seed_of(self.name, dict(coordinates), self.seed_of))

    def batch(self, number: int) -> Batch:
        if not 0 <= number < self.batches:
            raise SweepError(f"sweep {self.name}: there is no batch {number}, only {self.batches}")
        begin = number * self.batch_size
        points = tuple(self.point(i) for i in range(begin, min(begin + self.batch_size, self.points)))
        text = json.dumps([self.inputs, self.command, self.table, [[p.coordinates, p.seed] for p in points]])
        return Batch(number, hashlib.sha256(text.encode()).hexdigest()[:32], points)


def _file_hash(path: Path) -> str:
    digest = hashlib.sha256()
    try:
        with path.open("rb") as file:
            while block := file.read(1 << 20):
                digest.update(block)
    except OSError as error:
        raise SweepError(f"{path}: {error.strerror}: build it first") from None
    return digest.hexdigest()


def input_hash(root: Path, inputs: list[str]) -> str:
    """Hash of the contents of these files and of all files below these folders."""
    digest = hashlib.sha256()
    for name in inputs:
        path = root / name
        files = sorted(file for file in path.rglob("*") if file.is_file() and "__pycache__" not in file.parts) \
            if path.is_dir() else [path]
        for file in files:
            digest.update(f"{name} {file.relative_to(path)} {_file_hash(file)}\n".encode())
    return digest.hexdigest()


def seed_of(name: str, coordinates: dict[str, str], axes: tuple[str, ...]) -> int:
    """1 to 2^31 - 1, from the sweep's name and the coordinates on these axes."""
    text = json.dumps([name, [[axis, coordinates[axis]] for axis in axes]])
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:8], "big") % ((1 << SEED_BITS) - 1) + 1


def _checked(table: dict, path: Path) -> None:
    def need(right: bool, what: str) -> None:
        if not right:
            raise SweepError(f"{path}: {what}")

    unknown = sorted(table.keys() - KEYS)
    need(not unknown, f"unknown key '{unknown[0] if unknown else ''}'; known: {', '.join(sorted(KEYS))}")
    for key in ("name", "command", "table"):
        need(isinstance(table.get(key), str) and table[key] != "", f"'{key}' must be a text")
    need(table["name"].replace("_", "a").isalnum(), "'name' may have letters, digits and underscores")
    inputs = table.get("inputs")
    need(isinstance(inputs, list) and bool(inputs) and all(isinstance(i, str) for i in inputs),
         "'inputs' must name the program and all files that the command reads")
    batch = table.get("batch", 1)
    need(isinstance(batch, int) and not isinstance(batch, bool) and 1 <= batch <= 100_000,
         "'batch' must be a number of points from 1 to 100000")
    axes = table.get("axes")
    need(isinstance(axes, dict) and bool(axes), "[axes] must have at least one axis")
    for axis, values in axes.items():
        need(axis.isidentifier() and axis not in ("seed", "out"), f"axis '{axis}': not a name, or one with a meaning")
        need(isinstance(values, list) and bool(values), f"axis '{axis}': must be a list of values")
        texts = [_text(value) for value in values]
        need(None not in texts, f"axis '{axis}': values are texts and numbers")
        need(len(set(texts)) == len(texts), f"axis '{axis}': a value stands there twice")
    seed_axes = table.get("seed_of", [])
    need(isinstance(seed_axes, list) and all(isinstance(axis, str) for axis in seed_axes), "'seed_of' must be a list of axes")
    for axis in seed_axes:
        need(axis in axes, f"'seed_of' names the axis '{axis}', which there is not")
    try:
        shlex.split(table["command"])
        fields = [field for field in string.Formatter().parse(table["command"]) if field[1] is not None]
    except ValueError as error:
        raise SweepError(f"{path}: 'command': {error}") from None
    need(not any(form or conversion for _, _, form, conversion in fields),
         "'command' may have an axis in braces, but neither ':' nor '!' behind it")
    names = {name for _, name, _, _ in fields}
    need("out" in names, "'command' must have {out}, the folder for the table")
    for name in names:
        need(name in axes or name in ("out", "seed"), f"'command' has {{{name}}}, which is no axis")
    for axis in axes:
        need(axis in names or axis in seed_axes, f"axis '{axis}' is neither in 'command' nor in 'seed_of'")


def _text(value: object) -> str | None:
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        return None
    return repr(value).removesuffix(".0") if isinstance(value, float) else str(value)


def load(path: Path, root: Path) -> Sweep:
    """`inputs` are below `root`, where commands run."""
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise SweepError(f"{path}: {error}") from None
    _checked(table, path)
    axes = tuple((axis, tuple(_text(value) for value in values)) for axis, values in table["axes"].items())
    sweep = Sweep(table["name"], table["command"], table["table"], axes, tuple(table.get("seed_of", [])),
                  table.get("batch", 1), input_hash(root, table["inputs"]))
    if sweep.points > MOST_POINTS:
        raise SweepError(f"{path}: {sweep.points} points, but at most {MOST_POINTS} are read")
    return sweep


def batch_file(folder: Path, batch: Batch) -> Path:
    """File of a batch; a folder has at most a thousand of them."""
    return folder / "batches" / f"{batch.number // 1000}" / f"{batch.number}_{batch.name}.json"


def table_file(folder: Path) -> Path:
    return folder / "table.csv"
