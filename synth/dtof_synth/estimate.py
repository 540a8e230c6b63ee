# SPDX-License-Identifier: Apache-2.0
"""Models of area, power and timing for `dtof design`, fitted to synthesised configurations.

Memories are no model: the sizes that the RTL asks for and the figures of sram_model.py. Logic is linear in the parameters
around the configuration of each read-out's defaults: a column costs what that one does, and so many um2 for each bit or
doubling that a parameter differs by; what the columns share grows with the columns and the engines. Power: that of the
defaults on the scene of `make power`, in each part scaled by what the part is made of. Fitted are the configurations of
configurations.toml (reports/area.csv, timing.csv, power.csv), steps of NP and NB (growth.csv) and some of
models/dtof/design/estimate_points.toml; the others are held out. The C++ program has the same formulas
(models/dtof/design/estimate.cpp) and reads the coefficients that are written here.
"""

from __future__ import annotations

import csv
import hashlib
import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from . import configuration as configurations
from . import growth, sram_model
from .configuration import Configuration, counted_macros, engine_memories, memories, shared_memories
from .errors import FlowError, given

POINTS = "models/dtof/design/estimate_points.toml"
MEASURED = "models/dtof/design/estimate_points.csv"
COEFFICIENTS = "models/dtof/design/coefficients.toml"
REPORT = "reports/estimate.md"
GROWTH = "reports/growth.csv"
SOURCES = ("reports/area.csv", "reports/timing.csv", "reports/power.csv", GROWTH, MEASURED)
HELD_OUT = "held out"
UNSEEN = (HELD_OUT, "left out")  # the kinds of errors
LIGHTS = ("day", "dusk")
POWER_PARTS = ("columns", "shared", "sram", "clock", "leakage")
# A column's logic is linear in these; in the doublings of the pixels: small arrays need fewer hold buffers.
FEATURES = ("NP", "NB", "COUNT_WIDTH", "FRACTION_BITS", "CONFIDENCE_WIDTH", "POINTER_PORTS", "TIME_GATE", "LABELS",
            "PIXELS")
FAMILIES = ("pointer", "histogram", "pool")
RIDGE = 0.05
# From an SRAM's data to a register, with setup and uncertainty: between the longest that still met its clock and the shortest that did
# not, of arrays whose SRAM limits the clock (0.34 and 0.53 ns, 1.24 and 1.27 ns in reports/scale.csv and the points).
AFTER_ACCESS_NS = {"pointer": 0.5, "histogram": 0.5, "pool": 1.24}
# An engine's line crosses all of its columns in a clock. 100 columns are the widest synthesised engine that meets the clock of the
# defaults; one of 200 columns reaches 208 MHz.
WIDEST_ENGINE = 100
ENGINE_COLUMN_NS = 0.0196
GOALS = {"area": 0.05, "power": 0.10}


@dataclass(frozen=True)
class Measured:
    """Figures of the flow. Areas in um2; power in mW while acquisitions stream in, by light level."""

    configuration: Configuration
    column: float
    shared: float
    engines: float | None  # in shared; None: not known apart
    total_mm2: float
    fmax_mhz: float
    power: dict[str, dict[str, float]]

    @property
    def held_out(self) -> bool:
        return self.configuration.note == HELD_OUT


def family(configuration: Configuration) -> str:
    """Family of read-outs with similar columns: without a histogram, with one, poolPointer."""
    return "pool" if configuration.is_pool else "histogram" if "histogram" in memories(configuration) else "pointer"


def features(configuration: Configuration, reference: Configuration) -> list[float]:
    def difference(name: str) -> float:
        return configuration.parameters.get(name, 0) - reference.parameters.get(name, 0)

    return [*(float(difference(name)) for name in FEATURES[:-1]), math.log2(configuration.pixels / reference.pixels)]


def _labels_beyond(item: Configuration, reference: Configuration) -> int:
    return item.parameters.get("LABELS", 0) - reference.parameters.get("LABELS", 0)


def _macro_area(sizes: dict) -> float:
    return sum(sram_model.macro(size).area for size in sizes.values())


def _macro_leakage_mw(configuration: Configuration) -> float:
    return sum(number * sram_model.macro(size).leakage for number, size in counted_macros(configuration)) * 1e-3


def _access_pj(configuration: Configuration) -> float:
    """Energy of a read and a write of each memory of a column, pJ."""
    return sum(sram_model.macro(size).read_energy + sram_model.macro(size).write_energy
               for size in memories(configuration).values()) / configuration.module_columns


