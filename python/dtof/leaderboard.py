# SPDX-License-Identifier: Apache-2.0
"""Ranks your own read-out beside the project's read-outs and the rivals, on the same photons.

    python3 -m dtof.leaderboard mine.py --beside poolpointer,hedh8

`mine.py` is a model file. It defines

    TITLE = "my read-out"           # the name in the table
    BITS_PER_PIXEL = 24             # memory that the read-out needs for each pixel; None if you do not know
    def read_out(photons, sensor):  # dtof.Photons, dtof.Sensor
        ...                         # returns the position of each pixel in bins, an array (rows, columns); NaN: no distance

Each read-out reads the middle of each scene at each light, in several frames with other photons and other shapes. Its look-up table is fitted
on flat targets at the same light, as for the read-outs of the project.
"""

import argparse
import csv
import importlib.util
import json
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt

from dtof import _core

Positions = npt.NDArray[np.float64]
SCENES = ("room", "planes", "clutter", "poles", "isolated")
COLUMNS, ROWS = 34, 64  # of the part that is read: an engine of poolPointer has 34 columns
FLAT_DISTANCES, FLAT_PIXELS = 45, 160  # of a look-up table
FLAT_FRAME = 1_000_000  # the tables have other photons than the scenes
LIMITS = {"above_3_percent": 0.03, "above_10_percent": 0.10}


@dataclass(frozen=True)
class Settings:
    """What is read: `frames` frames of each scene at each light in klux."""

    sensor: _core.Sensor = field(default_factory=lambda: _core.Sensor("thesis"))
    klux: tuple[float, ...] = (14.0, 50.0)
    scenes: tuple[str, ...] = SCENES
    columns: int = COLUMNS
    rows: int = ROWS
    frames: int = 4
    seed: int = 1


@dataclass(frozen=True)
class Entry:
    """A read-out that takes part.

    `read_out` takes photons, the oldest frame first, and returns positions in bins (rows, columns); NaN is no distance. `table` takes a light in
    klux and returns the read-out's look-up table. `bits` is the memory for each pixel, None where it is not known. `frames` counts the frames
    that a result needs; the first `laser_off_frames` of them are taken without laser light.
    """

    title: str
    kind: str  # read-out, rival, model file
    bits: float | None
    read_out: Callable[[Sequence[_core.Photons]], Positions]
    table: Callable[[float], _core.LookupTable]
    frames: int = 1
    laser_off_frames: int = 0


@dataclass(frozen=True)
class Row:
    """The shares of an entry at a light, parts of 1, with their 95 % intervals."""

    entry: Entry
    klux: float
    pixels: int
    shares: dict[str, _core.Estimate]


def part_of(sensor: _core.Sensor, columns: int, rows: int) -> _core.Sensor:
    """Returns the sensor with an array of this size."""
    if not (0 < columns <= sensor.columns and 0 < rows <= sensor.rows):
        raise ValueError(f"{columns} x {rows} pixels do not fit into the sensor's {sensor.columns} x {sensor.rows}")
    return sensor.replace(columns=columns, rows=rows)


def middle(name: str, settings: Settings, seed: int) -> _core.Scene:
    """Returns the middle of a scene. `seed` draws the shapes."""
    whole = _core.Scene(name, settings.sensor, seed=seed)
    left, top = (whole.columns - settings.columns) // 2, (whole.rows - settings.rows) // 2
    rows, columns = slice(top, top + settings.rows), slice(left, left + settings.columns)
    return _core.Scene.from_depth(whole.depth_m[rows, columns], whole.reflectivity[rows, columns])


def has_truth(scene: _core.Scene) -> npt.NDArray[np.bool_]:
    """Which pixels (rows, columns) have a true distance: a scene says 0 where nothing is."""
    return np.isfinite(scene.depth_m) & (scene.depth_m > 0)


def fitted_table(read_out: Callable[[Sequence[_core.Photons]], Positions], settings: Settings, klux: float) -> _core.LookupTable:
    """Fits the look-up table of a read-out to flat targets of the sensor's reflectivity, spread over the range."""
    distances = np.linspace(0.1, 0.92 * settings.sensor.range_m, FLAT_DISTANCES)
    sensor = settings.sensor.replace(columns=1, rows=FLAT_PIXELS)
    positions = []
    for distance in distances:
        flat = _core.Scene.from_depth(np.full((FLAT_PIXELS, 1), distance), sensor.default_reflectivity)
        photons = _core.photons(flat, sensor, klux, seed=settings.seed, frame=FLAT_FRAME)
        positions.append(np.ravel(read_out([photons])))
    return _core.LookupTable.fit(distances.tolist(), np.array(positions))