@dataclass(frozen=True)
class Reference:
    """Figures of a read-out's default configuration, and derived figures."""

    configuration: Configuration
    column: float
    control: float  # what the columns share beside engines
    engine: float  # one of them
    fmax_mhz: float
    power: dict[str, dict[str, float]]


@dataclass(frozen=True)
class Model:
    references: dict[str, Reference]
    slopes: dict[str, list[float]]  # of a family's columns, um2
    control_slopes: dict[str, float]  # um2 a column
    engine_um2_a_label: float
    period_slope_ns: float  # a column beyond the reference's
    data_exponent: float  # of NP, to which a column's data power is proportional

    def _reference(self, configuration: Configuration) -> Reference:
        return given(self.references.get(configuration.readout), f"no estimate of {configuration.readout}")

    def engine_um2(self, item: Configuration) -> float:
        """Logic of an engine; 0 for a read-out without engines."""
        one = self._reference(item)
        return one.engine + self.engine_um2_a_label * _labels_beyond(item, one.configuration)

    def column_um2(self, item: Configuration) -> float:
        one = self._reference(item)
        steps = zip(self.slopes[family(item)], features(item, one.configuration))
        return max(one.column + sum(slope * step for slope, step in steps), 0.3 * one.column)

    def control_um2(self, item: Configuration) -> float:
        one = self._reference(item)
        return max(one.control + self.control_slopes[family(item)] * (item["SRAM_NUM"] - one.configuration["SRAM_NUM"]),
                   0.1 * one.control)

    def total_mm2(self, item: Configuration) -> float:
        shared = self.control_um2(item) + item.engines * (self.engine_um2(item) + _macro_area(engine_memories(item)))
        shared += _macro_area(shared_memories(item))
        srams = _macro_area(memories(item)) / item.module_columns
        return ((self.column_um2(item) + srams) * item["SRAM_NUM"] + shared) * 1e-6

    def fmax_mhz(self, item: Configuration) -> float:
        one = self._reference(item)
        beyond = max(item["SRAM_NUM"] - one.configuration["SRAM_NUM"], 0)
        engine = min(item["ENGINE_COLUMNS"], item["SRAM_NUM"]) if item.is_pool else 0
        line = ENGINE_COLUMN_NS * max(engine - WIDEST_ENGINE, 0)
        sizes = [*memories(item).values(), *engine_memories(item).values()]
        access = max(sram_model.macro(size).access_slow for size in sizes)
        return 1e3 / max(1e3 / one.fmax_mhz + beyond * self.period_slope_ns + line, access + AFTER_ACCESS_NS[family(item)])

    def mw(self, item: Configuration, light: str) -> float:
        one = self._reference(item)
        part = one.power[light]
        base = one.configuration
        columns = item["SRAM_NUM"] / base["SRAM_NUM"]
        shared = (self.control_um2(item) + item.engines * self.engine_um2(item)) / (one.control + base.engines * one.engine)
        # Hold buffers are not clocked.
        clocked = ((one.column * item["SRAM_NUM"] + self.control_um2(item) + item.engines * self.engine_um2(item))
                   / (one.column * base["SRAM_NUM"] + one.control + base.engines * one.engine))
        leakage = ((part["leakage"] - _macro_leakage_mw(base)) * self._logic_um2(item) / self._logic_um2(base)
                   + _macro_leakage_mw(item))
        return (part["columns"] * columns * (item["NP"] / base["NP"]) ** self.data_exponent + part["shared"] * shared
                + part["sram"] * columns * _access_pj(item) / _access_pj(base) + part["clock"] * clocked + leakage)

    def _logic_um2(self, item: Configuration) -> float:
        return (self.column_um2(item) * item["SRAM_NUM"] + self.control_um2(item)
                + item.engines * self.engine_um2(item))


def _solve(rows: list[list[float]], wanted: list[float]) -> list[float]:
    """Least squares with a ridge, so that a parameter that is equal in all points gets coefficient 0."""
    matrix = np.array(rows).reshape(-1, len(FEATURES))
    square = matrix.T @ matrix
    return [float(value) for value in np.linalg.solve(square + RIDGE * np.eye(len(square)), matrix.T @ np.array(wanted))]


@dataclass(frozen=True)
class Step:
    """Difference of a column's logic between two configurations, before hold buffers."""

    configuration: Configuration
    base: Configuration
    um2: float