def readout_entry(name: str, settings: Settings, bits: float | None = None) -> Entry:
    sensor = part_of(settings.sensor, settings.columns, settings.rows)
    readout = _core.Readout(name, sensor)

    def read_out(photons: Sequence[_core.Photons]) -> Positions:
        results = _core.read_out(photons[-1], readout)
        return np.where(results.has_distance, results.position, np.nan)

    return Entry(readout.title, "read-out", bits, read_out, lambda klux: _core.LookupTable.flat(readout, sensor, klux, seed=settings.seed))


def rival_entry(name: str, settings: Settings) -> Entry:
    rival = _core.Rival(name, settings.sensor)
    return Entry(rival.title, "rival", float(rival.bits_per_pixel), lambda photons: rival.read_out(photons)["position"],
                 lambda klux: rival.flat_table(klux, seed=settings.seed), rival.frames, rival.laser_off_frames)


def model_entry(file: Path, settings: Settings) -> Entry:
    """Reads a model file. Raises ValueError with file and reason where something is missing."""
    if not file.is_file():
        raise ValueError(f"{file}: no such file")
    specification = importlib.util.spec_from_file_location(f"dtof_model_{file.stem}", file)
    if specification is None or specification.loader is None:
        raise ValueError(f"{file}: a model file is a Python file, its name ends with .py")
    module = importlib.util.module_from_spec(specification)
    try:
        specification.loader.exec_module(module)
    except Exception as error:
        raise ValueError(f"{file}: {type(error).__name__}: {error}") from error
    for name in ("TITLE", "BITS_PER_PIXEL", "read_out"):
        if not hasattr(module, name):
            raise ValueError(f"{file}: defines no {name} (help: python3 -m dtof.leaderboard --help)")
    bits = module.BITS_PER_PIXEL
    if bits is not None and (isinstance(bits, bool) or not isinstance(bits, int | float) or not 0 <= bits < 1e9):
        raise ValueError(f"{file}: BITS_PER_PIXEL is a number of bits or None, not {bits!r}")
    if not isinstance(module.TITLE, str) or not module.TITLE or set(module.TITLE) & set("|\n"):
        raise ValueError(f"{file}: TITLE is a text of one line without '|', not {module.TITLE!r}")

    def read_out(photons: Sequence[_core.Photons]) -> Positions:
        last = photons[-1]
        sensor = settings.sensor.replace(columns=last.columns, rows=last.rows)
        try:
            positions = np.asarray(module.read_out(last, sensor), dtype=np.float64)
        except Exception as error:
            raise ValueError(f"{file}: read_out: {type(error).__name__}: {error}") from error
        if positions.shape != (last.rows, last.columns):
            raise ValueError(f"{file}: read_out returns an array {positions.shape} for {last.rows} rows of {last.columns} columns")
        if np.any((positions < 0) | (positions > 2**sensor.np)):
            raise ValueError(f"{file}: read_out returns positions outside of 0 to {2**sensor.np} bins")
        return positions

    return Entry(module.TITLE, "model file", bits, read_out, lambda klux: fitted_table(read_out, settings, klux))


def measure(entries: Sequence[Entry], settings: Settings, progress: Callable[[int, int], None] | None = None) -> list[Row]:
    """Reads every scene with every entry. Rows are sorted by light, then by the share of pixels above 3 %."""
    sensor = part_of(settings.sensor, settings.columns, settings.rows)
    rows = []
    steps = len(settings.klux) * len(entries) * (1 + settings.frames)
    done = 0

    def step() -> None:
        nonlocal done
        done += 1
        if progress is not None:
            progress(done, steps)

    for klux in settings.klux:
        tables = []
        for entry in entries:
            tables.append(entry.table(klux))
            step()
        shares: list[dict[str, list[float]]] = [{name: [] for name in LIMITS} for _ in entries]
        pixels = []  # of each frame
        for number in range(settings.frames):
            scenes = [middle(name, settings, settings.seed + number) for name in settings.scenes]
            pixels.append(sum(int(has_truth(scene).sum()) for scene in scenes))
            if not pixels[-1]:
                raise ValueError(f"no pixel of the scenes {', '.join(settings.scenes)} has a true distance in the part that is read")
            most = max(entry.frames for entry in entries)

            def taken(laser: bool) -> list[list[_core.Photons]]:
                """The frames of each scene, the oldest first."""
                return [[_core.photons(scene, sensor, klux, seed=settings.seed + number, frame=most * place + back, laser=laser)
                         for back in reversed(range(most))] for place, scene in enumerate(scenes)]

            photons = taken(laser=True)
            laser_off = taken(laser=False) if any(entry.laser_off_frames for entry in entries) else photons
            for entry, table, own in zip(entries, tables, shares):
                wrong = dict.fromkeys(LIMITS, 0)
                first = most - entry.frames
                first_lit = first + entry.laser_off_frames
                for scene, frames, dark in zip(scenes, photons, laser_off):
                    positions = entry.read_out([*dark[first:first_lit], *frames[first_lit:]])
                    measured = np.where(np.isnan(positions), np.nan, table.distance(np.nan_to_num(positions)))
                    # A pixel without a distance is wrong; one without a true distance is not judged.
                    judged = has_truth(scene)
                    error = np.abs(measured[judged] - scene.depth_m[judged]) / scene.depth_m[judged]
                    for name, limit in LIMITS.items():
                        wrong[name] += int(np.sum(~(error <= limit)))
                for name in LIMITS:
                    own[name].append(wrong[name] / pixels[-1])
                step()
        rows += [Row(entry, klux, sum(pixels),
                     {name: _core.estimate_share_of_frames(np.array(values), min(pixels)) for name, values in own.items()})
                 for entry, own in zip(entries, shares)]
    return sorted(rows, key=lambda row: (row.klux, row.shares["above_3_percent"].value))


def on_the_front(row: Row, rows: Sequence[Row]) -> bool:
    """Whether no row of the same light has fewer errors with at most as many bits."""
    if row.entry.bits is None:
        return False
    return not any(other.klux == row.klux and other.entry.bits is not None and other.entry.bits <= row.entry.bits
                   and other.shares["above_3_percent"].value < row.shares["above_3_percent"].value for other in rows)


def table(rows: Sequence[Row]) -> str:
    """Returns one Markdown table per light. Shares are in per cent."""
    parts = []
    for klux in dict.fromkeys(row.klux for row in rows):
        lines = ["| rank | read-out | kind | bits per pixel | above 3 % | 95 % interval | above 10 % |", "|---:|---|---|---:|---:|---:|---:|"]
        for rank, row in enumerate((row for row in rows if row.klux == klux), 1):
            share = row.shares["above_3_percent"]
            title = f"**{row.entry.title}**" if on_the_front(row, rows) else row.entry.title
            bits = "-" if row.entry.bits is None else f"{row.entry.bits:g}"
            lines.append(f"| {rank} | {title} | {row.entry.kind} | {bits} | {100 * share.value:.2f} | {100 * share.interval[0]:.2f} to "
                         f"{100 * share.interval[1]:.2f} | {100 * row.shares['above_10_percent'].value:.2f} |")
        parts.append(f"## {klux:g} klux\n\n" + "\n".join(lines) + "\n")
    return "\n".join(parts)


def described(settings: Settings) -> str:
    """What the rows have read, as a sentence."""
    return (f"Sensor {settings.sensor.name}, {settings.sensor.acquisitions} acquisitions. All rows of a light read the same photons: the middle of the "
            f"scenes {', '.join(settings.scenes)}, {settings.columns} x {settings.rows} pixels of each, in {settings.frames} frames with other photons "
            f"and other shapes (seed {settings.seed}). A pixel without a distance counts as wrong.\n")


def write_csv(rows: Sequence[Row], file: Path) -> None:
    with file.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(["klux", "readout", "kind", "bits_per_pixel", "pixels", *(name + end for name in LIMITS for end in ("", "_low", "_high"))])
        for row in rows:
            shares = [f"{value:.6g}" for name in LIMITS for value in (row.shares[name].value, *row.shares[name].interval)]
            writer.writerow([f"{row.klux:g}", row.entry.title, row.entry.kind, "" if row.entry.bits is None else f"{row.entry.bits:g}", row.pixels,
                             *shares])