def fit(points: list[Measured], steps: list[Step]) -> Model:
    """Fits the model; held-out points are not used."""
    used = [point for point in points if not point.held_out]
    bases = {point.configuration.readout: point for point in used if point.power and not point.configuration.variant_of
             and not point.configuration.note.startswith("fitted")}
    missing = {point.configuration.readout for point in points} - set(bases)
    if missing:
        raise FlowError(f"estimate: there is no power of {sorted(missing)[0]}'s defaults")
    slopes: dict[str, list[float]] = {}
    control: dict[str, float] = {}
    for name in FAMILIES:
        mine = [point for point in used if family(point.configuration) == name]
        rows = [features(point.configuration, bases[point.configuration.readout].configuration) for point in mine]
        wanted = [point.column - bases[point.configuration.readout].column for point in mine]
        grown = [step for step in steps if family(step.configuration) == name]
        slopes[name] = _solve([*rows, *(features(step.configuration, step.base) for step in grown)],
                              [*wanted, *(step.um2 for step in grown)])
        apart = [point for point in mine if name != "pool" or point.engines is not None]
        if name != "pool":
            wider = [(point.configuration["SRAM_NUM"] - bases[point.configuration.readout].configuration["SRAM_NUM"],
                      point.shared - bases[point.configuration.readout].shared) for point in apart]
            control[name] = sum(x * y for x, y in wider) / max(sum(x * x for x, _ in wider), 1)
        else:
            lines = [(point.configuration["SRAM_NUM"], point.shared - given(point.engines, "engines")) for point in apart]
            mean_x, mean_y = (sum(values) / max(len(lines), 1) for values in zip(*(lines or [(0, 0.0)])))
            spread = sum((x - mean_x) ** 2 for x, _ in lines)
            # One point alone says nothing but its height: broadcast and results are alike in both arrays.
            control[name] = sum((x - mean_x) * (y - mean_y) for x, y in lines) / spread if spread else control["histogram"]
            offset = mean_y - control[name] * mean_x
    references = {}
    for readout, base in bases.items():
        item = base.configuration
        engine = 0.0
        shared = base.shared
        if item.is_pool:
            shared = offset + control["pool"] * item["SRAM_NUM"]
            engine = (base.shared - shared) / item.engines
        references[readout] = Reference(item, base.column, shared, engine, base.fmax_mhz, base.power)
    grown_engines = []
    for point in used:
        reference = references[point.configuration.readout]
        more = _labels_beyond(point.configuration, reference.configuration)
        if more and point.engines is not None:
            grown_engines.append((more, point.engines / point.configuration.engines - reference.engine))
    a_label = sum(x * y for x, y in grown_engines) / max(sum(x * x for x, _ in grown_engines), 1)
    wide = [(point.configuration["SRAM_NUM"] - bases[point.configuration.readout].configuration["SRAM_NUM"],
             1e3 / point.fmax_mhz - 1e3 / bases[point.configuration.readout].fmax_mhz) for point in used]
    beyond = [(columns, late) for columns, late in wide if columns > 0]
    period = max(sum(x * y for x, y in beyond) / max(sum(x * x for x, _ in beyond), 1), 0.0)
    return Model(references, slopes, control, a_label, period, _data_exponent(used, references))


def _data_exponent(used: list[Measured], references: dict[str, Reference]) -> float:
    """Exponent of NP in the data power of a column, from the fitted points."""
    pairs = []
    for point in used:
        base = references[point.configuration.readout]
        bits = math.log(point.configuration["NP"] / base.configuration["NP"])
        for light, parts in point.power.items():
            columns = point.configuration["SRAM_NUM"] / base.configuration["SRAM_NUM"]
            pairs.append((bits, math.log(parts["columns"] / columns / base.power[light]["columns"])))
    return sum(x * y for x, y in pairs) / max(sum(x * x for x, _ in pairs), 1e-9)


@dataclass(frozen=True)
class Error:
    """An estimate and the figure that the flow measured."""

    name: str
    figure: str  # area, power, fmax
    kind: str  # fitted, left out, held out
    measured: float
    estimated: float

    @property
    def relative(self) -> float:
        return self.estimated / self.measured - 1


def _of(model: Model, point: Measured, kind: str) -> list[Error]:
    """Errors of a model for a point. Power is fitted to the defaults alone, so every other point is held out for it."""
    name = point.configuration.name
    found = [Error(name, "area", kind, point.total_mm2, model.total_mm2(point.configuration)),
             Error(name, "fmax", kind, point.fmax_mhz, model.fmax_mhz(point.configuration))]
    return found + [Error(f"{name}, {light}", "power", HELD_OUT, sum(parts.values()), model.mw(point.configuration, light))
                    for light, parts in point.power.items()]