def as_json(rows: Sequence[Row], settings: Settings) -> str:
    """Returns the rows of the tables and what they have read as a JSON object. Shares and intervals are parts of 1."""
    ranked = []
    for klux in dict.fromkeys(row.klux for row in rows):
        for rank, row in enumerate((row for row in rows if row.klux == klux), 1):
            shares = {name + end: value for name in LIMITS
                      for end, value in zip(("", "_low", "_high"), (row.shares[name].value, *row.shares[name].interval))}
            ranked.append({"klux": klux, "rank": rank, "readout": row.entry.title, "kind": row.entry.kind, "bits_per_pixel": row.entry.bits,
                           "on_the_front": on_the_front(row, rows), "pixels": row.pixels, **shares})
    read = {"sensor": settings.sensor.name, "acquisitions": settings.sensor.acquisitions, "scenes": settings.scenes, "columns": settings.columns,
            "rows": settings.rows, "frames": settings.frames, "seed": settings.seed}
    return json.dumps({"settings": read, "rows": ranked}, indent=2, allow_nan=False) + "\n"


def chosen(names: str, settings: Settings, bits: dict[str, float]) -> list[Entry]:
    """The project's read-outs and the rivals of a list of names; `all` is every one, `none` is none."""
    known = [*_core.readouts(), *_core.rivals()]
    wanted = known if names == "all" else [] if names == "none" else [name for name in names.split(",") if name]
    for name in wanted:
        if name not in known:
            raise ValueError(f"unknown read-out or rival '{name}'; known are all, none, {', '.join(known)}")
    return [readout_entry(name, settings, bits.get(name)) if name in _core.readouts() else rival_entry(name, settings) for name in wanted]


def _bits(text: str) -> tuple[str, float]:
    name, _, value = text.partition("=")
    return name, float(value)


def main(arguments: Sequence[str] | None = None) -> int:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(prog="python3 -m dtof.leaderboard", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="*", type=Path, metavar="FILE", help="model files")
    parser.add_argument("--beside", default="poolpointer,poolpointer-lean,hispointer,ezpointer,histogram32", metavar="NAMES",
                        help="read-outs of the project and rivals, separated by commas; all; none (default: %(default)s)")
    parser.add_argument("--sensor", default="thesis", help="preset or sensor file, with conditions behind a + (default: %(default)s)")
    parser.add_argument("--klux", nargs="+", type=float, default=[14.0, 50.0], help="lights (default: 14 50)")
    parser.add_argument("--scene", nargs="+", default=list(SCENES), help=f"scenes (default: {' '.join(SCENES)})")
    parser.add_argument("--columns", type=int, default=COLUMNS, help="columns of the part that is read (default: %(default)s)")
    parser.add_argument("--rows", type=int, default=ROWS, help="its rows (default: %(default)s)")
    parser.add_argument("--frames", type=int, default=4, help="frames of each scene, at least 2 (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="seed of everything random (default: %(default)s)")
    parser.add_argument("--bits", nargs="*", type=_bits, default=[], metavar="NAME=BITS", help="bits per pixel of the project's read-outs")
    parser.add_argument("--out", type=Path, help="folder for leaderboard.md and leaderboard.csv")
    parser.add_argument("--json", action="store_true", help="one JSON object instead of the tables on standard output")
    options = parser.parse_args(arguments)
    terminal = sys.stderr.isatty()
    try:
        if options.frames < 2:
            raise ValueError(f"--frames: an interval needs at least 2 frames, not {options.frames}")
        if not 0 <= options.seed < 2**63:
            raise ValueError(f"--seed: {options.seed} is not within 0 to 2^63 - 1")
        settings = Settings(_core.Sensor(options.sensor), tuple(options.klux), tuple(options.scene), options.columns, options.rows, options.frames,
                            options.seed)
        entries = [*(model_entry(file, settings) for file in options.models), *chosen(options.beside, settings, dict(options.bits))]
        if not entries:
            raise ValueError("nothing to rank: name a model file, or read-outs with --beside")
        rows = measure(entries, settings,
                       (lambda done, steps: print(f"\rleaderboard {100 * done // steps} %", end="", file=sys.stderr, flush=True)) if terminal else None)
    except (ValueError, OSError) as error:
        print(f"leaderboard: error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("leaderboard: interrupted", file=sys.stderr)
        return 130
    if terminal:
        print("\r\033[K", end="", file=sys.stderr)
    text = f"{described(settings)}\n{table(rows)}"
    print(as_json(rows, settings) if options.json else text, end="")
    if options.out is not None:
        try:
            options.out.mkdir(parents=True, exist_ok=True)
            (options.out / "leaderboard.md").write_text(text, encoding="utf-8")
            write_csv(rows, options.out / "leaderboard.csv")
        except OSError as error:
            print(f"leaderboard: error: {error}", file=sys.stderr)
            return 4
    return 0


if __name__ == "__main__":
    sys.exit(main())