def errors(points: list[Measured], steps: list[Step]) -> list[Error]:
    """Errors of all points. Held-out points are estimated by the model of the others; each fitted point that is no default by a model
    without it."""
    model = fit(points, steps)
    found: list[Error] = []
    for point in points:
        if point.held_out:
            found += _of(model, point, HELD_OUT)
        elif model.references[point.configuration.readout].configuration is not point.configuration:
            found += _of(fit([other for other in points if other is not point], steps), point, "left out")
    return found


def checked(found: list[Error]) -> list[Error]:
    """FlowError if a figure has no error because no point is held out for it."""
    for figure in ("area", "power", "fmax"):
        if not any(one.figure == figure and one.kind == HELD_OUT for one in found):
            raise FlowError(f"estimate: nothing is held out for the {figure}, so that its error is not known")
    return found


def worst(found: Iterable[Error], figure: str, kinds: tuple[str, ...] = (HELD_OUT,)) -> float:
    """Largest relative error in either direction."""
    return max((abs(one.relative) for one in found if one.figure == figure and one.kind in kinds), default=0.0)


def rms(found: Iterable[Error], figure: str, kinds: tuple[str, ...] = (HELD_OUT,)) -> float:
    squares = [one.relative**2 for one in found if one.figure == figure and one.kind in kinds]
    return math.sqrt(sum(squares) / len(squares)) if squares else 0.0


# What is read and written.

def _table(root: Path, name: str) -> list[dict[str, str]]:
    try:
        with (root / name).open(newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))
    except OSError as error:
        raise FlowError(f"{root / name}: {error.strerror}; its command writes it") from None


def _parts(row: dict[str, str]) -> dict[str, float]:
    return {"columns": float(row["columns_mw"]), "shared": float(row["engines_mw"]) + float(row["control_mw"]),
            "sram": float(row["sram_mw"]), "clock": float(row["clock_mw"]), "leakage": float(row["leakage_mw"])}


def read(root: Path) -> list[Measured]:
    """Figures of the named configurations from the reports, and of the points from their own file."""
    named = configurations.load(root / "configurations.toml")
    power: dict[str, dict[str, dict[str, float]]] = {}
    for row in _table(root, "reports/power.csv"):
        if row["phase"] == "streaming":
            power.setdefault(row["configuration"], {})[row["light"]] = _parts(row)
    fmax = {row["configuration"]: float(row["fmax_mhz"]) for row in _table(root, "reports/timing.csv") if row["corner"] == "slow"}
    points = [Measured(named[row["configuration"]], float(row["column_um2"]), float(row["shared_um2"]), None,
                       float(row["total_mm2"]), fmax[row["configuration"]], power.get(row["configuration"], {}))
              for row in _table(root, "reports/area.csv") if row["configuration"] in named]
    extra = configurations.load(root / POINTS)
    for row in _table(root, MEASURED):
        item = given(extra.get(row["configuration"]), f"{MEASURED}: {row['configuration']} is not in {POINTS}")
        lights = {light: {part: float(row[f"{light}_{part}_mw"]) for part in POWER_PARTS} for light in LIGHTS
                  if row[f"{light}_{POWER_PARTS[0]}_mw"]}
        points.append(Measured(item, float(row["column_um2"]), float(row["shared_um2"]), float(row["engines_um2"]),
                               float(row["total_mm2"]), float(row["fmax_mhz"]), lights))
    return points


def read_steps(root: Path) -> list[Step]:
    """Steps of NP and NB from make synth-growth."""
    named = configurations.load(root / "configurations.toml")
    rows = [row for row in _table(root, GROWTH) if row["parameter"] in ("NP", "NB")]
    column = {(row["readout"], row["parameter"], int(row["value"])): float(row["logic_column_um2"]) for row in rows}
    return [Step(growth.point(named[readout], parameter, value), named[readout],
                 um2 - column[readout, parameter, named[readout][parameter]])
            for (readout, parameter, value), um2 in column.items() if value != named[readout][parameter]]


def write_points(root: Path, points: list[Measured]) -> None:
    columns = [f"{light}_{part}_mw" for light in LIGHTS for part in POWER_PARTS]
    with (root / MEASURED).open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["configuration", "column_um2", "shared_um2", "engines_um2", "total_mm2", "fmax_mhz", *columns])
        for point in points:
            mw = [f"{point.power[light][part]:.3f}" if light in point.power else "" for light in LIGHTS for part in POWER_PARTS]
            writer.writerow([point.configuration.name, f"{point.column:.1f}", f"{point.shared:.1f}",
                             f"{given(point.engines, 'engines'):.1f}", f"{point.total_mm2:.4f}", f"{point.fmax_mhz:.1f}", *mw])


def digest(root: Path) -> str:
    """Digest of the figures on which the coefficients depend."""
    text = hashlib.sha256()
    for name in SOURCES:
        text.update((root / name).read_bytes())
    return text.hexdigest()[:16]


def coefficients(root: Path, model: Model, found: list[Error]) -> str:
    """Coefficients as TOML for the C++ program."""
    lines = ["# SPDX-License-Identifier: Apache-2.0",
             "# Written by `synth/synth.py estimate` from synthesised configurations; the formulas are those of",
             "# models/dtof/design/estimate.cpp and synth/dtof_synth/estimate.py. um2, mW at 330 MHz, MHz in the slow corner.",
             f'digest = "{digest(root)}"', f"period_slope_ns = {model.period_slope_ns:.6f}",
             f"data_exponent = {model.data_exponent:.4f}", "",
             "# Largest and root mean square error, relative, of configurations without which the model was fitted.", "[error]"]
    for figure in ("area", "power", "fmax"):
        lines += [f"{figure} = {worst(found, figure, UNSEEN):.4f}", f"{figure}_rms = {rms(found, figure, UNSEEN):.4f}"]
    for name, slopes in model.slopes.items():
        lines += ["", f"[family.{name}]", f"control_um2_a_column = {model.control_slopes[name]:.3f}",
                  f"engine_um2_a_label = {model.engine_um2_a_label if name == 'pool' else 0.0:.3f}",
                  *(f"{feature} = {slope:.2f}" for feature, slope in zip(FEATURES, slopes))]
    for readout, one in model.references.items():
        item = one.configuration
        kept = ", ".join(f"{name} = {item.parameters[name]}" for name in (*FEATURES[:-1], "PIXELS_PER_SRAM", "SRAM_NUM",
                                                                          "ENGINE_COLUMNS") if name in item.parameters)
        lines += ["", f"[readout.{readout}]", f"reference = {{ {kept} }}", f"column_um2 = {one.column:.1f}",
                  f"control_um2 = {one.control:.1f}", f"engine_um2 = {one.engine:.1f}", f"fmax_mhz = {one.fmax_mhz:.1f}"]
        for light in LIGHTS:
            parts = ", ".join(f"{part} = {one.power[light][part]:.3f}" for part in POWER_PARTS)
            lines.append(f"{light} = {{ {parts} }}")
    return "\n".join([*lines, ""])


def report(root: Path, found: list[Error]) -> str:
    lines = ["# Estimates of `dtof design`", "",
             "Written by `synth/synth.py estimate`: area, power and clock of configurations as the models of `dtof design` have them, "
             "beside the synthesis flow's figures. Held out: the configuration is in no fit. Left out: the model was fitted without "
             "this one. The forms of the models, not their coefficients, were chosen with errors of held-out points in "
             "view. Memories follow the physical model of [sram.md](sram.md) exactly; power is that of the acquisitions on the "
             f"scene of `make power`. Digest of the figures: `{digest(root)}`.", "",
             "| figure | kind | configurations | root mean square | largest | goal | met |", "|---|---|---:|---:|---:|---:|---|"]
    for figure in ("area", "power", "fmax"):
        for kind in (HELD_OUT, "left out"):
            number = sum(one.figure == figure and one.kind == kind for one in found)
            if number:
                goal = GOALS.get(figure)
                largest = worst(found, figure, (kind,))
                lines.append(f"| {figure} | {kind} | {number} | {rms(found, figure, (kind,)):.1%} | {largest:.1%} | "
                             f"{f'{goal:.0%}' if goal else '-'} | {'-' if not goal else 'yes' if largest <= goal else '**no**'} |")
    lines += ["", "| configuration | figure | kind | flow | estimate | error |", "|---|---|---|---:|---:|---:|"]
    units = {"area": "mm2", "power": "mW", "fmax": "MHz"}
    for one in found:
        lines.append(f"| {one.name} | {one.figure}, {units[one.figure]} | {one.kind} | {one.measured:.4g} | {one.estimated:.4g} | "
                     f"{one.relative:+.1%} |")
    return "\n".join([*lines, ""])


def write(root: Path, written: Path) -> list[Error]:
    """Writes coefficients and report from the figures below `root` into the same places below `written`."""
    points, steps = read(root), read_steps(root)
    found = checked(errors(points, steps))
    for name, text in ((COEFFICIENTS, coefficients(root, fit(points, steps), found)), (REPORT, report(root, found))):
        (written / name).parent.mkdir(parents=True, exist_ok=True)
        (written / name).write_text(text, encoding="utf-8")
    return found
